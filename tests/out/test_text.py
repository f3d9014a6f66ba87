"""Every language against the function that it was written from, at 100 random states, each run by its own tool.

C by gcc, JAX by jax, MATLAB by Octave, Modelica by rumoca; where a tool does not install here (Julia), or runs whole
models only (Modelica), a small reader of the text evaluates the statements.
"""

import ctypes
import dataclasses
import importlib.util
import json
import re
import subprocess
from shutil import which

import casadi as ca
import numpy as np
import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.cli import mechsym
from mechsym.errors import BadInput
from mechsym.jobs.export import ready
from mechsym.mechanisms import names
from mechsym.mechanisms.record import bind, generated
from mechsym.out.block import block_of
from mechsym.out.text.dialects import of_block, of_mechanism
from mechsym.out.text.files import files
from mechsym.out.text.language_c import model
from mechsym.simulate import Settings, simulate

DERIVED = [n for n in names() if n != "crank_train"]
LANGUAGES = ("c", "modelica", "julia", "matlab", "jax")


def points(entries, count=100):
    """Random arguments; lengths of rods are several cranks, so that every square root has a value."""
    random = np.random.default_rng(3)
    scale = [5.0 if n in ("l", "l1", "l2") else 0.1 if n == "offset" else 1.0 for n in entries]
    return random.uniform(0.3, 1.0, (count, len(entries))) * scale


def truths(written, functions):
    rows = {}
    for group, f in functions.items():
        v = points(written.inputs[group])
        sizes = np.cumsum([0, *(f.numel_in(i) for i in range(f.n_in()))])
        found = []
        for row in v:
            outputs = f.call([ca.DM(row[a:b]) for a, b in zip(sizes[:-1], sizes[1:], strict=True)])
            found.append(np.concatenate([np.asarray(ca.densify(o)).ravel(order="F") for o in outputs]))
        rows[group] = v, np.array(found)
    return rows


@pytest.fixture(scope="module")
def cases_of(exported):
    """What is written of each mechanism, and the values that it must have."""
    made = {}

    def get(name):
        if name not in made:
            if name == "crank_train":
                block = exported("opposed-pistons")[1]
                written, functions = of_block(block), {"rates": block.rates, "observed": block.observed}
            else:
                written = of_mechanism(name)
                mechanism = bind(name, {p: ca.SX.sym(p) for p in generated(name).PARAMETERS})
                functions = {g: mechanism.functions[g] for g in written.tapes}
            made[name] = written, truths(written, functions)
        return made[name]

    return get


def close(found, wanted):
    size = np.maximum(np.abs(wanted), np.max(np.abs(wanted), axis=0, initial=1e-12))
    assert np.max(np.abs(found - wanted) / size, initial=0.0) <= 1e-13


@pytest.mark.parametrize("name", names())
def test_c_by_gcc(cases_of, tmp_path, name):
    written, rows = cases_of(name)
    if which("gcc") is None:
        pytest.skip("no gcc is installed")
    for file, text in files(written, "c").items():
        # the functions of a machine are for its own use; here they are asked one by one
        (tmp_path / file).write_text(re.sub(r"^static void (rates|observed)\(", r"void \1(", text, flags=re.M))
    (source,) = tmp_path.glob("*.c")
    options = ["-std=c99", "-Wpedantic", "-Wall", "-Wextra", "-Werror", "-O2", "-ffp-contract=off"]
    library = tmp_path / "lib.so"
    subprocess.run(["gcc", *options, "-shared", "-fPIC", str(source), "-o", str(library), "-lm"], check=True)
    loaded = ctypes.CDLL(str(library))
    for group, (v, wanted) in rows.items():
        call = getattr(loaded, group if written.block else f"{name}_{group}")
        found = np.zeros(wanted.shape)
        for row, out in zip(np.ascontiguousarray(v), found, strict=True):
            call(row.ctypes.data_as(ctypes.c_void_p), out.ctypes.data_as(ctypes.c_void_p))
        close(found, wanted)


@pytest.mark.slow
@pytest.mark.parametrize("name", names())
def test_jax_by_jax(cases_of, tmp_path, name):
    pytest.importorskip("jax", reason="jax is not installed")
    written, rows = cases_of(name)
    ((file, text),) = files(written, "jax").items()
    (tmp_path / file).write_text(text)
    spec = importlib.util.spec_from_file_location(f"exported_{name}", tmp_path / file)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    for group, (v, wanted) in rows.items():
        found = np.asarray(getattr(module, group)(module.jnp.asarray(v.T))).T
        close(found, wanted)


@pytest.mark.slow
@pytest.mark.parametrize("name", names())
def test_matlab_by_octave(cases_of, tmp_path, name):
    if which("octave-cli") is None:
        pytest.skip("Octave is not installed")
    written, rows = cases_of(name)
    ((file, text),) = files(written, "matlab").items()
    (tmp_path / file).write_text(text)
    lines = [f"addpath('{tmp_path}');"]
    for group, (v, _) in rows.items():
        np.savetxt(tmp_path / f"{group}.in", v, fmt="%.17g")
        stem = file.removesuffix(".m")
        lines.append(f"V = load('{tmp_path}/{group}.in'); Y = []; "
                     f"for k = 1:rows(V), Y = [Y; {stem}('{group}', V(k, :)')']; end; "
                     f"f = fopen('{tmp_path}/{group}.out', 'w'); "
                     "fprintf(f, [repmat('%.17g ', 1, columns(Y)) '\\n'], Y'); "
                     "fclose(f);")  # fmt: skip
    # Octave 7 may stumble over its own exit when there is no terminal; what it wrote is what counts
    subprocess.run(["octave-cli", "--eval", "\n".join(lines)], capture_output=True, check=False, cwd=tmp_path)
    for group, (_, wanted) in rows.items():
        close(np.loadtxt(tmp_path / f"{group}.out", ndmin=2).reshape(wanted.shape), wanted)


WORDS = {n: getattr(np, n) for n in ("sqrt", "exp", "log", "sin", "cos", "tan", "sinh", "cosh", "tanh", "sign")}
WORDS |= {"asin": np.arcsin, "acos": np.arccos, "atan": np.arctan, "atan2": np.arctan2, "abs": np.abs}
WORDS["atan"] = lambda y, *x: np.arctan2(y, *x) if x else np.arctan(y)  # in Julia of one or two numbers
WORDS |= {"min": np.minimum, "max": np.maximum, "ifelse": np.where, "hypot": np.hypot}


def julia_values(text, group, v):
    body = re.search(rf"^function {group}\(v\)\n(.*?)^end", text, re.M | re.S)[1]
    body = re.sub(r"v\[(\d+)\]", r"v\1", body).replace("^", "**").replace("return ", "result = ")
    place = {**WORDS, **{f"v{i + 1}": column for i, column in enumerate(v.T)}}
    exec(re.sub(r"^\s+", "", body, flags=re.M), place)
    return np.stack(np.broadcast_arrays(*place["result"], v[:, 0])[:-1], axis=-1)


@pytest.mark.parametrize("name", names())
def test_julia_by_a_reader(cases_of, name):
    written, rows = cases_of(name)
    ((_, text),) = files(written, "julia").items()
    for group, (v, wanted) in rows.items():
        close(julia_values(text, group, v), wanted)


def modelica_values(text, group, v, inputs):
    body = re.search(rf"^function {group}\n(.*?)^end {group};", text, re.M | re.S)[1]
    outputs = re.findall(r"output Real (\w+)", body)
    place = {**WORDS, **dict(zip(inputs, v.T, strict=True))}
    for name, value in re.findall(r"(\w+) := (.*?);\n", body.partition("algorithm")[2]):
        value = re.sub(r"\(if (.*?) then (.*?) else (.*?)\)", r"ifelse(\1, \2, \3)", value).replace("^", "**")
        place[name] = eval(value, place)
    return np.stack(np.broadcast_arrays(*(place[o] for o in outputs), v[:, 0])[:-1], axis=-1)


@pytest.mark.parametrize("name", DERIVED)
def test_modelica_by_a_reader(cases_of, name):
    written, rows = cases_of(name)
    ((_, text),) = files(written, "modelica").items()
    for group, (v, wanted) in rows.items():
        close(modelica_values(text, group, v, written.inputs[group]), wanted)


@pytest.mark.parametrize("name", [*DERIVED, "zotov-89", "chmielewski", "opposed-pistons"])
def test_modelica_is_valid_to_rumoca(exported, tmp_path, name):
    rumoca = pytest.importorskip("rumoca", reason="rumoca is not installed")
    written = of_mechanism(name) if name in DERIVED else of_block(exported(name)[1])
    ((file, text),) = files(written, "modelica").items()
    (tmp_path / file).write_text(text)
    assert [str(d) for d in rumoca.validate(str(tmp_path / file))] == []


def test_the_machine_in_c_runs_as_simulate_runs(exported, tmp_path):
    """Through the header alone, from a program without Python."""
    if which("gcc") is None:
        pytest.skip("no gcc is installed")
    run, block = exported("zotov-89")
    for file, text in files(of_block(block), "c").items():
        (tmp_path / file).write_text(text)
    (tmp_path / "main.c").write_text(
        '#include <stdio.h>\n#include "zotov_89.h"\n'
        "int main(void)\n{\n    static double own[200];\n    if (zotov_89_size() > sizeof own)\n        return 2;\n"
        "    zotov_89_start(own, 1e-13);\n    if (zotov_89_advance(own, 5.0) != 1)\n        return 3;\n"
        '    printf("%.17g %.17g", zotov_89_get(own, zotov_89_phi), zotov_89_get(own, zotov_89_phid));\n'
        "    return 0;\n}\n"
    )
    program = tmp_path / "run"
    sources = [str(tmp_path / name) for name in ("main.c", "zotov_89.c")]
    subprocess.run(["gcc", "-std=c99", "-O2", *sources, "-o", str(program), "-lm"], check=True)
    found = np.array(subprocess.check_output([program]).split(), dtype=float)
    problem = dataclasses.replace(run.problem, output=(5.0,), t_end=5.0, turns=None)
    wanted = simulate(problem, Settings(tolerance=1e-13, check="none"))
    assert found == pytest.approx([wanted.columns["phi"][-1], wanted.columns["phid"][-1]], rel=1e-10)


@pytest.mark.parametrize("tool", ["gcc -std=c11", "clang -std=c99", "g++ -x c++", "clang++ -x c++"])
def test_the_machine_in_c_compiles_without_a_word(exported, tmp_path, tool):
    """As C and as C++; its exact derivatives are offered, so nothing in it is unused."""
    words = tool.split()
    if which(words[0]) is None:
        pytest.skip(f"no {words[0]} is installed")
    for file, text in files(of_block(exported("zotov-89")[1]), "c").items():
        (tmp_path / file).write_text(text)
    command = [*words, "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-c", "zotov_89.c", "-o", "zotov_89.o"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0 and not done.stderr, done.stderr


def test_derivatives_of_the_machine_in_c_are_those_of_differences(exported, tmp_path):
    if which("gcc") is None:
        pytest.skip("no gcc is installed")
    for file, text in files(of_block(exported("zotov-89")[1]), "c").items():
        (tmp_path / file).write_text(text)
    library = tmp_path / "machine.so"
    source = str(tmp_path / "zotov_89.c")
    subprocess.run(["gcc", "-std=c99", "-O2", "-shared", "-fPIC", source, "-o", str(library), "-lm"], check=True)
    machine, place = ctypes.CDLL(str(library)), _places(tmp_path / "zotov_89.h")
    machine.zotov_89_get.restype = ctypes.c_double
    machine.zotov_89_size.restype = ctypes.c_size_t
    own = ctypes.create_string_buffer(machine.zotov_89_size())
    machine.zotov_89_start(own, ctypes.c_double(1e-13))

    def at(name, value):
        assert machine.zotov_89_set(own, place[name], ctypes.c_double(value))

    at("phi", 1.0)
    at("phid", 8.0)  # at the speed of the design the hinge makes the first of them zero
    for of, by in (("phidd", "phi"), ("phidd", "p0"), ("spring_force", "phi"), ("R_x_A", "m3")):
        start, change = machine.zotov_89_get(own, place[by]), ctypes.c_double()
        one = lambda n: ctypes.byref(ctypes.c_uint(place[n]))  # noqa: E731
        step = ctypes.byref(ctypes.c_double(1.0))
        size = ctypes.c_size_t(1)
        assert machine.zotov_89_change(own, one(of), size, one(by), size, step, ctypes.byref(change))
        values = []
        for sign in (1, -1):
            at(by, start * (1 + sign * 1e-5))
            values.append(machine.zotov_89_get(own, place[of]))
        at(by, start)
        assert change.value and change.value == pytest.approx((values[0] - values[1]) / (2e-5 * start), rel=1e-6)


def _places(header):
    found = re.findall(r"zotov_89_(\w+) = (\d+)", header.read_text())
    return {name: int(number) for name, number in found}


@pytest.mark.slow
@pytest.mark.parametrize("name", ["zotov-89", "chmielewski"])
def test_a_machine_in_jax_has_the_rates_of_its_block(exported, tmp_path, name):
    """Curves and switches included, run with numpy in the place of jax.numpy where jax is not installed."""
    pytest.importorskip("jax", reason="jax is not installed")
    block = exported(name)[1]
    ((file, text),) = files(of_block(block), "jax").items()
    (tmp_path / file).write_text(text)
    spec = importlib.util.spec_from_file_location("exported_machine", tmp_path / file)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    random = np.random.default_rng(1)
    for t in (0.5, 2.0):
        x = random.uniform(0.1, 40.0, len(block.states))
        p, u = [port.start for port in block.parameters], np.zeros(len(block.inputs))
        w = [c.poly(c.ratio * x[c.state], k) for c in block.curves for k in (0, 1)]
        s = [float(t >= p[[q.name for q in block.parameters].index(n)]) for n in block.switches]
        wanted = np.asarray(block.rates(t, x, u, p, w, s)).ravel()
        found = np.asarray(module.derivative(t, module.jnp.asarray(x), u, module.p_start))
        np.testing.assert_allclose(found, wanted, rtol=1e-11)


@pytest.mark.parametrize(
    "words, said",
    [
        (["crosshead", "--to", "fortran"], "allowed are c, modelica, julia, matlab, jax"),
        (["crank_train", "--to", "c"], "export a case of it"),
        (["nothing", "--to", "c"], "neither built in nor a readable file"),
    ],
)
def test_bad_input_is_one_line(tmp_path, words, said):
    done = CliRunner().invoke(mechsym, ["export", *words, "--out", str(tmp_path)])
    assert isinstance(done.exception, BadInput) and said in str(done.exception)


def test_the_command_writes_what_it_says(tmp_path):
    words = ["export", "hypocycloid", "--to", ",".join(LANGUAGES), "--out", str(tmp_path), "--json"]
    done = CliRunner().invoke(mechsym, words)
    assert done.exit_code == 0, done.output
    files = [p for p in tmp_path.iterdir() if p.name != "summary.json"]
    assert sorted(json.loads(done.output)["written"]) == sorted(str(p) for p in files)
    assert len(files) == 6


def test_words_of_a_case_are_no_code():
    """`about` of a case from elsewhere, which nobody trusts, stands in comments and texts, and cannot end them."""
    case = cases.load("zotov-89")
    about = 'drive */ int y; /* "x" \\ %d\n*/ int z;'
    block = block_of(case.name, about, ready(case))
    written = of_block(block)
    texts = {**files(written, "c"), "model.h": model(block)}
    for text in texts.values():
        assert "drive" in text or text.startswith("#include")
        assert not re.search(r"\bint [yz]\b", re.sub(r"/\*.*?\*/", "", text, flags=re.S))
    (modelica,) = files(written, "modelica").values()
    assert re.fullmatch(r'model Zotov_89 "[^"\\]*drive[^"\\]*"', modelica.splitlines()[0])
    for language, mark in (("julia", "#"), ("matlab", "%"), ("jax", "#")):
        (text,) = files(written, language).values()
        assert all(line.startswith(mark) for line in text.splitlines() if "int z" in line)
