r"""The pressure controller of a hinge as an FMU of its own, for co-simulation beside the machine.

It reads crank angle and speed at every communication point and sets the spring once in a period, as
`mechsym.codesign.manoeuvres` does: the work that is missing, seen in the speed, is regressed on what a pascal more
gives.

.. math:: w = -\tfrac12 I (\dot\varphi^2 - \overline{\dot\varphi^2}) - \int M_\mathrm{load}\,d\varphi, \qquad
          w - w_\mathrm{design} \approx \Delta p\,\frac{\partial U}{\partial p} + c_0 + c_1 \varphi
"""

from importlib import resources

import casadi as ca
import numpy as np
from scipy.interpolate import PPoly

from mechsym import periodic
from mechsym.errors import BadInput
from mechsym.hinge.balance import balance
from mechsym.hinge.guide import Guide, closing, path, setting_of, with_setting
from mechsym.hinge.torque import Hinge
from mechsym.machine.loads import ConstantLoad, Load, PropellerLoad
from mechsym.out.block import Block, Curve, Port
from mechsym.out.text.language_c import array, curve_tables

_GAIN, _RATE = 0.7, 0.1  # share of the error taken away in a period; largest change by the design's setting
_TURNS = 20.0  # of the run that the file proposes


def controller(name: str, wanted: Hinge, guide: Guide, load: Load) -> tuple[Block, dict[str, str]]:
    """The ports of the controller of a guide, and the C that is its own: file name to text.

    Raises BadInput: the load is a table, or the gas of the spring exchanges heat: a pascal gives no function of the
    angle then.
    """
    if guide.spring.state:
        raise BadInput("the pressure controller takes springs whose force follows from the closing alone")
    made = Block(
        name=f"{name}-controller", about=f"sets the spring of {name} once in a period, from crank angle and speed",
        states=(), inputs=_inputs(wanted), parameters=_parameters(guide, load), outputs=_outputs(guide),
        curves=_curves(wanted, guide), switches=(), kinks=(), stops=(), t_end=_TURNS * 2 * np.pi / wanted.omega,
        rates=ca.Function("rates", [], []), observed=ca.Function("observed", [], []),
    )  # fmt: skip
    core = (resources.files("mechsym.out") / "c" / "controller.h").read_text(encoding="utf-8")
    return made, {"model.h": _model(made, wanted), "core.h": core, "method.h": "\n"}


def _letter(guide: Guide) -> tuple[str, str]:
    return guide.spring.setting


def _inputs(wanted: Hinge) -> tuple[Port, ...]:
    return (
        Port(name="phi", unit="rad", about="crank angle, that of the machine"),
        Port(name="phid", unit="rad/s", start=wanted.omega, about="speed of the crank"),
    )


def _parameters(guide: Guide, load: Load) -> tuple[Port, ...]:
    letter, unit = _letter(guide)
    set_to = float(setting_of(guide.spring))
    match load:
        case ConstantLoad(torque=float(torque)):
            speed, power = 1.0, 0.0
        case PropellerLoad(torque=float(torque), speed=float(speed)):
            power = 2.0
        case _:
            raise BadInput("the pressure controller takes a constant load or a propeller; set load.law")
    return (
        Port(name=f"{letter}_design", unit=unit, start=set_to, about="setting that the guide was cut for"),
        Port(name=f"{letter}_start", unit=unit, start=set_to, about="setting before the first period is over"),
        Port(name="gain", unit="-", start=_GAIN, about="share of the error that is taken away in a period"),
        Port(name="rate", unit="-", start=_RATE, about="largest change in a period, by the setting of the design"),
        Port(name="load_torque", unit="N*m", start=torque, about="torque of the load at load_speed"),
        Port(name="load_speed", unit="rad/s", start=speed, about="speed of reference of the load"),
        Port(name="load_power", unit="-", start=power, about="power of the speed with which the load grows"),
    )


def _outputs(guide: Guide) -> tuple[Port, ...]:
    letter, unit = _letter(guide)
    return (
        Port(name=letter, unit=unit, start=float(setting_of(guide.spring)), about="setting of the spring"),
        Port(name=f"{letter}_error", unit=unit, about="by how much the last period was off the design"),
        Port(name="periods", unit="-", about="periods that are over"),
    )


def _curves(wanted: Hinge, guide: Guide) -> tuple[Curve, ...]:
    """Inertia, energy of the spring for each unit of its setting, and the work that is missing by design."""
    missing = periodic.antiderivative(balance(wanted, guide.parameters.balance).rest)
    curves = {"inertia": wanted.inertia, "unit": _unit_energy(wanted, guide), "design": missing}
    return tuple(Curve(name=name, state=0, poly=poly) for name, poly in curves.items())


def _unit_energy(wanted: Hinge, guide: Guide) -> PPoly:
    """Energy of the spring by its setting over the crank angle [J/Pa], [J/N] of a coil."""
    ratio, rho, at = guide.parameters.shaft_ratio, path(guide), setting_of(guide.spring)
    low, high = (with_setting(guide.spring, share * at) for share in (1.0, 2.0))

    def energy(phi: np.ndarray) -> np.ndarray:
        theta = rho.x[0] + (ratio * phi - rho.x[0]) % (rho.x[-1] - rho.x[0])
        z = closing(guide, rho(theta))
        # the energy is linear in the setting
        return np.asarray((high.energy(z) - low.energy(z)) / at)

    return periodic.fit(energy, (*rho.x / ratio, *(rho.x + rho.x[-1]) / ratio), wanted.period, 1e-10)


def _model(made: Block, wanted: Hinge) -> str:
    sizes = {"NU": len(made.inputs), "NP": len(made.parameters), "NY": len(made.outputs)}
    return "\n".join(
        [
            f"/* {made.name}: {made.about} */",
            "enum { " + ", ".join(f"{k} = {v}" for k, v in sizes.items()) + " };",
            f"static const double PERIOD = {wanted.period!r};",
            array("start_p", [port.start for port in made.parameters]),
            curve_tables(made.curves),
            "struct stop { const char *name; };",
            'static const struct stop stops[] = {{""}};',
        ]
    )
