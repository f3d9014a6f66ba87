"""The C that is emitted runs under the sanitizers of addresses and of undefined behaviour, by gcc and by clang."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path
from shutil import which

import pytest
from built_in import needed

from mechsym import cases
from mechsym.jobs.export import ready
from mechsym.out.block import block_of
from mechsym.out.text.dialects import of_block
from mechsym.out.text.files import files

pytestmark = [pytest.mark.slow, pytest.mark.heavy]

SANITIZED = ["-fsanitize=address,undefined", "-fno-sanitize-recover=all", "-fno-omit-frame-pointer", "-g", "-O1"]
# a crosshead with a guide, an elastic shaft with a switched torque, and gas and brake on a crank train
MACHINES = ("zotov-89", "chmielewski", "alpha-stirling")
# the program turns for 2 s, asks for everything on the way, and starts again
MAIN = """#include <stdio.h>
#include <stdlib.h>
#include "{name}.h"
int main(void)
{{
    const unsigned places[] = {{{places}}};
    double *own = malloc({name}_size()), sum = 0.0;
    for (int again = 0; again < 2; again++) {{
        {name}_start(own, 1e-9);
        for (int k = 1; k <= 20; k++)
            if ({name}_advance(own, 0.1 * k) != 1)
                return 3;
        for (size_t k = 0; k < sizeof places / sizeof *places; k++)
            sum += {name}_get(own, places[k]);
    }}
    free(own);
    printf("%.17g", sum);
    return 0;
}}
"""


@pytest.fixture(params=["gcc", "clang"])
def compiler(request, tmp_path):
    """A compiler that has both sanitizers."""
    if which(request.param) is None:
        pytest.skip(f"no {request.param} is installed")
    (tmp_path / "empty.c").write_text("int main(void) { return 0; }\n")
    made = subprocess.run(
        [request.param, *SANITIZED, str(tmp_path / "empty.c"), "-o", str(tmp_path / "empty")], check=False
    )
    if made.returncode:
        pytest.skip(f"{request.param} has no sanitizers here")
    return request.param


def clean(done):
    assert not re.search("runtime error|Sanitizer", done.stderr), done.stderr[:2000]
    assert done.returncode == 0, done.stderr[:2000]


def test_sanitizers_see_a_mistake(compiler, tmp_path):
    text = "#include <stdlib.h>\nint main(int n, char **a) { double *x = malloc(8); (void)a; return (int)x[n]; }\n"
    (tmp_path / "wrong.c").write_text(text)
    subprocess.run([compiler, *SANITIZED, str(tmp_path / "wrong.c"), "-o", str(tmp_path / "wrong")], check=True)
    done = subprocess.run([str(tmp_path / "wrong")], capture_output=True, text=True, check=False)
    with pytest.raises(AssertionError):
        clean(done)


@pytest.mark.parametrize("case", MACHINES)
def test_a_machine_as_a_program(compiler, tmp_path, case):
    found = cases.load(case, needed(case))
    written = files(of_block(block_of(found.name, found.about, ready(found))), "c")
    for file, text in written.items():
        (tmp_path / file).write_text(text)
    (source,) = (name for name in written if name.endswith(".c"))
    name = source.removesuffix(".c")
    header = written[f"{name}.h"]
    places = re.findall(rf"{name}_\w+ = (\d+),", header)
    assert len(places) > 10
    (tmp_path / "main.c").write_text(MAIN.format(name=name, places=", ".join(places)))
    sources = [str(tmp_path / "main.c"), str(tmp_path / source)]
    subprocess.run([compiler, "-std=c99", *SANITIZED, *sources, "-o", str(tmp_path / "run"), "-lm"], check=True)
    clean(subprocess.run([str(tmp_path / "run")], capture_output=True, text=True, check=False))


def surroundings(compiler: str, folder: Path) -> dict[str, str]:
    """Variables under which what Python compiles and loads is sanitized."""
    runtime = {"gcc": "libasan.so", "clang": "libclang_rt.asan-x86_64.so"}[compiler]
    library = subprocess.check_output([compiler, f"-print-file-name={runtime}"], text=True).strip()
    if not Path(library).is_file():
        pytest.skip(f"no {runtime}, which a sanitized library of Python's needs")
    if compiler == "gcc":  # its runtime wants the library of C++ beside it, whose exceptions other modules throw
        library += " " + subprocess.check_output([compiler, "-print-file-name=libstdc++.so.6"], text=True).strip()
    shared = ["-shared-libsan"] if compiler == "clang" else []
    return os.environ | {
        "CC": " ".join([compiler, *SANITIZED[:3], *shared]), "LD_PRELOAD": library, "XDG_CACHE_HOME": str(folder),
        "ASAN_OPTIONS": "detect_leaks=0", "UBSAN_OPTIONS": "print_stacktrace=1",
    }  # fmt: skip


# long ensembles with weights, works, segments, surfaces and wanted times
ENSEMBLE = """
import numpy as np
from native.test_adams import discs
from mechsym.native.integrate import integrate
from mechsym.native.runs import Level
surface = Level(state=1, level=0.5, direction=-1)
for changed in ({}, {"times": np.linspace(0.5, 299, 50)}, {"surfaces": (surface,)}, {"max_steps": 4000}):
    found = integrate(discs(rtol=1e-8, atol=1e-8, **changed), "adams")
    assert found.steps.min() > 100
"""


def test_steps_that_look_back(compiler, tmp_path):
    tests = str(Path(__file__).parents[1])
    found = surroundings(compiler, tmp_path)
    found["PYTHONPATH"] = os.pathsep.join([tests, found.get("PYTHONPATH", "")])
    clean(subprocess.run([sys.executable, "-c", ENSEMBLE], capture_output=True, text=True, check=False, env=found))
    assert list(tmp_path.rglob("*.so"))


@pytest.mark.parametrize("case", MACHINES)
def test_a_run_of_the_compiled_integrator(compiler, tmp_path, case):
    found = surroundings(compiler, tmp_path)
    short = ["--set", "t_end=2"] if case == "chmielewski" else ["--set", "simulation.turns=3"]
    command = [
        sys.executable,
        "-m",
        "mechsym",
        "simulate",
        case,
        *short,
        "--set",
        "simulation.backend=native",
        "--json",
    ]
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=found)
    clean(done)
    assert json.loads(done.stdout)["backend"] == "native"
    # what ran was compiled here, with the sanitizers
    assert list(tmp_path.rglob("*.so"))
