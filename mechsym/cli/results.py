"""What the commands tell: each number of their JSON with unit and meaning, from the fields of the results."""

import functools
import re

from mechsym.errors import BadInput, suggest
from mechsym.files import Json
from mechsym.quantities import load
from mechsym.quantities.results import declared, leaves

#: Command: the results that it may give, each "module:class"
RESULTS = {
    "audit": ("mechsym.audit.row:Compared", "mechsym.audit.hosts.paper:EquationPlace"),
    "balance": ("mechsym.jobs.forces:BalanceOfEngine",),
    "compare": ("mechsym.cycle.compare:EngineComparison",),
    "cycle": ("mechsym.cycle.columns:CycleColumns", "mechsym.jobs.measured:MeasuredDiagram",
              "mechsym.jobs.indicated:TorquePressure", "mechsym.simulate.loop.run:LoopNumbers"),
    "eval": ("mechsym.mechanisms.state:MechanismState",),
    "identify": ("mechsym.optimise.identify:Identified",),
    "optimise": ("mechsym.optimise.solver:Optimised",),
    "study": ("mechsym.sweep.data:StudyNumbers",),
    "sweep": ("mechsym.sweep.data:SweepNumbers",),
    "simulate": ("mechsym.torsion.startup:FinishedRun",),
    "hinge": ("mechsym.hinge.summary:HingeNumbers",),
    "codesign": ("mechsym.codesign.result:CoDesignNumbers", "mechsym.jobs.codesign:Beside"),
    "flywheel": ("mechsym.jobs.flywheel:FlywheelDesign",),
    "forces": ("mechsym.jobs.forces:ForceReport", "mechsym.forces.driven:DrivenNumbers"),
    "fmu": ("mechsym.out.fmi.build:UnitFile",),
    "guide": ("mechsym.out.cad.curve:GrooveDrawings",),
    "page": ("mechsym.out.web.build:WrittenPage",),
    "prove": ("mechsym.proof.outputs:ProvenRounding", "mechsym.jobs.prove:ProvenMotion"),
    "report": ("mechsym.report.numbers:ReportNumbers",),
    "reproduce": ("mechsym.papers.rows:ReproducedNumber",),
    "size": ("mechsym.sizing.rows:SizeRow",),
}  # fmt: skip
#: Sections whose values may stand among the numbers of a command, each under its dotted key
KEYS = {"cycle": ("parameters", "chamber", "cycle", "gas", "heat_transfer", "friction_pressure")}


def units_by_path(value: object, command: str) -> dict[str, str]:
    """Unit of each number that a command tells by its path, `speeds.phi.mean`; of plain values as they are declared."""
    units = {row["path"]: row["unit"] for row in rows(command)} if command in RESULTS else {}
    told = {}
    for leaf in leaves(value):
        bare = re.sub(r"\[\d+\]", "", leaf.path)
        listed = next((unit for name, unit in units.items() if _pattern(name).fullmatch(bare)), "")
        if listed.startswith("of its "):  # a column inside a group has the unit of its name
            listed = units.get(bare.rpartition(".")[2], "")
        if unit := leaf.unit or listed:
            told[leaf.path] = unit
    return told


@functools.cache
def _pattern(name: str) -> re.Pattern[str]:
    return re.compile(re.escape(name.replace("[]", "")).replace(r"\*", "[^.]+"))


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
    over = "The value that --over runs over; 'mechsym sections' tells it"
    return [*listed.values()] + [
        {"command": name, "path": f"{section}.*", "unit": "of its key", "about": over}
        for name in wanted
        for section in KEYS.get(name, ())
    ]
