"""Inputs out of valid ones: cases, overrides, ranges, measured diagrams, formulas; each changed at one to three places.

Nothing here is taken from the package but the text of its built-in cases, and of the benches' literature.
"""

import functools
import math
import random
import re
import tomllib
from collections.abc import Callable
from pathlib import Path

Input = dict[str, object]  # argv: list of str, files: text by name

BENCHMARKS = Path(__file__).parent.parent / "benchmarks"
ASSUMED = ("phidd = 0", "r < l", "phid = 5", "lam < 1", "r = l", "phi > 0", "phidd", "r <", "l = 0")
CLAIMS = ("=", "approx", "lam^2", "within 1 %", "lam^4", "within 0 %", "x^2", "within 5e99 %")
VALUES = (
    "0", "-1", "1", "-0.0", "1e-300", "1e300", "1e-20", "1e20", "nan", "inf", "-inf", "true", "[]", "[1, 2]", '""',
    "{}", "2020-01-01", '"5 furlong"', '"1 m"', '"90 deg"', '"1 MPa"', '"100 rpm"', '"1 kg"', '"1 N*m"', '"1e9 m"',
    "9" * 30, "'", "[[", "0x10", "1_000", '"5 MPa/"', '"1 kg^99"', '"5,5"', '"½"',
)  # fmt: skip
CHARACTERS = "=[]{}\"'#.,\n \t-+*/^()0123456789eEabxyπ°\0é"
COMMANDS = (
    *(("cycle", name) for name in ("nunes-slider-crank", "nunes-hypocycloid", "zotov-89", "alpha-stirling")),
    *(("forces", name) for name in ("zotov-89", "zotov-142", "moroianu", "nunes-slider-crank", "balandin")),
    *(("size", name) for name in ("nunes-hypocycloid", "nunes-slider-crank")),
    *(("hinge", name) for name in ("zotov-89", "zotov-142", "moroianu")),
    *(("simulate", name) for name in ("chmielewski", "alpha-stirling", "opposed-pistons", "zotov-89")),
    ("flywheel", "zotov-89"),
)
SHORT = {"chmielewski": ["--set", "t_end=2"], "zotov-89": ["--set", "simulation.turns=2"]}
LETTERS = ("r1", "r2", "l1", "l2", "phi", "r1", "r2", "phi", "m1", "g", "x", "pi", "q")
FUNCTIONS = ("sin", "cos", "tan", "sqrt", "abs", "exp", "log", "asin", "atan2", "max", "f")
QUANTITIES = (
    "crosshead.x",
    "crosshead.dx_dphi",
    "crosshead.inertia",
    "hypocycloid.x",
    "crosshead.no",
    "x",
    "rodless.x",
)


def number(rng: random.Random) -> str:
    """A number of any size, often a usual one."""
    return rng.choice([f"{rng.uniform(-2, 2):.3g}", f"{10 ** rng.uniform(-12, 12):.3g}", str(rng.randint(-9, 9999))])


def scaled(rng: random.Random, text: str) -> str:
    """A number of the text times a factor, mostly a moderate one."""
    found = list(re.finditer(r"\d+\.?\d*(?:e-?\d+)?", text))
    if not found:
        return text
    m = rng.choice(found)
    factor = math.exp(rng.choice([0.05, 0.5, 3, 15]) * rng.gauss(0, 1))
    return f"{text[: m.start()]}{float(m[0]) * factor:.6g}{text[m.end() :]}"


def any_text(rng: random.Random, text: str) -> str:
    """One character more, less or other, a piece doubled or lost, or the end cut off."""
    at = rng.randrange(len(text) + 1)
    to = min(len(text), at + rng.choice([1, 1, 1, 5, 40]))
    character = rng.choice(CHARACTERS)
    return rng.choice([
        text[:at] + character + text[at:], text[:at] + text[to:], text[:at] + character + text[at + 1 :],
        text[:to] + text[at:], text[:at],
    ])  # fmt: skip


def _line(rng: random.Random, text: str) -> str:
    """A line of TOML with another value or key, lost, doubled, or moved."""
    lines = text.split("\n")
    with_value = [i for i, line in enumerate(lines) if " = " in line and not line.startswith("#")]
    at = rng.choice(with_value or [0])
    key, _, value = lines[at].partition(" = ")
    edit = rng.choice(["value", "value", "scale", "scale", "scale", "lose", "double", "move", "key"])
    if edit == "value":
        lines[at] = f"{key} = {rng.choice([*VALUES, number(rng)])}"
    elif edit == "scale":
        lines[at] = f"{key} = {scaled(rng, value)}"
    elif edit == "lose":
        del lines[at]
    elif edit == "double":
        lines.insert(at, lines[at])
    elif edit == "move":
        lines.insert(rng.randrange(len(lines)), lines.pop(at))
    else:
        lines[at] = f"{any_text(rng, key)} = {value}"
    return "\n".join(lines)


def _json(rng: random.Random) -> list[str]:
    return rng.choice([["--json"], ["--json"], []])


def case_file(rng: random.Random, texts: dict[str, str]) -> Input:
    """A case file changed at one to three places."""
    command, name = rng.choice(COMMANDS)
    text = texts[name]
    for _ in range(rng.choice([1, 1, 2, 3])):
        text = rng.choice([_line, _line, _line, any_text])(rng, text)
    shorter = SHORT.get(name, []) if command == "simulate" else []
    return {"argv": [command, "mine.toml", *shorter, *_json(rng)], "files": {"mine.toml": text}}


def override(rng: random.Random, texts: dict[str, str]) -> Input:
    """Values of a built-in case overridden with --set."""
    command, name = rng.choice(COMMANDS)
    lines = [line.partition("#")[0] for line in texts[name].split("\n") if " = " in line and line[0] not in "#"]
    argv = [command, name, *(SHORT.get(name, []) if command == "simulate" else [])]
    for _ in range(rng.choice([1, 1, 2])):
        key, _, value = rng.choice(lines).partition(" = ")
        text = rng.choice([scaled(rng, value), scaled(rng, value), number(rng), rng.choice(VALUES)])
        argv += ["--set", f"{key.strip()}={text.strip().strip(chr(34))}".replace("\0", "")]
    return {"argv": [*argv, *_json(rng)], "files": {}}


def span(rng: random.Random, texts: dict[str, str]) -> Input:
    """Lists and ranges of options."""
    ends = sorted(rng.uniform(100, 9000) for _ in range(2))
    text = rng.choice(
        ["{0:.4g},{1:.4g}", "{0:.4g}..{1:.4g}:5", "{0:.4g}:{1:.4g}:900", "{0:.4g}..{1:.4g}", "{0:.4g}+-3"]
    )
    text = text.format(*ends)
    for _ in range(rng.choice([0, 1, 1, 2])):
        text = rng.choice([scaled, any_text])(rng, text)
    text = text.replace("\0", "")
    option = rng.choice([
        ["cycle", "nunes-slider-crank", "--speeds", text], ["forces", "zotov-89", "--speeds", text],
        ["sweep", "nunes-slider-crank", "--over", f"speed_rpm={text}"], ["hinge", "zotov-89", "--loads", text],
        ["sweep", "nunes-slider-crank", "--samples", "3", "--over", f"bore={text} mm"],
        ["simulate", "chmielewski", *SHORT["chmielewski"], "--dampings", text],
    ])  # fmt: skip
    return {"argv": [*option, *_json(rng)], "files": {}}


def _diagram(rng: random.Random) -> list[str]:
    """A record of a four-stroke engine: gas exchange, compression, a flame, expansion; noise and drift."""
    cycles, step, shift = rng.choice([1, 3, 6]), rng.choice([1, 2, 5]), rng.uniform(0, 360)
    rows = ["crank_angle_deg,time_s,pressure_bar"]
    for k in range(0, 720 * cycles, step):
        turned = math.radians((k - shift) % 720 - 360)
        volume = 1 / 7.5 + 0.5 * (1 - math.cos(turned)) + 0.08 * math.sin(turned) ** 2
        closed = abs(turned) < math.pi
        burnt = 1 / (1 + math.exp(-8 * (turned - 0.25)))
        pressure = (0.25 * volume**-1.3 * (1 + 2.0 * burnt)) if closed else 1.0
        rows.append(f"{k},{k / 18000:.7f},{pressure + rng.gauss(0, 0.02):.4f}")
    return rows


def diagram(rng: random.Random, texts: dict[str, str]) -> Input:
    """A measured diagram with lines or columns lost, doubled, moved, scaled, or of other text."""
    rows = _diagram(rng)
    for _ in range(rng.choice([0, 1, 1, 2])):
        at, many = rng.randrange(len(rows)), rng.choice([1, 10, 200])
        edit = rng.choice(["lose", "double", "swap", "number", "text", "gain", "column", "constant"])
        if edit == "lose":
            del rows[at : at + many]
        elif edit == "double":
            rows[at:at] = rows[at : at + many]
        elif edit == "swap":
            other = rng.randrange(len(rows))
            rows[at], rows[other] = rows[other], rows[at]
        elif edit in ("number", "text"):
            rows[at] = scaled(rng, rows[at]) if edit == "number" else any_text(rng, rows[at])
        elif edit == "column":
            rows = [",".join(row.split(",")[:: rng.choice([-1, 2])]) for row in rows]
        else:
            factor = 0.0 if edit == "constant" else rng.choice([-1, 1e-5, 0.1, 10, 1e5])
            rows[1:] = [",".join([*r.split(",")[:-1], _times(r.split(",")[-1], factor)]) for r in rows[1:]]
        rows = rows or [""]
    command = rng.choice(["cycle", "cycle", "cycle", "forces", "hinge"])
    argv = [command, "generator", "--diagram", "d.csv", *_json(rng)]
    return {"argv": argv, "files": {"d.csv": "\n".join(rows) + "\n"}}


def _times(text: str, factor: float) -> str:
    try:
        return f"{float(text) * factor + (factor == 0):.6g}"
    except ValueError:
        return text


def formula(rng: random.Random, texts: dict[str, str]) -> Input:
    """A formula of random operations, sometimes with a slip of the pen."""
    text = _expression(rng, rng.choice([1, 2, 3, 5]))
    if rng.random() < 0.3:
        text = any_text(rng, text).replace("\0", "")
    against = ["--against", rng.choice(QUANTITIES)]
    return {"argv": ["audit", f"--formula={text}", *against, *_json(rng)], "files": {}}


@functools.cache
def _literature() -> list[tuple[str, str]]:
    """Formulas of texts, right and spoiled, each with what it claims to be."""
    forms = tomllib.loads((BENCHMARKS / "auditor" / "literature.toml").read_text(encoding="utf-8"))["form"]
    return [(text, one["against"]) for one in forms for text in (one["right"], *(s[1] for s in one["spoiled"]))]


def printed(rng: random.Random, texts: dict[str, str]) -> Input:
    """A formula of a text, changed at one to six places, mostly against what it claims to be."""
    text, against = rng.choice(_literature())
    for _ in range(rng.choice([1, 1, 2, 3, 6])):
        text = any_text(rng, text).replace("\0", "")
    if rng.random() < 0.1:
        against = rng.choice(_literature())[1]
    assumed = ["--assume", rng.choice(ASSUMED)] if rng.random() < 0.2 else []
    claimed = ["--claim", rng.choice(CLAIMS)] if rng.random() < 0.2 else []
    argv = ["audit", f"--formula={text}", "--against", against, *assumed, *claimed, *_json(rng)]
    return {"argv": argv, "files": {}}


def _expression(rng: random.Random, depth: int) -> str:
    if depth == 0:
        return rng.choice([rng.choice(LETTERS), rng.choice(LETTERS), number(rng), "0", "2"])
    left, right = _expression(rng, depth - 1), _expression(rng, rng.randrange(depth))
    return rng.choice([
        f"{left} + {right}", f"{left} - {right}", f"{left}*{right}", f"({left})/({right})", f"({left})**{right}",
        f"{rng.choice(FUNCTIONS)}({left})", f"({left})**2", f"-({left})", f"{left} {right}", f"{left} = {right}",
    ])  # fmt: skip


MUTATORS: tuple[Callable[[random.Random, dict[str, str]], Input], ...] = (
    case_file, case_file, override, override, span, diagram, formula,
)  # fmt: skip


def make(seed: int, index: int, texts: dict[str, str], only: str = "") -> Input:
    """Input number `index` of a seed, the same at every run; `only`: `printed`, in place of all others."""
    rng = random.Random(f"{seed} {index}")
    return (printed if only == "printed" else rng.choice(MUTATORS))(rng, texts)
