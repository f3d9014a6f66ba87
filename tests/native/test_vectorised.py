"""Every loop over lanes or points becomes vector code: gcc says so of each."""

import re
import shutil
import subprocess
from pathlib import Path

import casadi as ca
import pytest
from native.models import functions

from mechsym import cases
from mechsym.jobs.cycle import cycle
from mechsym.native import compiler, integrate, march, source
from mechsym.native.source import block, bodies
from mechsym.sweep.run import Plan, sweep

GCC = shutil.which("gcc")
pytestmark = [pytest.mark.skipif(not GCC, reason="no gcc"), pytest.mark.slow]
LOOP = "for (long p = 0; p < m; p++)"


def scalar_loops(text: str, mode: str, folder: Path) -> list[str]:
    """Loops of the emitted stage and block functions that gcc leaves scalar."""
    (folder / "made.c").write_text(text)
    command = [GCC, *compiler.flags(mode), "-fopt-info-vec-optimized", "made.c", "-o", "made.so", "-lm"]
    said = subprocess.run(command, cwd=folder, check=True, capture_output=True, text=True).stderr
    done = {int(n) for n in re.findall(r"made\.c:(\d+):\d+: optimized: loop vectorized", said)}
    lines = text.splitlines()
    loops = [i for i, line in enumerate(lines, 1) if LOOP in line]
    assert loops
    return [lines[i] for i in loops if not done & {i - 1, i, i + 1}]


def batch(function: ca.Function, mode: str) -> str:
    found = source.program(function, mode)
    name, kernels = found.tape.name, found.kernels
    keep = f"void *keep(void) {{ return {name}_block; }}"
    return "\n".join([source.preamble(), bodies(kernels, name), block(kernels, name), keep])


def broken() -> ca.Function:
    x = ca.SX.sym("x", 3)
    return ca.Function("broken", [x], [x[0] ** 1.3 + x[1] ** -0.7, ca.exp(x[2]) * x[0] ** 0.25])


@pytest.mark.parametrize("mode", ["strict", "fast"])
@pytest.mark.parametrize("name", ["crosshead", "crankshaft_flywheel", "crank_train", "hypocycloid", "broken"])
def test_batches(name, mode, tmp_path):
    function = broken() if name == "broken" else functions(name)["acceleration"]
    assert not scalar_loops(batch(function, mode), mode, tmp_path)


@pytest.mark.parametrize("mode", ["strict", "fast"])
def test_the_printed_cycle(mode, tmp_path, monkeypatch):
    steps = marched(monkeypatch, "mechsym.cycle.kinds.printed")
    cycle(cases.load("nunes-slider-crank", {"cycle.method": "nunes2017_printed"}))
    assert not scalar_loops(text(steps[0], mode), mode, tmp_path)


@pytest.mark.heavy
def test_the_kernel_of_guides(tmp_path, monkeypatch):
    steps = marched(monkeypatch, "mechsym.hinge.kernel")
    sweep(Plan(case="zotov-89", over=("spring.p0=4..6MPa:2",), analysis="guides"))
    assert not scalar_loops(text(steps[0], "fast"), "fast", tmp_path)


def marched(monkeypatch: pytest.MonkeyPatch, module: str) -> list[ca.Function]:
    steps: list[ca.Function] = []

    def recording(step: ca.Function, mode: str = "fast") -> march.March:
        steps.append(step)
        return march.marcher(step, mode)

    monkeypatch.setattr(f"{module}.marcher", recording)
    return steps


def text(step: ca.Function, mode: str) -> str:
    sizes = (step.numel_in(0), step.numel_in(1), step.numel_in(2))
    return march.text(march.separated(source.program(step, mode).tape, sizes)[1], sizes)


def test_steps_that_look_back(tmp_path):
    from native.test_adams import discs

    batch = integrate._spread(discs(), "fast")
    (made,), _ = integrate._texts(batch, "adams", 16, "fast")
    (tmp_path / "made.c").write_text(made)
    command = [GCC, *compiler.flags("fast"), "-fopt-info-vec-optimized", "made.c", "-o", "made.so", "-lm"]
    said = subprocess.run(command, cwd=tmp_path, check=True, capture_output=True, text=True).stderr
    done = {int(n) for n in re.findall(r"made\.c:(\d+):\d+: optimized: (?:loop|basic block part) vectorized", said)}
    lines = made.splitlines()
    found = 0
    for name in ("static void ms_unbend(", "noinline)) void ms_stride("):
        start = next(i for i, line in enumerate(lines) if name in line)
        end = next(i for i in range(start, len(lines)) if lines[i] == "}")
        for i in (i for i in range(start, end) if "MS_EACH" in lines[i]):
            if "run->surfaces" in lines[i - 1] or "MS_RO; i++" in lines[i - 1]:
                continue  # for surfaces alone, and states that this function has not
            found += 1
            assert done & set(range(i, i + 4)), lines[i : i + 3]
    assert found > 5
