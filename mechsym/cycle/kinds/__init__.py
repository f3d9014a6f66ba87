"""Which record of `[cycle]` becomes which pressure. A new kind adds one line to each table."""

import dataclasses
import math
from collections.abc import Callable
from typing import Any

import casadi as ca

from mechsym.cycle.cylinder import Cylinder, cylinder_of
from mechsym.cycle.kinds import two_stroke
from mechsym.cycle.kinds.two_stroke import TwoStrokeMarine
from mechsym.cycle.kinds.two_stroke_solve import two_stroke_pressure
from mechsym.cycle.kinds.two_stroke_zone import TwoStrokeZone, two_stroke_zone_pressure
from mechsym.cycle.measured.diagram import Diagram
from mechsym.cycle.measured.pressure import diagram_pressure
from mechsym.cycle.pressure import Pressure
from mechsym.errors import BadInput

_PRESSURES: dict[type, Callable[[Any, Cylinder], Pressure]] = {
    TwoStrokeMarine: two_stroke_pressure,
    Diagram: diagram_pressure,
}
_BACK_PRESSURES: dict[type, Callable[[Any], float]] = {
    TwoStrokeMarine: two_stroke.back_pressure,
    Diagram: lambda diagram: diagram.p_back,
    TwoStrokeZone: lambda cycle: cycle.p_back,
}


def cylinder_pressure(cycle: Any, kinematics: ca.Function) -> tuple[Pressure, Cylinder]:
    """Pressure in the cylinder of a mechanism.

    Parameters
    ----------
    cycle : record
        `[cycle]` of a case, of any kind
    kinematics : casadi.Function
        One input, the crank angle; outputs `x` and `dx_dphi`

    Raises
    ------
    BadInput
        The cycle cannot be made, or depends on more than the angle
    """
    if type(cycle) not in _BACK_PRESSURES:
        raise BadInput(
            "[cycle] of kind spark-ignition or schmidt gives no indicator diagram here; take kind two-stroke-marine, "
            "two-stroke-zone or diagram (spark ignition in motion: 'mechsym cycle CASE --loop 10')"
        )
    cylinder = cylinder_of(kinematics, cycle.bore, cycle.compression_ratio)
    if isinstance(cycle, TwoStrokeZone):  # integrated, so it needs the travel as a CasADi function
        return two_stroke_zone_pressure(cycle, kinematics), cylinder
    return _PRESSURES[type(cycle)](cycle, cylinder), cylinder


def back_pressure(cycle: Any) -> float:
    """Absolute pressure under the piston.

    Parameters
    ----------
    cycle : record
        `[cycle]` of a case, of any kind

    Returns
    -------
    p_back : float
        For `piston_force` [Pa]
    """
    return _BACK_PRESSURES[type(cycle)](cycle)


def with_diagram(cycle: Any, file: str) -> Diagram:
    """The cycle of a case with a measured diagram in its place.

    Parameters
    ----------
    cycle : record
        `[cycle]` of a case; of a `diagram` all methods are kept, of another kind what it knows of the engine

    Raises
    ------
    BadInput
        A cycle of another kind, whose cylinder is not known
    """
    if isinstance(cycle, Diagram):
        return dataclasses.replace(cycle, file=file)
    if not isinstance(cycle, TwoStrokeMarine | TwoStrokeZone):
        raise BadInput(
            f"{file}: a measured diagram has no cylinder in this case; give [cycle] kind = 'diagram' with bore, "
            "compression_ratio and working_cycle"
        )
    known = _two_stroke_line(cycle) if isinstance(cycle, TwoStrokeMarine) else {"working_cycle": "two-stroke"}
    return Diagram(
        bore=cycle.bore,
        compression_ratio=cycle.compression_ratio,
        p_back=back_pressure(cycle),
        file=file,
        **known,
    )


def _two_stroke_line(cycle: TwoStrokeMarine) -> dict[str, Any]:
    # the compression line stands between the exhaust's closing and the start of combustion, with a margin
    return {
        "working_cycle": "two-stroke",
        "n_c": cycle.n_c,
        "inlet_pressure": two_stroke.scavenging_pressure(cycle.p_s),
        "fit_from": max(cycle.evc + math.radians(15.0), math.radians(-90.0)),
        "fit_to": min(cycle.soc - math.radians(5.0), math.radians(-15.0)),
    }
