"""Hostile lines and records, each in a process of its own: `python tests/hostile.py lines|traces COUNT [SEED [BEGIN]]`.

Shares nothing with fuzz/: the options are asked of the command line itself, each gets a value of its kind, or anything;
records are made of clean ones by what loggers, spreadsheets and people do to them. Told are tracebacks, warnings, exit
statuses that there are not, more than one line of an error, more than 30 s of a processor and more than 2 GB.
"""

import importlib
import os
import random
import resource
import signal
import sys
import tempfile
import time
import traceback
from pathlib import Path

import click
import hostile_records

LIMIT, SPACE, PATIENCE = 30, 2e9, 600  # of a processor [s], of memory [B], by the clock [s]
STATUSES = (0, 1, 2, 3, 74, 130)
NOT_RUN = ("app", "reproduce", "native", "derive")  # opens a port, takes minutes, compiles, writes beside the package
NOT_GIVEN = ("--write", "--help", "--scheduler", "--jobs")
CASES = (
    "zotov-89", "zotov-142", "chmielewski", "nunes-slider-crank", "nunes-hypocycloid", "moroianu", "balandin",
    "generator", "alpha-stirling", "opposed-pistons", "case.toml", "empty.toml", "noise.bin", ".", "nothing",
)  # fmt: skip
JUNK = (
    "", " ", "0", "-1", "-0.0", "1e400", "1e-320", "nan", "inf", "-inf", ",", ";", "..", "1..2", "1..2:0", "2..1:3",
    "1:2:-1", "1:2:0", "1,2,3", "1,,2", "1 m", "5 rpm", "50 %", "1e9 rpm", "-3 deg", "é", "=", "x=", "=x", "phid=1",
    "r=r", "A" * 5000, "(" * 300, "1/0", "0/0", "lambda: 0", "__import__('os')", "../x", "-", "'", '"', "\n", "a\nb",
    "%s", "{}", "{0}", "[]", "null", "true", "9" * 400, "0x10", "٣", "１", "1_0", "½", "∞", "π", "1e3,1e3", "a.b.c",
    "*", "~", "$HOME", "x.zip", "x.csv", "x.toml", "x/y/z", "con", "phi = 0, phi = 1", "sin(phi)", "r*sin(phi)",
)  # fmt: skip
TEXTS = {
    "--set": ("parameters.r=1", "r1=0", "r1=1e300", "cycle.bore=0", "operation.speed=1e9", "spring.p0=-1", "t_end=0",
              "simulation.turns=1", "simulation.output_step=1e-12", "doubts.knock=1", "load={}", "g=nan", "I2=1e-300",
              "k1=0", "m0=-1", "a=b=c", "cycle={}", "parameters=1", "simulation.t_end=1 s", "cycle.kind=none"),
    "--speeds": ("100:9000:1", "80", "0", "1e9", "80..90:3", "90:80:5", "80,80", "1000..8000:100000", "-80"),
    "--over": ("operation.speed=80..90:2", "cycle.bore=0..1:3", "x=1..2:2", "bore=1,2", "operation.speed=1..2:1000000"),
    "--free": ("I2", "k1,c1", "I2,I2", "friction.constant", "nobody", ",", "I0,I2,k1,c1,r,l,m0", "l"),
    "--against": ("slider_crank.x", "crosshead.inertia", "x", "./case.toml:x", "crosshead.", ".x", "four_bar.psi"),
    "--formula": ("r*sin(phi)", "x = x", "1/0", "sin(", "r**r**r", "\\frac{r}{", "sum(phi)", "9**9**9", "phi!", "a;b"),
    "--units": ("mm", "mm, MPa", "kg^2", "m, mm", "furlong", "rad/s, rpm"),
}  # fmt: skip
WARM = (  # read once, so that a forked process starts at once
    "mechsym.cli.cycle", "mechsym.cli.forces", "mechsym.cli.hinge", "mechsym.cli.identify", "mechsym.cli.simulate",
    "mechsym.codesign.task", "mechsym.jobs.hinge", "mechsym.jobs.identify", "mechsym.jobs.run", "scipy.optimize",
    "sympy", "mechsym.cli.audit", "mechsym.audit.hosts.formula",
)  # fmt: skip


def main(kind: str, count: str, seed: str = "1", begin: str = "0") -> int:
    """Run and print faults; 0 when there are none."""
    for module in WARM:
        importlib.import_module(module)
    faults, ends = 0, dict[int, int]()
    for number in range(int(begin), int(begin) + int(count)):
        rng = random.Random(f"{kind} {seed} {number}")
        with tempfile.TemporaryDirectory() as outer:
            place = Path(outer) / "a" / "b"  # a path upwards stays inside
            place.mkdir(parents=True)
            words = {"lines": line, "traces": trace}[kind](rng, place)
            status, fault = run(words, place)
        ends[status] = ends.get(status, 0) + 1
        if fault:
            faults += 1
            print(
                f"{kind} {seed} {number}: {fault}: {' '.join(w if len(w) < 60 else w[:57] + '...' for w in words)!r}",
                flush=True,
            )
        if (number + 1) % 50 == 0:
            print(f"{number + 1} {kind}, exit status {dict(sorted(ends.items()))}, {faults} faults", flush=True)
    return 1 if faults else 0


def line(rng: random.Random, place: Path) -> list[str]:
    """A command with options of its own, half of the values right in kind."""
    from mechsym.cli import COMMANDS, mechsym

    (place / "empty.toml").write_text("")
    (place / "noise.bin").write_bytes(rng.randbytes(500))
    (place / "case.toml").write_text(_spoiled(rng))
    hostile_records.write(rng, place / "trace.csv", rng.choice(list(hostile_records.HEADS)), most=6000)
    name = rng.choice([c for c in COMMANDS if c not in NOT_RUN])
    command = mechsym.get_command(click.Context(mechsym), name)
    words = [name]
    for parameter in command.params:
        if isinstance(parameter, click.Argument):
            words += [_argument(rng, name, parameter) for _ in range(2 if parameter.nargs == -1 else 1)]
        elif parameter.opts[-1] not in NOT_GIVEN and rng.random() < (0.6 if parameter.required else 0.18):
            words += _option(rng, parameter)
    words += ["--json"] * (rng.random() < 0.3)
    return [w.replace("\0", "") for w in words]


def _argument(rng: random.Random, name: str, parameter: click.Argument) -> str:
    if isinstance(parameter.type, click.Choice):
        return rng.choice([*parameter.type.choices, rng.choice(JUNK)])
    if name == "eval":
        return rng.choice(("crosshead", "hypocycloid", "crank_train", "rodless", "crank_throw", "case.toml", *JUNK[:6]))
    return rng.choice(CASES) if rng.random() < 0.85 else rng.choice(JUNK)


def _option(rng: random.Random, parameter: click.Parameter) -> list[str]:
    option = max(parameter.opts, key=len)
    if getattr(parameter, "is_flag", False):
        return [option]
    pools = [JUNK]
    if isinstance(parameter.type, click.Choice):
        pools = [list(parameter.type.choices)] * 4 + pools
    if isinstance(parameter.type, click.Path):
        pools = [("trace.csv", "case.toml", "empty.toml", "noise.bin", ".", "out", "nothing.csv")] * 4 + pools
    pools += [TEXTS[option]] * 4 if option in TEXTS else []
    return [f"{option}={rng.choice(rng.choice(pools))}"]


def _spoiled(rng: random.Random) -> str:
    """A built-in case, one of whose values is anything."""
    from mechsym import cases

    lines = cases.text(rng.choice([c for c in CASES if c in cases.names()])).splitlines()
    keyed = [i for i, text in enumerate(lines) if " = " in text]
    at = rng.choice(keyed)
    worth = rng.choice(
        ("0", "-1", "1e300", "1e-300", "nan", '"x"', "[]", "{}", "true", '"1 furlong"', "[0, 0]", '"1 kg"', "9" * 40)
    )
    lines[at] = f"{lines[at].partition(' = ')[0]} = {worth}"
    return "\n".join(lines)


def trace(rng: random.Random, place: Path) -> list[str]:
    """A record for a command that reads one."""
    kind = rng.choice(("speed", "speed", "speed", "pressure", "pressure", "torque"))
    hostile_records.write(rng, place / "d.csv", kind)
    if kind == "speed":
        case, letters = rng.choice((*[("chmielewski", ("I2", "I2,k1", "friction.viscous", "c1", "I0,I2,k1,c1"))] * 4,
                                    ("zotov-89", ("m", "I1")), ("generator", ("l", "friction.constant"))))  # fmt: skip
        words = ["identify", case, "--trace", "d.csv", "--free", rng.choice(letters)]
        words += ["--set", "drive.torque=50 N*m"] if case != "chmielewski" else []
        return words + rng.choice(([], [], ["--set", "drive.time=0"], ["--json"], ["--out", "out"]))
    if kind == "torque":
        return [
            "cycle",
            rng.choice(("zotov-89", "generator")),
            "--torque",
            "d.csv",
            *(["--noise", "2 N*m"] if rng.random() < 0.9 else []),
        ]
    if rng.random() < 0.2:
        sizes = ["--bore", "68 mm", "--stroke", "55 mm", "--rod", "84 mm", "--compression", "8.5"]
        return ["new", "diagram", "--trace", "d.csv", *sizes, "--out", "out"]
    command = rng.choice(("cycle", "cycle", "cycle", "forces", "hinge", "fmu", "guide"))
    words = [command, "generator", "--diagram", "d.csv", *(["--platforms", "none"] if command == "fmu" else [])]
    if command == "cycle" and rng.random() < 0.3:
        hostile_records.write(rng, place / "m.csv", kind)
        words += rng.choice((["--motored", "m.csv"], ["--diagram", "m.csv"]))
    return words


def run(words: list[str], place: Path) -> tuple[int, str]:
    """Exit status of a command line, and what is wrong with its answer."""
    child = os.fork()
    if child == 0:
        _become(words, place)
    began = time.monotonic()
    while True:
        done, status, used = os.wait4(child, os.WNOHANG)
        if done or time.monotonic() - began > PATIENCE:
            break
        time.sleep(0.01)
    if not done:
        os.kill(child, signal.SIGKILL)
        _, status, used = os.wait4(child, 0)
    code = os.waitstatus_to_exitcode(status)
    err = (place / ".err").read_text("utf-8", "replace")
    if code in (-signal.SIGXCPU, -signal.SIGKILL):
        return code, f"more than {LIMIT} s"
    if used.ru_maxrss * 1024 > SPACE:
        return code, f"{used.ru_maxrss / 1e6:.2g} GB"
    if "Traceback" in err or "Warning" in err or code not in STATUSES:
        return code, f"exit {code}, {(err.splitlines() or ['nothing said'])[-1][:150]}"
    lines = err.splitlines()
    if code == 2 and "check" not in words and (len(lines) != 1 or not lines[0].startswith("mechsym: ")):
        return code, f"{len(lines)} lines of an error: {err[:150]!r}"
    return code, ""


def _become(words: list[str], place: Path) -> None:
    resource.setrlimit(resource.RLIMIT_CPU, (LIMIT, LIMIT + 5))
    resource.setrlimit(resource.RLIMIT_AS, (int(8e9), int(8e9)))
    os.chdir(place)
    for handle, name in ((1, ".out"), (2, ".err")):
        os.dup2(os.open(place / name, os.O_WRONLY | os.O_CREAT | os.O_TRUNC), handle)
    sys.stdout, sys.stderr = (open(handle, "w", encoding="utf-8", closefd=False) for handle in (1, 2))  # noqa: SIM115
    sys.stdin = open(os.devnull)  # noqa: SIM115
    sys.argv = ["mechsym", *words]
    from mechsym.cli import main as command

    code: object = 0
    try:
        command()
    except SystemExit as ended:
        code = ended.code or 0
    except BaseException:
        traceback.print_exc()
        code = 70
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code if isinstance(code, int) else 70)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
