"""Cases x commands: every command on every built-in case, example and kind of new engine, refusals too."""

import math
import shutil
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from fnmatch import fnmatch
from pathlib import Path

ROOT = Path(__file__).parents[2]
EXAMPLES = ROOT / "examples/mechanisms"
BUILT_IN = (
    "alpha-stirling", "balandin", "chmielewski", "generator", "generator-breathing", "moroianu", "nunes-hypocycloid",
    "nunes-slider-crank", "opposed-pistons", "zotov-142", "zotov-89",
)  # fmt: skip
OWN = tuple(sorted(path.stem for path in EXAMPLES.glob("*.toml")))
NEW = {  # kind, bore and stroke [m], cylinders
    "new-crosshead": ("two-stroke-crosshead", 0.5, 2.0, 1), "new-inline-4": ("inline", 0.086, 0.086, 4),
    "new-v-2": ("v", 0.1, 0.097, 2), "new-opposed": ("opposed", 0.06, 0.07, 1),
    "new-hypocycloid": ("hypocycloid", 0.06, 0.052, 1),
}  # fmt: skip
CASES = (*BUILT_IN, *OWN, *NEW)

# what each command is asked of every case; CASE is its name or file, RUN a folder for files, MECHANISM what it moves
EVERY = {
    "check": "check CASE --trust",
    "cycle": "cycle CASE --out RUN",
    "forces": "forces CASE --out RUN",
    "balance": "balance CASE --weights webs --shafts 1,2 --out RUN",
    "hinge": "hinge CASE --set trials.turns=4 --out RUN",
    "simulate": "simulate CASE --out RUN",
    "flywheel": "flywheel CASE --ripple 2% --out RUN",
    "codesign": "codesign CASE --ripple 5% --out RUN",
    "guide": "guide CASE --sheet RUN/sheet.svg",
    "eval": "eval MECHANISM --case CASE",
    "export": "export CASE --to c,modelica,julia,matlab,jax --out RUN",
    "fmu": "fmu CASE --platforms none --out RUN/machine.fmu",
    "page": "page CASE --out RUN/page.html",
    "report": "report CASE --out RUN/report.html",
    "size": "size CASE --out RUN",
    "sweep": "sweep CASE --over SWEPT --jobs 1 --out RUN",
    "optimise": "optimise CASE --out RUN",
    "compare": "compare CASE nunes-slider-crank --out RUN",
    "identify": "identify CASE --trace trace.csv --free friction.viscous --out RUN",
}
# and of one of them
ONE = {
    "chmielewski": {
        "simulate-short": "simulate CASE --set t_end=2 --set simulation.window=1 --dampings 1,5 --out RUN",
        "simulate-rk45": "simulate CASE --set t_end=2 --set simulation.window=1 --backend scipy-rk45 --no-check",
        "sweep-simulate": "sweep CASE --over c1=1,5 --set t_end=2 --set simulation.window=1 --jobs 1",
    },
    "generator": {"cycle-diagram": "cycle CASE --diagram generator-synthetic.csv --out RUN"},
    "generator-breathing": {"cycle-speeds": "cycle CASE --speeds 2000,3000 --out RUN"},
    "moroianu": {"forces-comparison": "forces CASE --comparison --out RUN"},
    "nunes-hypocycloid": {
        "cycle-loop": "cycle CASE --loop 2 --out RUN", "cycle-speeds": "cycle CASE --speeds 2000:8000:2000 --out RUN",
        "cycle-printed": "cycle CASE --set cycle.method=nunes2017_printed --speeds 2000,8000",
        "forces-law": "forces CASE --law 2000:8000:2000", "size-printed": "size CASE --as-printed --out RUN",
        "sweep-size": "sweep CASE --of size --over bore=55,60mm --jobs 1",
    },
    "nunes-slider-crank": {
        "compare-two": "compare CASE nunes-hypocycloid --speeds 2000,8000 --out RUN",
        "cycle-over": "cycle CASE --over cycle.ignition=-30deg:0deg:10deg --speeds 4000",
    },
    "alpha-stirling": {"cycle-adiabatic": "cycle CASE --set cycle.kind=stirling-adiabatic"},
    "zotov-89": {
        "hinge-loads": "hinge CASE --set trials.turns=4 --loads 0.5,1 --units mm,bar,kN,deg --out RUN",
        "sweep-codesign": "sweep CASE --of codesign --over codesign.ripple=0.05,0.08 "
                          "--show bound --jobs 1",
        "sweep-guides": "sweep CASE --of guides --over spring.p0=3..8MPa:4 --out RUN",
        "codesign-speeds": "codesign CASE --speeds 75,89,105 --ripple 5% --out RUN", "cases": "cases CASE",
    },
    "v-twin": {"eval-latex": "eval MECHANISM --latex", "derive": "derive MECHANISM --show"},
}  # fmt: skip
PLAIN = {
    "cases": "cases", "mechanisms": "mechanisms", "sections": "sections", "schema": "sections --schema",
    "derive-latex": "derive crosshead --latex", "study": "study nunes2017-chapter-6 --only compression --out RUN",
    "new-mechanism": "new mechanism press --out RUN", "audit-zotov": "audit --source zotov2024",
    "audit-formula": "audit --formula 2*e*(1-cos(theta)) --against hypocycloid.x",
    "reproduce-prymak": "reproduce prymak --out RUN", "reproduce-zotov": "reproduce zotov2024",
    "reproduce-nunes": "reproduce nunes2017", "reproduce-chmielewski": "reproduce chmielewski2015",
    "reproduce-moroianu": "reproduce moroianu2017", "export-mechanism": "export crosshead --to c,julia --out RUN",
    "eval-state": "eval crosshead --case zotov-89 --set phi=1.0 --set phid=9.32 --set F=1e5",
    "prove": "prove crankshaft_flywheel_printed --samples 50", "prove-fast": "prove crosshead --mode fast",
    "no-case": "hinge zotov-98", "no-key": "hinge zotov-89 --set spring.p1=3", "no-unit": "hinge zotov-89 --set m3=3mm",
} | {
    f"new-{kind}-{count}": f"new engine --kind {kind} --bore {bore} --stroke {stroke} --cylinders {count} --out RUN"
    for kind, bore, stroke, count in (
        ("two-stroke-crosshead", "0.5", "2", "6"), ("inline", "86mm", "86mm", "6"), ("v", "100mm", "97mm", "8"),
        ("opposed", "60mm", "70mm", "2"), ("hypocycloid", "60mm", "52mm", "1"),
    )
}  # fmt: skip
HEAVY = ("codesign", "codesign-speeds", "optimise", "fmu", "page", "report", "study", "identify", "sweep-codesign",
         "reproduce-chmielewski")  # fmt: skip


@dataclass(frozen=True)
class Entry:
    """One command on one case, or on none."""

    case: str  # empty: none
    command: str
    line: str

    @property
    def name(self) -> str:
        return f"{self.case or 'none'}/{self.command}"

    @property
    def heavy(self) -> bool:
        return self.command in HEAVY

    def matches(self, patterns: tuple[str, ...]) -> bool:
        """Whether it is asked for: `hinge`, `zotov-89`, `zotov-*/cycle*`; nothing asks for all."""
        return not patterns or any(
            fnmatch(what, pattern) for pattern in patterns for what in (self.case, self.command, self.name)
        )


def entries() -> Iterator[Entry]:
    """All of them, those of one case side by side."""
    for case in CASES:
        for command, line in (EVERY | ONE.get(case, {})).items():
            yield Entry(case=case, command=command, line=line)
    yield from (Entry(case="", command=command, line=line) for command, line in PLAIN.items())


def prepare(folder: Path) -> None:
    """What the commands read: the examples, a new engine of each kind, a trace, a diagram."""
    from mechsym.cases.new_engine import write_engine

    shutil.copytree(EXAMPLES, folder, dirs_exist_ok=True, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "mechsym/cases/generator-synthetic.csv", folder)
    for name, (kind, bore, stroke, count) in NEW.items():
        write_engine(kind, bore, stroke, count, folder, name)
    times = [0.01 * k for k in range(51)]
    rows = [f"{t:.2f},{600 + 20 * math.sin(20 * t) - 40 * t:.6f}" for t in times]
    (folder / "trace.csv").write_text("\n".join(["t [s],speed [rpm]", *rows, ""]))


def words(entry: Entry, folder: Path) -> list[str]:
    """The command as typed in a folder that is prepared."""
    if not entry.case:
        return entry.line.replace("RUN", "run").split(" ")
    file = f"{entry.case}.toml"
    there = (folder / file).exists()
    data = tomllib.loads((folder if there else ROOT / "mechsym/cases").joinpath(file).read_text(encoding="utf-8"))
    known = {
        "CASE": file if there else entry.case, "RUN": "run", "MECHANISM": data["mechanism"], "SWEPT": _swept(data),
    }  # fmt: skip
    return [_filled(word, known) for word in entry.line.split(" ")]


def _filled(word: str, known: dict[str, str]) -> str:
    for letters, text in known.items():
        word = word.replace(letters, text)
    return word


def _swept(data: dict) -> str:
    """A key of the case and two values: its speed, else the first letter of its mechanism."""
    key, text = "operation.speed", data.get("operation", {}).get("speed")
    if text is None:
        key, text = next(iter(data["parameters"].items()))
    value, _, unit = str(text).partition(" ")
    return f"{key}={0.98 * float(value):.6g},{value} {unit}".strip()
