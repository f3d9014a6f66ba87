"""What the commands tell: each number of their JSON with unit and meaning, from the fields of the results."""

import functools
import re

from mechsym.errors import BadInput, suggest
from mechsym.files import Json
from mechsym.quantities import load
from mechsym.quantities.results import declared, leaves, walk
from mechsym.quantities.schema import schema as of_class

_OVER = "The value that --over runs over; 'mechsym sections' tells it"
#: What every object carries
_BESIDE = {"doubts": "mechsym.plausible:Doubt", "accepted": "mechsym.plausible:Doubt",
           "headline": "mechsym.page.finding:Finding"}  # fmt: skip
#: Command: the results that it may give, each "module:class"
RESULTS = {
    "audit": (
        "mechsym.audit.row:Compared",
        "mechsym.audit.hosts.paper:EquationPlace",
        "mechsym.audit.hosts.whole:Coverage",
    ),
    "balance": ("mechsym.jobs.forces:BalanceOfEngine",),
    "compare": ("mechsym.cycle.columns:EngineComparison",),
    "cycle": (
        "mechsym.cycle.columns:CycleColumns",
        "mechsym.jobs.measured:MeasuredDiagram",
        "mechsym.jobs.indicated:TorquePressure",
        "mechsym.simulate.loop.run:LoopNumbers",
    ),
    "eval": ("mechsym.mechanisms.state:MechanismState",),
    "identify": ("mechsym.optimise.identify:Identified",),
    "optimise": ("mechsym.optimise.solver:Optimised",),
    "study": ("mechsym.sweep.data:StudyNumbers",),
    "sweep": ("mechsym.sweep.data:SweepNumbers",),
    "simulate": ("mechsym.torsion.startup:FinishedRun", "mechsym.simulate.rest:RestPoses"),
    "hinge": ("mechsym.hinge.summary:HingeNumbers",),
    "codesign": ("mechsym.jobs.codesign:CoDesignAnswer",),
    "flywheel": ("mechsym.jobs.flywheel:FlywheelDesign",),
    "forces": ("mechsym.jobs.forces:ForceReport", "mechsym.forces.driven:DrivenNumbers"),
    "fmu": ("mechsym.out.fmi.build:UnitFile",),
    "guide": ("mechsym.out.cad.curve:GrooveDrawings",),
    "page": ("mechsym.out.web.build:WrittenPage",),
    "prove": ("mechsym.proof.outputs:ProvenRounding", "mechsym.jobs.prove:ProvenMotion"),
    "report": ("mechsym.report.numbers:ReportNumbers",),
    "reproduce": ("mechsym.papers.rows:ReproducedNumber",),
    "size": ("mechsym.sizing.rows:SizeRow",),
}
#: Of these a case tells the names that it has
_SOME = ("mechsym.cycle.columns:CycleColumns", "mechsym.jobs.forces:ForceReport")
#: Commands whose JSON is a list of rows, or of one formula the row
ROWS = ("audit", "reproduce", "size")
#: What other commands tell at least, words and lists; `[]` of those that tell a list of rows
WORDS = {
    "app": "", "cases": "[] name mechanism source about", "check": "problems commands", "cite": "[] key what bibtex",
    "derive": "", "export": "written checks", "mechanisms": "[] name coordinates parameters inputs outputs source",
    "native": "", "new": "written", "sections": "[]",
}  # fmt: skip
#: Sections whose values may stand among the numbers of a command, each under its dotted key
KEYS = {"cycle": ("parameters", "chamber", "cycle", "gas", "heat_transfer", "friction_pressure")}


def units_by_path(value: object, command: str) -> dict[str, str]:
    """Unit of each number that a command tells by its path, `speeds.phi.mean`; of plain values as they are declared."""
    units = {row["path"]: row["unit"] for row in rows(command)} if command in RESULTS else {}
    words = {leaf.path: leaf.value for leaf in walk(value) if isinstance(leaf.value, str)}
    by_path = {}
    for leaf in leaves(value):
        bare = re.sub(r"\[\d+\]", "", leaf.path).lstrip(".")
        front, _, name = leaf.path.rpartition(".")
        unit = leaf.unit or next((unit for name, unit in units.items() if _pattern(name).fullmatch(bare)), "")
        if unit.startswith("of its column"):  # a column inside a group has the unit of its name
            unit = units.get(name, "")
        elif unit.startswith("in "):  # it stands beside the number
            unit = str(words.get(f"{front}.{unit[3:]}") or "-")
        if unit:
            by_path[leaf.path] = unit
    return by_path


@functools.cache
def _pattern(name: str) -> re.Pattern[str]:
    return re.compile(re.escape(name.replace("[]", "")).replace(r"\*", "[^.]+"))


def schema(command: str) -> Json:
    """JSON Schema, draft 7, of the `--json` of a command. Raises BadInput: there is no such command."""
    if command not in RESULTS and command not in WORDS:
        raise BadInput(f"command {command!r} is not known; {suggest(command, [*RESULTS, *WORDS])}")
    if command in RESULTS:
        kinds = [of_class(load(kind)) | ({"required": []} if kind in _SOME else {}) for kind in RESULTS[command]]
        over = {"patternProperties": {r"^\w+\.\w+$": {"description": _OVER}}} if command in KEYS else {}
        kinds = [kind | over for kind in kinds]
        one: Json = kinds[0] if len(kinds) == 1 else {"anyOf": kinds}
    else:
        names = [name for name in WORDS[command].split() if name != "[]"]
        one = {"type": "object", "properties": {name: {} for name in names}, "required": names}
    classes = {name: {"type": "array", "items": of_class(load(kind))} for name, kind in _BESIDE.items()}
    listed = {"type": "array", "items": one}
    if command in ROWS:
        value: Json = {"anyOf": [one, listed]}
    elif WORDS.get(command, "").startswith("[]"):
        value = listed
    else:
        value = {**one, "properties": classes | dict(one.get("properties", {}))}
    return {"$schema": "http://json-schema.org/draft-07/schema#", "title": f"mechsym {command} --json", **value}


def rows(command: str | None = None) -> list[Json]:
    """Rows of `sections --results`: `command`, `path`, `unit`, `about`. Raises BadInput: such a command tells none."""
    if command is not None and command not in RESULTS:
        raise BadInput(f"command {command!r} has no list of results; {suggest(command, list(RESULTS))}")
    wanted = RESULTS if command is None else {command: RESULTS[command]}
    listed = {}
    for name, kinds in wanted.items():
        for number in (one for kind in kinds for one in declared(load(kind))):
            row = {"command": name, "path": number.path, "unit": number.unit, "about": number.about}
            listed[name, number.path] = row
    return [*listed.values()] + [
        {"command": name, "path": f"{section}.*", "unit": "of its key", "about": _OVER}
        for name in wanted
        for section in KEYS.get(name, ())
    ]
