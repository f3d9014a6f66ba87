"""Which sections each command reads, and which of them it cannot do without."""

from collections.abc import Mapping
from typing import Any

from mechsym.cycle.kinds import KINDS
from mechsym.mechanisms import by_roles
from mechsym.mechanisms.traits import Traits, rules_of, with_chain, with_hinge, with_trait

_GUIDE = ("spring", "guide", "rollers", "limits")
_FLAT = tuple(name for name, kind in KINDS.items() if kind.given == "chamber")

# command: sections that it cannot do without; `_extra` adds what mechanism and kind of cycle ask for
NEEDS: Mapping[str, tuple[str, ...]] = {
    "codesign": ("parameters", "operation", "cycle", *_GUIDE, "codesign"),
    "compare": ("parameters", "cycle", "speeds"),
    "cycle": ("parameters", "operation", "cycle"),
    "eval": ("parameters",),
    "flywheel": ("parameters", "operation"),
    "forces": ("parameters", "operation"),
    "guide": ("parameters", "operation", "cycle", *_GUIDE),
    "hinge": ("parameters", "operation", "cycle", *_GUIDE),
    "identify": ("parameters",),
    "optimise": ("parameters", "operation", "cycle", "optimise"),
    "simulate": ("parameters", "simulation"),
    "size": ("parameters", "operation", "cycle"),
}

_PARTS = ("part_piston", "part_cylinder", "part_gears", "part_crank", "part_bearings", "part_masses")

# command: sections that it reads where they stand
READS: Mapping[str, tuple[str, ...]] = {
    "codesign": ("torque", "flywheel", "load", "losses", "scavenging"),
    "compare": ("chamber", "gas", "heat_transfer", "friction_pressure", "friction", "rings"),
    "cycle": ("chamber", "gas", "heat_transfer", "friction_pressure", "stirling", "friction", "rings", "combustion",
              "measured", "faces", "closing", "load", "scavenging", "gas_limits"),
    "eval": ("inputs", "start"),
    "flywheel": ("torque", "drive", "inputs", "start", "cycle", "chamber", "gas", "heat_transfer", "load",
                 "flywheel", "faces", "closing", "scavenging"),
    "forces": ("torque", "cycle", "chamber", "gas", "heat_transfer", "friction", "rings", "shaking", "comparison",
               "faces", "closing", "inputs", "stirling", "scavenging", "gas_limits"),
    "guide": ("torque", "flywheel", "load", "scavenging"),
    "hinge": ("torque", "drive", "inputs", "start", "flywheel", "load", "trials", "retune", "losses",
              "scavenging", "gas_limits"),
    "identify": ("drive", "simulation"),
    "optimise": ("chamber", "gas", "heat_transfer", "friction_pressure", "gas_limits", "stirling", "breathing", "boost",
                 "scavenging"),
    "simulate": ("torque", "drive", "cycle", "chamber", "gas", "heat_transfer", "load", "startup", "operation",
                 "inputs", "start", *_GUIDE, "flywheel", "stirling", "scavenging", "gas_limits"),
    "size": ("sizing", *_PARTS, "part_crosshead", "chamber", "gas", "heat_transfer", "speeds", "friction",
             "scavenging"),
}  # fmt: skip


def commands_of(section: str) -> list[str]:
    """The commands that read a section."""
    if section == "report":
        return ["all"]
    return sorted(name for name in NEEDS if section in NEEDS[name] or section in READS[name])


def lacking(mechanism: str, tables: Mapping[str, Any]) -> dict[str, list[str]]:
    """What each command still lacks to run on a case, given its sections with their raw values.

    Returns
    -------
    missing : dict of str to list of str
        Sections, or what else has to change in words; empty where the command can run
    """
    return {name: _lacking(name, mechanism, tables) for name in sorted(NEEDS)}


def _lacking(command: str, mechanism: str, tables: Mapping[str, Any]) -> list[str]:
    missing = [f"[{section}]" for section in NEEDS[command] if section not in tables]
    if command == "simulate" and {"cycle", "operation"} <= tables.keys():
        missing = [section for section in missing if section != "[simulation]"]  # an engine runs without it
    kind = str((tables.get("cycle") or {}).get("kind", "")) if isinstance(tables.get("cycle"), dict) else ""
    given = KINDS[kind].given if kind in KINDS else ""
    if by_roles(mechanism):
        return _of_own(command, missing, tables)
    missing += _of_mechanism(command, mechanism, tables)
    if given == "engine" and command in ("cycle", "compare", "flywheel", "forces", "optimise", "size"):
        missing += [f"[{section}]" for section in ("chamber", "heat_transfer") if section not in tables]
    missing += _of_cycle(command, kind, given)
    if command == "size" and kind and given != "engine" and "part_crosshead" not in tables:
        missing += ['[cycle] kind = "spark-ignition"']
    return list(dict.fromkeys(missing))


def _of_own(command: str, missing: list[str], tables: Mapping[str, Any]) -> list[str]:
    """A machine of the user's own may do without a cycle: a torque, a drive, weights and springs act on it too."""
    if command == "simulate" and {"torque", "operation"} <= tables.keys():
        return [section for section in missing if section != "[simulation]"]
    if command in ("guide", "hinge", "size"):
        return [section for section in missing if section != "[cycle]"]
    return ["[cycle] or [torque]" if command == "codesign" and s == "[cycle]" else s for s in missing]


def _of_mechanism(command: str, mechanism: str, tables: Mapping[str, Any]) -> list[str]:
    if command in ("hinge", "codesign", "guide") and mechanism not in with_hinge():
        return [f"mechanism = {_quoted(with_hinge())}"]
    if command == "size":
        return _of_size(mechanism, tables)
    if command in ("cycle", "compare", "flywheel", "forces", "optimise") and mechanism not in with_chain():
        return [f"a mechanism with a piston: {', '.join(with_chain())}"]
    if mechanism in with_trait(_undetermined) and command in ("forces", "flywheel"):
        with_gas = ["faces"] if "cycle" in tables else []
        return [f"[{section}]" for section in ("closing", *with_gas) if section not in tables]
    if command == "simulate" and mechanism in {*with_hinge(), *with_trait(lambda known: known.shaft)}:
        return [] if {"drive", "cycle"} & tables.keys() else ["[drive] or [cycle]"]
    return []


def _undetermined(known: Traits) -> bool:
    return known.chain is not None and known.chain.overconstrained


def _quoted(names: tuple[str, ...]) -> str:
    return " or ".join(f'"{name}"' for name in names)


def _of_size(mechanism: str, tables: Mapping[str, Any]) -> list[str]:
    if not rules_of(mechanism):
        return [f"mechanism = {_quoted(with_trait(lambda known: known.rules))}"]
    slider = rules_of(mechanism) == "slider crank"
    if slider and "part_crosshead" in tables:
        return []
    # the parts of a planet are sized beside printed ones
    return [f"[{section}]" for section in ("speeds", *(() if slider else _PARTS)) if section not in tables]


def _of_cycle(command: str, kind: str, given: str) -> list[str]:
    if not kind:
        return []
    if command in ("hinge", "codesign", "guide") and given != "chamber":
        return [f"[cycle] kind = {' or '.join(_FLAT)}"]
    if command == "compare" and given != "engine":
        return ['[cycle] kind = "spark-ignition"']
    return []
