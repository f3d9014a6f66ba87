"""Forces of the derived crank mechanism over the speeds, for a given reciprocating mass."""

from collections.abc import Callable

from mechsym.mechanisms.crosshead import CrossheadParameters, build
from mechsym.mechanisms.record import curves
from mechsym.sizing.pressures import Pressures
from mechsym.sizing.slider_crank.parts import SliderForces


def slider_crank_forces(gas: Pressures, parameters: CrossheadParameters) -> Callable[[float], SliderForces]:
    """Reciprocating mass [kg] -> forces over the speeds."""
    moved = curves(build(parameters), gas.theta)

    def forces_of(mass: float) -> SliderForces:
        force = gas.net - mass * moved["d2x_dphi2"] * gas.omega[:, None] ** 2
        return SliderForces(
            omega=gas.omega, theta=gas.theta, dp_max=gas.dp_max, net=force, torque=force * moved["dx_dphi"],
            r=parameters.r1 + parameters.r2, l=parameters.l1 + parameters.l2, bore=gas.bore, stroke=gas.stroke,
            head_heat=gas.head_heat, gap=gas.gap,
        )  # fmt: skip

    return forces_of
