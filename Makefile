# Every target sets up what it needs. CI calls lint, check-derive, test and test-slow, in that order; a slow test builds the site.
PYTHON ?= python3
BIN := .venv/bin
READY := .venv/ready

.PHONY: setup setup-all derive check-derive audit certificates reproduce demo docs test test-slow test-heavy test-step bench fuzz nearby mutate dist lint format clean

setup: $(READY)

$(READY): pyproject.toml setup.py
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo "mechsym needs Python 3.11 or newer; name one: make PYTHON=python3.11 $(MAKECMDGOALS)"; exit 1; }
	@$(PYTHON) -c 'import ensurepip, venv' 2>/dev/null || { echo "Python's venv is missing; on Debian: apt-get install python3-venv"; exit 1; }
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e '.[netcdf,dev]'
	@touch $@

# what exports need and what checks them; heavy, so only the slow tests and the packages ask for it
setup-all: .venv/ready-all

.venv/ready-all: $(READY)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e '.[netcdf,dev,fmu,cad,web,app,cluster,docs,check]'
	@touch $@

derive: | $(READY)
	$(BIN)/mechsym derive

check-derive: | $(READY)
	PYTHONHASHSEED=1 $(BIN)/mechsym derive --check
	PYTHONHASHSEED=2 $(BIN)/mechsym derive --check

audit: | $(READY)
	$(BIN)/mechsym audit --write

# every exact verdict of the sources, checked by Coq
certificates: | $(READY)
	@if command -v coqc >/dev/null; then mkdir -p build && $(BIN)/mechsym audit --certificate build/sources.v --json >build/sources.json && coqc build/sources.v && echo "checked by coqc: $$(grep -c ^Theorem build/sources.v) theorems"; else echo "skipped: coqc is missing; on Debian: apt-get install coq"; fi

reproduce: | $(READY)
	$(BIN)/mechsym reproduce

# the site, offline, to docs/_build/html; a warning is an error
docs: | .venv/ready-all
	$(BIN)/python -m sphinx -W -q -b html docs docs/_build/html

demo: | $(READY)
	$(BIN)/mechsym hinge zotov-89 --out demo

test: | $(READY)
	$(BIN)/python -m pytest -n 2 --dist worksteal -q -m "not slow"

test-slow: | .venv/ready-all
	$(BIN)/python -m pytest -n 2 --dist worksteal -q -m "slow and not heavy"

# what CI has no time for: sanitizers, a compiler for another system, sympy's bicycle, fine grids, 200 dead centres, intervals of fits
test-heavy: | .venv/ready-all
	$(BIN)/python -m pytest -n 2 --dist worksteal -q -m heavy

# bodies as STEP; the kernel takes 0.4 GB, so it stands in an environment of its own and is asked for by hand
test-step: .venv-step/ready
	.venv-step/bin/python -m pytest -n 0 -q tests/out/test_step.py

.venv-step/ready: pyproject.toml setup.py
	$(PYTHON) -m venv .venv-step
	.venv-step/bin/python -m pip install --quiet --disable-pip-version-check -e '.[step,dev]'
	@touch $@

bench: | $(READY)
	$(BIN)/python -m benchmarks

# wheel and source archive, checked, and tried in a clean environment of every Python at hand
dist: | .venv/ready-all
	rm -rf dist
	$(BIN)/python -m build --outdir dist .
	$(BIN)/python -m twine check --strict dist/*
	$(BIN)/check-wheel-contents dist/*.whl
	$(BIN)/python tests/everywhere.py dist

# machine-made inputs against the command line, FUZZ of them; finds go to tests/corpus
fuzz: | $(READY)
	$(BIN)/python -m fuzz

# what is doubted with one value of a built-in case 5 % up or down: make nearby [CASES="zotov-89 moroianu"]
nearby: | $(READY)
	$(BIN)/python -m fuzz.nearby $(CASES)

# small mistakes in a module: make mutate MODULE=mechsym.hinge.springs [TESTS=tests/hinge/test_springs.py]
mutate: | $(READY)
	$(BIN)/python -m fuzz.mutants $(MODULE) $(if $(TESTS),--tests "$(TESTS)")

lint: | $(READY)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

format: | $(READY)
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

clean:
	rm -rf .venv .venv-step demo build dist *.egg-info
