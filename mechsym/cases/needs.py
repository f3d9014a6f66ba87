"""What each command asks of a case, and which of its sections it reads: a job begins with `require`, `check` lists it.

What is lacking is a section, `[spring]`, a key, `simulation.turns`, or a sentence where the mechanism or the gas itself
cannot. What is read is held to what a case records when a command runs on it (`Case.read`).
"""

import functools
import re
from collections.abc import Callable, Mapping
from typing import Any

from mechsym import mechanisms
from mechsym.cases import facts
from mechsym.cases.facts import CaseFacts, facts_of
from mechsym.cycle.kinds import KINDS
from mechsym.errors import MissingSection
from mechsym.mechanisms.plan import driving_inputs, plan_of, with_chain
from mechsym.quantities import load, record

_SECTION = re.compile(r"^\[\w+\]$")
NO_FILE = "the diagram has no file; name it with cycle.file, or --diagram FILE"
SPEEDS = "[speeds] or --speeds"
_ACTS = "[drive] or [cycle]: nothing turns the shaft"
_STILL = "simulation.t_end or speed_start, or [cycle] or [torque]"
_TURNS = ("cycle", "torque", "drive")  # what would act beside the drives of a motion, over a turn or in time
_SPARK = "[cycle] kind = 'spark-ignition'"


def require(case: Any, command: str, given: str = "") -> None:
    """Refuse a case that lacks what a command needs. given: by an option in its place. Raises MissingSection: all."""
    facts = facts_of(case.mechanism, case.sections)
    missing = COMMANDS[command].lacks(facts)
    if missing := [what for what in dict.fromkeys(missing) if what != given]:
        needed = [_SECTION.sub(r"section \g<0> is missing", what) for what in in_words(facts, missing)]
        needed = [
            f"{command} needs {what}" if what.startswith(("[", "simulation.", "drive.")) else what for what in needed
        ]
        raise MissingSection(f"{case.file}: {'; '.join(needed)}; see 'mechsym check' and 'mechsym cases'")


def in_words(case: CaseFacts, missing: list[str]) -> list[str]:
    """What a command lacks, for people: sections that describe one thing together stand behind its name."""
    for thing, names in {"hinge": facts.GUIDE, "sizes of its parts": facts.PARTS}.items():
        sections = [f"[{name}]" for name in names]
        if all(one in missing for one in sections):
            rest = [what for what in missing if what not in sections]
            missing = [f"this kind of {case.called} has no {thing} ({', '.join(sections)})", *rest]
    return missing


def lacking(case: CaseFacts) -> dict[str, list[str]]:
    """What each command still lacks to run on a case; empty where it can run."""
    return {name: list(dict.fromkeys(COMMANDS[name].lacks(case))) for name in sorted(COMMANDS)}


def read_by(case: CaseFacts) -> dict[str, set[str]]:
    """Sections of a case that each command reads which can run on it, or could with the input of its drive named."""
    can = (name for name in sorted(COMMANDS) if not COMMANDS[name].asks(case))
    return {name: COMMANDS[name].reads(case) & case.sections.keys() for name in can}


def commands_of(section: str) -> list[str]:
    """The commands that read a section of some case."""
    return ["all"] if section == "report" else sorted(name for name, all_of in _of_any().items() if section in all_of)


@functools.lru_cache(maxsize=1)
def _of_any() -> Mapping[str, set[str]]:
    """Sections that each command reads of any case: of every mechanism and gas, with and without what turns it."""
    fitted = load("mechsym.cycle.friction:MechanismFriction")()
    known = {name: mechanisms.roles_of(name) for name in mechanisms.names()} | {"own.py": None}
    every: dict[str, Any] = {**dict.fromkeys(("cycle", "spring", "guide")), "friction_pressure": fitted}
    cases = [
        CaseFacts(mechanism=name, sections=every | dict.fromkeys(more), kind=kind, roles=roles,
                  free=1 if roles is None else plan_of(name).free)
        for name, roles in known.items()
        for kind in (None, *KINDS.values())
        for more in ((), ("drive",), ("part_crosshead",), ("motion",))
    ]  # fmt: skip
    own_ways = COMMANDS.keys() - {"app", "report", "sweep"}  # those run the others
    return {name: set().union(*map(COMMANDS[name].reads, cases)) for name in own_ways}


def _missing(case: CaseFacts, *names: str) -> list[str]:
    return [f"[{name}]" for name in names if name not in case.sections]


def _gas(case: CaseFacts) -> list[str]:
    """What the gas of `[cycle]` still lacks; nothing without that section."""
    if not case.has("cycle"):
        return []
    if case.roles is not None:
        count = len(case.roles.pistons) + len(case.roles.faces)
        if not count:
            return [_no_piston(case)]
        if case.shared and count != 2 and case.sections.get("parameters") is not None:
            return [f"a Stirling cycle needs two pistons, hot one or displacer first; {count} declared"]
    if case.kind is not None and case.kind.measured and case.value("cycle", "file") == "":
        return [NO_FILE]
    return _missing(case, *(case.kind.needs if case.kind else ()))


def _no_piston(case: CaseFacts) -> str:
    said = f"mechanism {case.named} has no piston for an engine cycle"
    return f"{said}; declare one with m.piston(name, travel=x, force=F), or take {', '.join(with_chain())}"


def _events(case: CaseFacts) -> list[str]:
    own = [] if case.roles is None else [*(s.name for s in case.roles.stops), *(f.name for f in case.roles.frictions)]
    said = "a motion without events: {} makes them, which only simulate and sweep take"
    return [said.format(own[0])] if own else []


def _turning(case: CaseFacts, *names: str, way: str = "") -> list[str]:
    """What one turn at constant speed lacks. way: how several free coordinates may move, where the command says."""
    if case.has("cycle") and _gas(case) == [_no_piston(case)]:
        return [*_missing(case, "parameters", "operation", *names), _no_piston(case)]
    if events := _events(case):
        return events
    if case.free != 1:
        way = f"{way}this command takes a mechanism with one, as {', '.join(with_chain())}"
        return [f"the {case.free} coordinates of {case.named} are free; {way}"]
    closing = ("closing", *(("faces",) if case.has("cycle") else ())) if case.undetermined else ()
    return [*_missing(case, "parameters", "operation", *names, *closing), *_gas(case)]


def _forces(case: CaseFacts) -> list[str]:
    """What forces lack: over time where `[motion]` says how a mechanism moves, else over a turn."""
    if not case.has("motion"):
        return _turning(case, way="a section [motion] says how they move; without one ")
    acting = [f"a motion takes no [{name}]; leave [{name}] or [motion] out" for name in _TURNS if case.has(name)]
    return [*_missing(case, "parameters"), *acting]


def _cycle(case: CaseFacts) -> list[str]:
    if case.roles is not None and not (case.roles.pistons or case.roles.faces):
        return [*_missing(case, "parameters", "operation", "cycle"), _no_piston(case)]
    if case.kind is not None and not case.shared and case.undetermined:
        return [*_missing(case, "parameters", "operation", "cycle", "closing", "faces"), *_gas(case)]
    return _turning(case, "cycle")


def _drive(case: CaseFacts) -> list[str]:
    """What a `[drive]` lacks that does not name its input, where several torques could be meant."""
    if not case.has("drive") or case.roles is None or case.value("drive", "input"):
        return []
    if len(driving_inputs(case.mechanism)) == 1:
        return []
    return [f"drive.input, one of {', '.join(mechanisms.listing(case.mechanism)['inputs']) or 'none'}"]


def _hinge(case: CaseFacts) -> list[str]:
    """What a hinge on the shaft lacks."""
    return _turning(case, *facts.GUIDE)


def _size(case: CaseFacts) -> list[str]:
    if not case.rules or not case.closed:
        given = case.rules == "slider crank" and case.has("part_crosshead")
        return _turning(case, *(("cycle",) if given else ()))
    return _turning(case, "cycle", "speeds", *(() if case.rules == "slider crank" else facts.PARTS))


def _compare(case: CaseFacts) -> list[str]:
    if case.twists:
        figures = "'mechsym cycle' gives its figures over the speeds"
        return [f"an engine on a shaft that twists is no single cylinder; {figures}"]
    spark = [_SPARK] if case.kind is not None and not case.closed else []
    wanted = [] if case.has("speeds") else [SPEEDS]
    return [*spark, *_missing(case, "parameters", "cycle"), *wanted, *_gas(case)]


def _simulate(case: CaseFacts) -> list[str]:
    simulation = ["simulation"] if not case.has("simulation") and not case.has("operation") else []
    if case.in_loop:
        faces = ["faces"] if case.undetermined else []
        missing = [*_missing(case, "parameters", "operation", *simulation, *faces), *_gas(case)]
        if case.roles is not None and not case.roles.load:
            missing.append("nothing takes the load; declare m.rotor('crank', angle=phi, load=M_r)")
        return missing
    explained = _missing(case, "drive") if case.has("startup") else []
    return [*_missing(case, *simulation), *explained, *_run(case)]


def _run(case: CaseFacts) -> list[str]:
    """What a run in time lacks whose gas hangs on the angle alone."""
    if case.twists and not {"drive", "cycle", "inputs", "start"} & case.sections.keys():
        return [*_missing(case, "parameters"), *([] if case.value("simulation", "speed_start") else [_ACTS])]
    hinged = case.has("spring", "guide") and not case.twists and case.value("simulation", "hinge") != "none"
    if case.has("cycle") or case.has("torque") or hinged:
        return _turning(case)
    length = case.value("simulation", "t_end") or case.value("simulation", "speed_start")
    return [*_missing(case, "parameters"), *([] if length else [_STILL])]


def _export(case: CaseFacts) -> list[str]:
    return _events(case) or _run(case)


def meant(case: CaseFacts) -> str:
    """What a sweep computes where nothing is said; empty where nothing can be."""
    if case.has("motion"):
        return "forces"
    # a case that says how long to run means its elastic shaft, whatever turns it
    if case.has("drive") or (case.has("simulation") and case.twists):
        return "simulate"
    if case.has("spring", "guide"):
        return "hinge"
    if case.has("cycle"):
        return "cycle"
    # its weight or constants of [inputs] move it
    return "simulate" if case.has("simulation") else ""


def _identify(case: CaseFacts) -> list[str]:
    if case.roles is not None and mechanisms.lists(case.mechanism):
        return [
            f"{case.named} is put together from lists, and identify takes mechanisms with one value a letter; take "
            "chmielewski, or declare the shaft in a file of its own"
        ]
    if events := _events(case):
        return events
    if case.held and case.free != 1:
        why = f"loops that close by constraint and leave {case.free} coordinates"
        return [f"{case.named} has {why}; identify takes one, or loops that close in closed form"]
    return _missing(case, "parameters")


def _prove(case: CaseFacts) -> list[str]:
    if case.roles is not None and mechanisms.lists(case.mechanism):
        return [f"{case.named} is put together from lists, and prove takes mechanisms with one value a letter"]
    if case.held:
        return [f"{case.named} has loops that close by constraint; prove encloses those that close in closed form"]
    if acting := [f"[{name}]" for name in ("cycle", "torque", "spring") if case.has(name)]:
        return [f"{', '.join(acting)}: no smooth closed form that can be enclosed; leave it out"]
    if events := _events(case):
        return events
    if case.roles is not None and case.roles.cams:
        return [f"{case.roles.cams[0].name} is no smooth closed form; prove encloses what is smooth"]
    return _simulate(case)


def _reads_report(case: CaseFacts) -> set[str]:
    parts = (COMMANDS[name] for name in ("cycle", "hinge", "forces", "size", "simulate"))
    return {"report"}.union(*(part.reads(case) for part in parts if not part.lacks(case)))


@record
class Command:
    """A command that takes a case."""

    asks: Callable[[CaseFacts], list[str]]  #: What it lacks itself
    reads: Callable[[CaseFacts], set[str]]  #: Whatever the case has of these

    def lacks(self, case: CaseFacts) -> list[str]:
        """What a case still lacks for it."""
        return [*self.asks(case), *(_drive(case) if "drive" in self.reads(case) else ())]


COMMANDS: Mapping[str, Command] = {
    "app": Command(asks=lambda case: [], reads=_reads_report),
    "balance": Command(asks=_turning, reads=lambda case: facts.of_turn(case) | {"shaft"}),
    "codesign": Command(
        asks=lambda case: _hinge(case) + ([] if case.has("cycle") or case.has("torque") else ["[cycle] or [torque]"]),
        reads=lambda case: facts.guide(case) | {"codesign", "losses"},
    ),
    "compare": Command(asks=_compare, reads=lambda case: facts.of_turn(case) | facts.of_friction(case) | {"speeds"}),
    "cycle": Command(asks=_cycle, reads=facts.cycle),
    "eval": Command(asks=lambda case: _missing(case, "parameters"), reads=lambda case: {"parameters"}),
    "export": Command(asks=_export, reads=facts.run),
    "flywheel": Command(asks=_turning, reads=facts.flywheel),
    "fmu": Command(asks=_export, reads=facts.run),
    "forces": Command(asks=_forces, reads=facts.forces),
    "guide": Command(asks=_hinge, reads=facts.guide),
    "hinge": Command(asks=_hinge, reads=lambda case: facts.guide(case) | {"losses", "trials", "retune", "gas_limits"}),
    "identify": Command(
        asks=_identify, reads=lambda case: {"parameters", "drive", "simulation", "flywheel", "inputs", "start"}
    ),
    "optimise": Command(
        asks=lambda case: [*_cycle(case), *_missing(case, "optimise")],
        reads=lambda case: facts.cycle(case) | {"optimise"},
    ),
    "page": Command(asks=_export, reads=facts.page),
    "prove": Command(asks=_prove, reads=facts.simulate),
    "report": Command(asks=lambda case: [], reads=_reads_report),
    "simulate": Command(asks=_simulate, reads=facts.simulate),
    "size": Command(asks=_size, reads=facts.size),
    "sweep": Command(
        asks=lambda case: COMMANDS[meant(case)].lacks(case) if meant(case) else [_ACTS],
        reads=lambda case: COMMANDS[meant(case)].reads(case) if meant(case) else set(),
    ),
}
