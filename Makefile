# Every target sets up what it needs. CI calls setup-all, lint and check-derive, and test with SLOW=1; a slow test builds the site.
PYTHON ?= python3
BIN := .venv/bin
READY := .venv/ready
# without compiled modules every start takes twice as long
unexport PYTHONDONTWRITEBYTECODE

.PHONY: setup setup-all record compare records derive check-derive pictures audit certificates reproduce proof demo docs test test-heavy test-step bench fuzz nearby slips hostile mutate faults interrupts audit-deps house dist lint format clean

setup: $(READY)

$(READY): pyproject.toml setup.py
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo "mechsym needs Python 3.11 or newer; name one: make PYTHON=python3.11 $(MAKECMDGOALS)"; exit 1; }
	@$(PYTHON) -c 'import ensurepip, venv' 2>/dev/null || { echo "Python's venv is missing; on Debian: apt-get install python3-venv"; exit 1; }
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e '.[netcdf,dev,proof,code]'
	@touch $@

# what exports need and what checks them; heavy, so only the slow tests and the packages ask for it
setup-all: .venv/ready-all

.venv/ready-all: $(READY)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e '.[netcdf,dev,proof,code,fmu,cad,web,app,cluster,docs,check]'
	@touch $@

derive: | $(READY)
	$(BIN)/mechsym derive

check-derive: | $(READY)
	PYTHONHASHSEED=1 $(BIN)/mechsym derive --check & first=$$!; PYTHONHASHSEED=2 $(BIN)/mechsym derive --check && wait $$first

audit: | $(READY)
	$(BIN)/python -m benchmarks.auditor
	$(BIN)/mechsym audit --write

# every exact verdict of the sources, checked by Coq
certificates: | $(READY)
	@if command -v coqc >/dev/null; then mkdir -p build && $(BIN)/mechsym audit --certificate build/sources.v --json >build/sources.json && coqc build/sources.v && echo "checked by coqc: $$(grep -c ^Theorem build/sources.v) theorems"; else echo "skipped: coqc is missing; on Debian: apt-get install coq"; fi

reproduce: | $(READY)
	$(BIN)/mechsym reproduce

# the site, offline, to docs/_build/html; a warning is an error
docs: | .venv/ready-all
	$(BIN)/python -m sphinx -W -q -b html docs docs/_build/html

# the pictures of the README, from real runs, in the Chromium of the machine
pictures: | .venv/ready-all
	$(BIN)/python docs/pictures.py

# bounds of rounding of every built-in mechanism, and the start-up enclosed (an hour at most; it goes on from what it kept)
proof: | $(READY)
	for name in crosshead crank_throw hypocycloid rodless rodless_constraints crankshaft_flywheel crankshaft_flywheel_printed hinge; do $(BIN)/mechsym prove $$name || exit 1; done
	$(BIN)/mechsym prove chmielewski --window 55..93 --out build/proof
	$(BIN)/python -m pytest -n 0 -q -m heavy tests/proof

demo: | $(READY)
	$(BIN)/mechsym hinge zotov-89 --out demo

# SLOW=1: what takes longer too, as CI runs it; together they share what they compute
test: | $(if $(SLOW),.venv/ready-all,$(READY))
	$(BIN)/python -m pytest -n 2 --dist worksteal -q -m "$(if $(SLOW),not heavy,not slow)"

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

# every command on every case, before a change and after it: make record, make compare [ONLY="hinge zotov-89/*"] [ONLY=--all]
record: | $(READY)
	$(BIN)/python -m tests.matrix --write build/baseline $(ONLY)

compare: | $(READY)
	$(BIN)/python -m tests.matrix --compare build/baseline $(ONLY)

# what commands give, as tests/recorded keeps it: written anew where a result was to change [ONLY="hinge zotov-89/*"]
records: | $(READY)
	$(BIN)/python -m tests.matrix --write tests/recorded --light $(ONLY)

# QUICK=1: a few pairs of each, too few for intervals
bench: | $(READY)
	$(BIN)/python -m benchmarks

# wheel and source archive, checked, and tried in a clean environment of every Python at hand
dist: | .venv/ready-all
	rm -rf dist
	$(BIN)/python -m build --outdir dist .
	$(BIN)/python -m twine check --strict dist/*
	$(BIN)/check-wheel-contents dist/*.whl
	$(BIN)/python tests/everywhere.py dist
	$(BIN)/python tests/everywhere.py dist tutorials

# machine-made inputs against the command line, FUZZ of them; finds go to tests/corpus
fuzz: | $(READY)
	$(BIN)/python -m fuzz

# hostile command lines and records, by a generator that shares nothing with fuzz/: make hostile [COUNT=3000] [SEED=1]
hostile: | $(READY)
	$(BIN)/python tests/hostile.py lines $(or $(COUNT),3000) $(or $(SEED),1)
	$(BIN)/python tests/hostile.py traces $(or $(COUNT),1000) $(or $(SEED),1)

# slips and neutral twins as typed, and how many come out right: make slips [LIST=hand] [HALF=seen]
slips: | $(READY)
	$(BIN)/python tests/hand.py $(or $(LIST),peers) $(or $(HALF),all)

# what is doubted with one value of a built-in case 5 % up or down: make nearby [CASES="zotov-89 moroianu"]
nearby: | $(READY)
	$(BIN)/python -m fuzz.nearby $(CASES)

# small mistakes in a module, a room or all, hours long; goes on where it stopped: make mutate MODULE=mechsym.hinge
# [COUNT=30] [TESTS=tests/hinge/test_springs.py] [MOVES="hinge"]
mutate: | $(READY)
	$(BIN)/python -m fuzz.mutants $(or $(MODULE),mechsym) $(COUNT) $(if $(TESTS),--tests "$(TESTS)") $(if $(MOVES),--moves "$(MOVES)")

# the n-th call that changes a file fails, for every n: make faults [ONLY="hinge export"]
faults: | $(READY)
	$(BIN)/python -m tests.faults $(ONLY)

# Ctrl-C at 20 random times in each command: make interrupts [ONLY="sweep study"]
interrupts: | .venv/ready-all
	$(BIN)/python -m tests.interrupts $(ONLY)

# known holes of the smallest versions that pyproject.toml allows, and of those installed
audit-deps: | .venv/ready-all
	$(BIN)/python -m tests.floors

# the state of the package in figures: lines, switches over kinds, floors, errors of strict types
house: | $(READY)
	$(BIN)/python tests/house.py

lint: | $(READY)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

format: | $(READY)
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

clean:
	rm -rf .venv .venv-step demo build dist *.egg-info
