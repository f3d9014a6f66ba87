"""The commands whose faults are tried in turn, each in a folder of its own, and what they leave there."""

import contextlib
import json
import re
import shutil
import sqlite3
from pathlib import Path

from mechsym import files

ROOT = Path(__file__).parents[1]
#: words of a command, with {} for the value that an earlier run has otherwise: its two values
COMMANDS = {
    "audit": ("audit --formula {} --against hypocycloid.x --out run", ("2*e*(1-cos(theta))", "2*e*(1-sin(theta))")),
    "balance": ("balance opposed-pistons --set operation.speed={} --out run", ("2000rpm", "2100rpm")),
    "compare": ("compare nunes-slider-crank nunes-hypocycloid --speeds {} --out run", ("2000,4000", "2000,5000")),
    "cycle": ("cycle zotov-89 --set operation.speed={} --out run", ("80rpm", "89rpm")),
    "derive": ("derive ./v_twin.py --out run", ("", "")),
    "export-others": ("export zotov-89 --set parameters.r1={} --to modelica,matlab --out run", ("0.3", "0.31")),
    "export": ("export zotov-89 --set parameters.r1={} --to c,julia --out run", ("0.3", "0.31")),
    "flywheel": ("flywheel zotov-89 --ripple {} --out run", ("3%", "2%")),
    "fmu": ("fmu chmielewski --set parameters.k1={} --platforms none --out run.fmu", ("8000", "9000")),
    "forces": ("forces zotov-89 --set operation.speed={} --out run", ("80rpm", "89rpm")),
    "guide": ("guide zotov-89 --set spring.p0={} --sheet run.svg", ("8MPa", "8.1MPa")),
    "hinge": ("hinge zotov-89 --set spring.p0={} --set trials.turns=4 --out run", ("8MPa", "8.1MPa")),
    "new": ("new engine {} --kind inline --bore 86mm --stroke 86mm --out run", ("mine", "yours")),
    "new-mechanism": ("new mechanism {} --out run", ("press", "lever")),
    "page": ("page chmielewski --set parameters.k1={} --out run.html", ("8000", "9000")),
    "report": ("report chmielewski --set parameters.k1={} --out run.html", ("8000", "9000")),
    "reproduce": ("reproduce prymak --out run", ("", "")),
    "simulate": ("simulate zotov-89 --set simulation.turns={} --out run", ("1", "2")),
    "size": ("size nunes-slider-crank --set operation.speed={} --out run", ("2000rpm", "2100rpm")),
    "study": ("study {}.toml --jobs 1 --out run", ("first", "second")),
    "sweep": ("sweep zotov-89 --of cycle --over spring.p0={} --jobs 1 --out run", ("8,8.1MPa", "8.2,8.3MPa")),
    "optimise": ("optimise nunes-hypocycloid --set operation.speed={} --out run", ("3000rpm", "3100rpm")),
    "identify": ("identify chmielewski --trace trace.csv --free {} --out run", ("I2", "k1")),
    "codesign": ("codesign zotov-89 --ripple {} --speeds 89 --losses none --out run", ("5%", "6%")),
}
#: the same with nothing in the cache, where what is compiled and derived is kept
COLD = {
    "eval": ("eval ./v_twin.py --case v-twin.toml", ("", "")),
    "flywheel-cold": COMMANDS["flywheel"],
    "simulate-cold": ("simulate chmielewski --set t_end={} --set simulation.window=1 --out run", ("2", "3")),
}
STUDY = """title = "Two"
case = "zotov-89"
of = "cycle"
[[sweep]]
name = "pressure"
over = ["spring.p0=VALUE"]
[[sweep]]
name = "speed"
over = ["operation.speed=80,89rpm"]
"""


class Place:
    """A folder with what a command reads and leaves, its cache and its temporary files."""

    def __init__(self, folder, cold):
        self.folder, self.cold = folder, cold
        folder.mkdir()
        for name in ("v_twin.py", "v-twin.toml"):
            shutil.copy(ROOT / "examples/mechanisms" / name, folder)
        (folder / "tmp").mkdir()
        for name, value in (("first", "8,8.1MPa"), ("second", "8.2,8.3MPa")):
            (folder / f"{name}.toml").write_text(STUDY.replace("VALUE", value))

    def keep(self, name):
        """Keep the folder as it is under a name."""
        kept = self.folder.with_name(f"{self.folder.name}-{name}")
        shutil.rmtree(kept, ignore_errors=True)
        shutil.copytree(self.folder, kept)

    def back(self, name):
        """The folder as it was kept."""
        for path in self.folder.iterdir():
            shutil.rmtree(path) if path.is_dir() else path.unlink()
        shutil.copytree(self.folder.with_name(f"{self.folder.name}-{name}"), self.folder, dirs_exist_ok=True)

    def results(self):
        """Files that a command has left, by name; of a store of points nothing, see `points`."""
        return {p.relative_to(self.folder).as_posix(): lasting(p) for p in sorted(self.folder.rglob("*"))
                if p.is_file() and p.relative_to(self.folder).parts[0].startswith(("run", "trace"))
                and not p.name.startswith(".") and ".db" not in p.name}  # fmt: skip

    def points(self):
        """Finished points of all stores."""
        rows = set()
        for store in self.folder.glob("run/**/*.db"):
            with (
                contextlib.closing(sqlite3.connect(store)) as connection,
                contextlib.suppress(sqlite3.OperationalError),
            ):
                rows |= set(connection.execute("select first, told, numbers from chunk").fetchall())
        return rows

    def hidden(self):
        return [p.name for p in self.folder.rglob(".*") if p.is_file()] + [
            p.name for p in self.folder.rglob(".*") if p.is_dir()
        ]

    def unsound(self):
        """Files of the cache whose name tells of another content; what is still being built is hidden."""
        cache = self.folder / "cache"
        every = [p for p in cache.rglob("*") if p.suffix in (".so", ".json")]
        kept = [p for p in every if not any(part.startswith(".") for part in p.relative_to(cache).parts)]
        return [p.name for p in kept if not files.digest(p.read_bytes()).startswith(p.stem.rpartition("-")[2])]


def lasting(path):
    """What is in a file; of a summary the numbers that do not differ from run to run."""
    if path.name != "summary.json":
        return path.read_bytes()
    from matrix.record import rounded

    numbers = json.loads(path.read_bytes())
    for name in ("kept", "set_aside"):  # what a sweep finds there depends on how far a run before has come
        numbers.pop(name, None)
    return json.dumps(rounded(numbers), sort_keys=True).encode()


_NUMBER = re.compile(rb"-?\d+\.?\d*(?:e[-+]?\d+)?")


def alike(one, other, certified=False):
    """Whether two sets of files tell the same, their numbers but for round-off: another way computed them.

    certified: a summary tells of each file; then tables are enough, as another integrator steps and draws otherwise.
    """
    if one.keys() != other.keys():
        return False
    for name, text in one.items():
        if certified and not name.endswith(".csv"):
            continue
        a, b = (_NUMBER.sub(b"#", _HASH.sub(b"", t)) for t in (text, other[name]))
        x, y = (list(map(float, _NUMBER.findall(_HASH.sub(b"", t)))) for t in (text, other[name]))
        if a != b or any(abs(u - v) > 1e-6 * max(abs(u), abs(v), 1e-3) for u, v in zip(x, y, strict=True)):
            return False
    return True


_HASH = re.compile(rb"[0-9a-f]{16,}")


def mixed(folder):
    """Files of which a summary tells otherwise."""
    wrong = []
    for summary in Path(folder).glob("run/**/summary.json"):
        listed = json.loads(summary.read_bytes()).get("run", {}).get("files", {})
        wrong += [n for n, said in listed.items() if not (summary.parent / n).is_file()
                  or files.digest((summary.parent / n).read_bytes()) != said]  # fmt: skip
    return wrong
