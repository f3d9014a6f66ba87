"""`mechsym eval`: a mechanism at one state."""

import dataclasses
from typing import TYPE_CHECKING

import click

from mechsym.cli.common import emit, json_option, pairs, refuse_idle, set_option
from mechsym.errors import BadInput
from mechsym.quantities.results import tell

if TYPE_CHECKING:
    from mechsym.derive.listing import Listing
    from mechsym.mechanisms.record import Mechanism
    from mechsym.mechanisms.state import MechanismState
    from mechsym.plausible import Doubt

_RATES = (("", "s"), ("d", "s^2"))
_ROUND_OFF = 1e-14  # what trigonometry leaves of a zero, by the largest value with the same unit [-]


@click.command("eval", short_help="Evaluate a mechanism at one state.")
@click.argument("name")
@click.option("--case", "case_name", help="Case that gives the parameters; without it set them all.")
@click.option("--latex", is_flag=True, help="Print the equations as LaTeX instead of a state.")
@set_option
@json_option
def evaluate(name: str, case_name: str | None, latex: bool, overrides: tuple[str, ...]) -> None:
    """Evaluate a mechanism at one state; names are parameters, coordinates, velocities and inputs.

    NAME is a mechanism, or a case, which gives its mechanism and the parameters. What is not set is 0, or as the pose
    of a declaration says where loops close by constraint. mass_matrix * qdd + bias = generalized_force. An acceleration
    that is set (phidd=3) asks for the force along its coordinate that makes it, driving_phi.

    \b
    Examples: mechsym eval zotov-89 --set phi=1.0 --set phid=9.32 --set F=1e5
              mechsym eval crosshead --latex
    """
    from mechsym import cases, mechanisms
    from mechsym.mechanisms.state import state

    if latex:
        refuse_idle("beside --latex: its equations are with letters", "case_name", "overrides")
    if name in cases.names() or name.endswith(".toml"):
        name, case_name = cases.load(name).mechanism, case_name or name
    if latex:
        from mechsym.mechanisms.equations import equations

        emit({"latex": equations(name).rows}, lambda: equations(name).latex)
        return
    mechanism, values, doubts = _read(name, case_name, pairs(overrides))
    known = mechanisms.listing(name, mechanism)
    result = state(mechanism, values, known["outputs"])
    redundant = known.get("redundant", [])
    beside = {"doubts": doubts, **({"redundant": redundant} if redundant else {})}
    emit(result, lambda: "\n".join([*_lines(result, known), *redundant]), beside=beside)


def _read(
    name: str, case_name: str | None, given: dict[str, str]
) -> tuple["Mechanism", dict[str, float], tuple["Doubt", ...]]:
    from mechsym import cases, mechanisms
    from mechsym.cases.owned import letter_of
    from mechsym.plausible import letters as doubted
    from mechsym.quantities import parse

    cls, parameters = mechanisms.parameters_class(name), {}
    if case_name is not None:
        case = cases.load(case_name)
        own = case.need("parameters")
        if not isinstance(own, cls):
            raise BadInput(f"{case.file} is a case of {case.mechanism}, not of {name}; choose another with --case")
        parameters = dataclasses.asdict(own)
    letters = mechanisms.listing(name)["parameters"]
    given = {letter_of(key, letters): text for key, text in given.items()}
    parameters |= {k: parse(t, letters[k], f"--set {k}") for k, t in given.items() if k in letters}
    fields = dataclasses.fields(cls)
    missing = [f.name for f in fields if f.name not in parameters and f.default is dataclasses.MISSING]
    if missing:
        raise BadInput(f"{name}: no value for {', '.join(missing)}; give --case or --set {missing[0]}=...")
    mechanism = mechanisms.build(name, cls(**parameters))
    listing = mechanisms.listing(name, mechanism)
    units = listing["coordinates"] | listing["inputs"]
    units |= {f"{q}d{k}": f"{unit}/{by}" for q, unit in listing["coordinates"].items() for k, by in _RATES}
    posed = listing.get("pose", {}) if mechanism.dependents else {}
    values = {q: v for q, v in posed.items() if q in mechanism.coordinates and q not in mechanism.dependents}
    for key, text in ((letter_of(key, units), text) for key, text in given.items()):
        if key in units:
            values[key] = parse(text, units[key], f"--set {key}")
        elif key not in letters:
            raise BadInput(f"--set {key}: {name} has no such letter; letters are {', '.join([*units, *letters])}")
    known = {**{k: (v, letters[k]) for k, v in parameters.items() if isinstance(v, float)},
            **{k: (v, units[k]) for k, v in values.items()}}  # fmt: skip
    return mechanism, values, doubted(known)


def _lines(state: "MechanismState", listing: "Listing") -> list[str]:
    """A line for each value, with its unit and, of a reaction, who acts on whom."""
    data = tell(state)
    flat = {k: v for k, v in data.items() if k != "outputs"} | data["outputs"]
    units = {"kinetic_energy": "J", "potential_energy": "J", **state.outputs.units, **listing["outputs"]}
    about = listing.get("reactions", {})
    # an angle or a ratio is round-off beside 1; how small a length or an inertia may be, only its like can tell
    largest = {unit: float(unit in ("rad", "rad/rad", "-")) for unit in units.values()}
    for key, unit in units.items():
        largest[unit] = max(largest[unit], abs(flat.get(key) or 0.0))
    # what pushes and speeds up by the energies that are there
    energy, mass = largest["J"], max(abs(m) for row in data["mass_matrix"] for m in row)
    zeros = {"bias": energy, "generalized_force": energy, "acceleration": energy / mass if mass else 0.0}
    rows = (
        (key, _shown(value, _ROUND_OFF * zeros.get(key, largest.get(units.get(key, ""), 0.0))), units.get(key, ""),
         about.get(key, ""))
        for key, value in flat.items()
    )  # fmt: skip
    return [f"{key:25s} {value:18s} {unit:12s} {who}".rstrip() for key, value, unit, who in rows]


def _shown(value: float | list[float] | None, zero: float = 0.0) -> str:
    """Ten digits of a number or a list; what is not above `zero` is 0 [unit of the value], None not determined."""
    if value is None:
        return "not determined"
    if isinstance(value, list):
        return "[" + ", ".join(_shown(v, zero) for v in value) + "]"
    return f"{value:.10g}" if abs(value) > zero else "0"
