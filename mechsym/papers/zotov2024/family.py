"""The family of guides in Fig. 5 of the source: two speeds, two springs, three pressures; as printed and placed.

    a, b: H = 1 m, rho0 = 0.8 m     c, d: H = 0.4 m, rho0 = 0.3 m     a, c: 89 rpm     b, d: 142 rpm
    1, 2, 3: p0 = 3, 5, 8 MPa

Source: Zotov et al. (2024), Fig. 5 and its caption.
"""

import dataclasses

from mechsym.errors import BadInput
from mechsym.hinge.balance import Balance
from mechsym.hinge.choices import GuideParameters, Limits
from mechsym.hinge.guide import Guide, Spring, cut
from mechsym.hinge.limits import Verdict, judge
from mechsym.hinge.rollers import RollerParameters
from mechsym.hinge.springs import AirAbsolute, AirGauge
from mechsym.quantities import record

# letter: (speed index, H [m], rho0 [m])
_CURVES = {"a": (0, 1.0, 0.8), "b": (1, 1.0, 0.8), "c": (0, 0.4, 0.3), "d": (1, 0.4, 0.3)}
_PRESSURES = {"1": 3e6, "2": 5e6, "3": 8e6}  # [Pa]


@record
class Member:
    """One guide of the family."""

    label: str  #: Letter and number in Fig. 5, `a1` to `d3`
    start: str  #: `as_printed` with the paper's law, or `placed` with the case's law
    guide: Guide
    verdict: Verdict  #: Spring pressure, pressure angle, roller reaction, and whether it can be built


def family(
    balances: tuple[Balance, Balance],
    spring: Spring,
    parameters: GuideParameters,
    rollers: RollerParameters,
    limits: Limits,
) -> tuple[Member, ...]:
    """All twelve guides, as printed and placed.

    Parameters
    ----------
    balances : tuple of two Balance
        Torque at the lower and at the higher speed
    spring : AirGauge or AirAbsolute
        Area, polytropic index and law of the placed guides
    parameters : GuideParameters
        Arrangement and z_margin of the placed guides

    Returns
    -------
    members : tuple of Member
        24 members, by label, as printed before placed
    """
    if not isinstance(spring, (AirGauge, AirAbsolute)):
        raise BadInput("spring.law = coil has no p0; the guides of Fig. 5 need air_absolute or air_gauge")
    members = []
    for letter, (speed, H, rho0) in _CURVES.items():
        for number, p0 in _PRESSURES.items():
            printed = GuideParameters(arrangement="two_tracks", start="as_printed", rho0=rho0)
            placed = dataclasses.replace(parameters, start="placed", rho0=rho0)
            gauge = AirGauge(A=spring.A, H=H, p0=p0, n=spring.n)
            filled = dataclasses.replace(spring, H=H, p0=p0)
            for chosen, air in ((printed, gauge), (placed, filled)):
                guide = cut(balances[speed], air, chosen)
                verdict = judge(guide, rollers, limits)
                members.append(Member(label=letter + number, start=chosen.start, guide=guide, verdict=verdict))
    return tuple(members)
