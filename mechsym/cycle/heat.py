r"""Gas properties and heat transfer to the walls, each by name.

A property function takes the temperature and the burnt fraction and returns what the first law needs: specific
internal energy u, heat capacity c_v = du/dT, du/dX at constant T, and gas constant R. Energies are sensible, zero at
298.15 K (NASA) or at 0 K (constant gamma); the heat of combustion enters the cycle as heat release.

Heat transfer from the cylinder gas to its walls, by name: Annand, Woschni, Hohenberg, or none.

Each law is a record of its coefficients; `heat_flux` gives the flux in W/m^2. The formulas use nothing but
arithmetic, so numbers, arrays and CasADi expressions all pass through.
"""

from collections.abc import Callable
from typing import Annotated, NamedTuple

import casadi as ca

from mechsym.quantities import quantity, record
from mechsym.quantities.units import Kelvin, Pascal, Pure, Scalar, Viscosity

UNIVERSAL = 8.31446261815324  # [J/(mol K)], CODATA 2018, exact
T_REFERENCE = 298.15  # zero of the sensible energies [K]
MOTORED_EXPONENT = 1.35  #: Polytropic exponent of the motored cycle in Woschni's term [-]
_T_SPLIT, _T_BLEND = 1000.0, 100.0

# NASA seven-coefficient fits cp/R = a1 + a2 T + ... + a5 T^4 of GRI-Mech 3.0 (thermo30.dat): (below, above 1000 K)
_NASA = {
    "N2": ((3.298677, 1.4082404e-3, -3.963222e-6, 5.641515e-9, -2.444854e-12),
           (2.92664, 1.4879768e-3, -5.68476e-7, 1.0097038e-10, -6.753351e-15)),
    "O2": ((3.78245636, -2.99673416e-3, 9.84730201e-6, -9.68129509e-9, 3.24372837e-12),
           (3.28253784, 1.48308754e-3, -7.57966669e-7, 2.09470555e-10, -2.16717794e-14)),
    "CO2": ((2.35677352, 8.98459677e-3, -7.12356269e-6, 2.45919022e-9, -1.43699548e-13),
            (3.85746029, 4.41437026e-3, -2.21481404e-6, 5.23490188e-10, -4.72084164e-14)),
    "H2O": ((4.19864056, -2.0364341e-3, 6.52040211e-6, -5.48797062e-9, 1.77197817e-12),
            (3.03399249, 2.17691804e-3, -1.64072518e-7, -9.7041987e-11, 1.68200992e-14)),
}  # fmt: skip
_MOLAR_MASS = {"N2": 28.0134e-3, "O2": 31.9988e-3, "CO2": 44.0095e-3, "H2O": 18.01528e-3}  # [kg/mol]
_N2_PER_O2 = 3.773  # moles of "atmospheric nitrogen" (argon counted in) per mole of oxygen, Heywood (1988), p. 65


class Properties(NamedTuple):
    """What the first law needs to know of the gas: u [J/kg], c_v [J/(kg K)], du/dX [J/kg], R [J/(kg K)]."""

    energy: Scalar
    heat_capacity: Scalar
    energy_slope: Scalar
    gas_constant: Scalar


@record
class ConstantGamma:
    """Section `[gas]`, `model = "constant_gamma"`: a perfect gas."""

    gas_constant: float = quantity("J/kg/K", default=287.0, above=0, about="specific gas constant")
    gamma: float = quantity("-", default=1.4, above=1, high=5 / 3, about="ratio of heat capacities")


@record
class NasaMixture:
    """Section `[gas]`, `model = "nasa"`: air that turns into the products of complete combustion of CH_y."""

    #: Atoms of hydrogen per atom of carbon in the fuel, y [-]
    hydrogen_carbon: float = quantity("-", default=1.87, low=0, high=4, about="H atoms per C atom in the fuel")
    #: Air over stoichiometric air; below 1 products would hold carbon monoxide, which is left out [-]
    excess_air: float = quantity("-", default=1.0, low=1, about="air over stoichiometric air")


def properties(gas: ConstantGamma | NasaMixture, t: Kelvin[Scalar], burnt: Pure[Scalar]) -> Properties:
    r"""Properties of the cylinder gas.

    .. math:: u = c_v T \;\text{(constant)}, \qquad
        u = (1 - X)\,u_{air}(T) + X\,u_{products}(T), \; R = (1 - X) R_{air} + X R_{products} \;\text{(NASA)}

    burnt: burnt mass fraction X, 0 to 1. Returns properties: u [J/kg], c_v [J/(kg*K)], du/dX [J/kg], R [J/(kg*K)]. Fuel
    vapour is counted as air and products do not dissociate. NASA fits hold from 300 to 5000 K [K].
    """
    match gas:
        case ConstantGamma():
            cv = gas.gas_constant / (gas.gamma - 1)
            return Properties(cv * t, cv, 0.0, gas.gas_constant)
        case NasaMixture():
            oxygen = 1 + gas.hydrogen_carbon / 4
            moles = {
                "CO2": 1.0,
                "H2O": gas.hydrogen_carbon / 2,
                "O2": (gas.excess_air - 1) * oxygen,
                "N2": gas.excess_air * oxygen * _N2_PER_O2,
            }
            air, products = _mass_fractions({"O2": 1.0, "N2": _N2_PER_O2}), _mass_fractions(moles)
            u, cv, r = (
                _mix(air, products, burnt, lambda species: _energy(species, t)),
                _mix(air, products, burnt, lambda species: _heat_capacity(species, t)),
                _mix(air, products, burnt, _gas_constant),
            )
            slope = _sum(products, lambda s: _energy(s, t)) - _sum(air, lambda s: _energy(s, t))
            return Properties(u, cv, slope, r)
    raise TypeError(f"no gas model for {type(gas).__name__}")


def viscosity(t: Kelvin[Scalar]) -> Viscosity[Scalar]:
    """Dynamic viscosity of air. Source: Blair (1999) as printed in Nunes (2017), eq. (2.34)."""
    return 7.457e-6 + 4.1547e-8 * t - 7.4793e-12 * t**2


def conductivity(t: Kelvin[Scalar]) -> Annotated[Scalar, "W/(m*K)"]:
    """Thermal conductivity of air. Source: Blair (1999) as printed in Nunes (2017), eq. (2.36)."""
    return 6.1944e-3 + 7.3814e-5 * t - 1.2491e-8 * t**2


def _mass_fractions(moles: dict[str, float]) -> dict[str, float]:
    total = sum(n * _MOLAR_MASS[s] for s, n in moles.items())
    return {s: n * _MOLAR_MASS[s] / total for s, n in moles.items()}


def _sum(fractions: dict[str, float], value: Callable[[str], Scalar]) -> Scalar:
    return sum(y * value(species) for species, y in fractions.items())


def _mix(air: dict[str, float], products: dict[str, float], burnt: Scalar, value: Callable[[str], Scalar]) -> Scalar:
    return (1 - burnt) * _sum(air, value) + burnt * _sum(products, value)


def _gas_constant(species: str) -> float:
    return UNIVERSAL / _MOLAR_MASS[species]


def _heat_capacity(species: str, t: Scalar) -> Scalar:
    w, dw = _blend(t)
    low, high = _NASA[species]
    u_low, u_high = _ranges(species, t)
    slopes = (1 - w) * (_polynomial(low, t) - 1) + w * (_polynomial(high, t) - 1)
    return _gas_constant(species) * (slopes + dw * (u_high - u_low))


def _energy(species: str, t: Scalar) -> Scalar:
    w, _ = _blend(t)
    u_low, u_high = _ranges(species, t)
    return _gas_constant(species) * ((1 - w) * u_low + w * u_high)


def _blend(t: Scalar) -> tuple[Scalar, Scalar]:
    # a switch at 1000 K would leave a kink in c_v, at which an integrator loses its order; the ranges agree to 1e-4
    # over the width of the blend, and c_v is the derivative of the blended u to the last bit
    s = ca.tanh((t - _T_SPLIT) / _T_BLEND)
    return (1 + s) / 2, (1 - s**2) / (2 * _T_BLEND)


def _ranges(species: str, t: Scalar) -> tuple[Scalar, Scalar]:
    # u/R of both ranges, zero at the reference and continuous at 1000 K, which the fit's rounded constants are not
    low, high = _NASA[species]
    zero = _integral(low, T_REFERENCE) - T_REFERENCE
    step = _integral(low, _T_SPLIT) - _integral(high, _T_SPLIT) - zero
    return _integral(low, t) - t - zero, _integral(high, t) - t + step


def _polynomial(a: tuple[float, ...], t: Scalar) -> Scalar:
    return a[0] + t * (a[1] + t * (a[2] + t * (a[3] + t * a[4])))


def _integral(a: tuple[float, ...], t: Scalar) -> Scalar:
    return t * (a[0] + t * (a[1] / 2 + t * (a[2] / 3 + t * (a[3] / 4 + t * a[4] / 5))))


class GasAtWall(NamedTuple):
    """The gas as a heat-transfer law sees it.

    p [Pa], t [K], v [m^3], gas_constant [J/(kg K)], bore [m], piston_speed (mean) [m/s], and swirl, Woschni's
    velocity by combustion divided by its coefficient: V_d T_r (p - p_motored)/(p_r V_r) [K], 0 before ignition.
    """

    p: Scalar
    t: Scalar
    v: Scalar
    gas_constant: Scalar
    bore: Scalar
    piston_speed: Scalar
    swirl: Scalar = 0.0


@record
class Annand:
    """Section `[heat_transfer]`, `law = "annand"`: Nu = a Re^b and radiation."""

    wall_temperature: float = quantity("K", above=0, about="mean wall temperature")
    #: Factor of the Nusselt number, 0.49 for four-stroke, 0.26 for two-stroke engines [-]
    a: float = quantity("-", default=0.49, low=0, about="factor of the Nusselt number")
    exponent: float = quantity("-", default=0.7, above=0, below=1.5, about="exponent of the Reynolds number")
    #: Factor of T^4 - T_w^4; 4.25e-9 for spark ignition, of order 3e-8 for compression ignition [W/(m^2*K^4)]
    radiation: float = quantity("W/m^2/K^4", default=4.25e-9, low=0, about="radiation factor")


@record
class Woschni:
    """Section `[heat_transfer]`, `law = "woschni"`."""

    wall_temperature: float = quantity("K", above=0, about="mean wall temperature")
    #: Gas velocity over mean piston speed while the valves are closed [-]
    c1: float = quantity("-", default=2.28, low=0, about="gas velocity over mean piston speed")
    c2: float = quantity("m/s/K", default=3.24e-3, low=0, about="gas velocity by combustion")


@record
class Hohenberg:
    """Section `[heat_transfer]`, `law = "hohenberg"`."""

    wall_temperature: float = quantity("K", above=0, about="mean wall temperature")
    c1: float = quantity("-", default=130.0, low=0, about="factor, pressure in bar")
    c2: float = quantity("m/s", default=1.4, low=0, about="velocity added to the mean piston speed")


@record
class Adiabatic:
    """Section `[heat_transfer]`, `law = "none"`: no heat is lost."""


Law = Annand | Woschni | Hohenberg | Adiabatic


def heat_flux(law: Law, state: GasAtWall) -> Annotated[Scalar, "W/m^2"]:
    r"""Heat flux from the gas to the walls.

    .. math::
        \text{Annand:}\quad & q = \frac{k}{B} a Re^{b}(T - T_w) + C_r (T^4 - T_w^4), \quad
            Re = \frac{p}{R T}\frac{\bar S_p B}{\mu} \\
        \text{Woschni:}\quad & q = 3.26\,B^{-0.2} p_{kPa}^{0.8} T^{-0.55} w^{0.8} (T - T_w), \quad
            w = C_1 \bar S_p + C_2 \frac{V_d T_r}{p_r V_r}(p - p_0) \\
        \text{Hohenberg:}\quad & q = C_1 V^{-0.06} p_{bar}^{0.8} T^{-0.4} (\bar S_p + C_2)^{0.8} (T - T_w)

    Returns flux: positive from the gas to the walls. Sources: Annand (1963) as printed in Nunes (2017), eqs. (2.30) to
    (2.37); Woschni (1967) after Heywood (1988), eqs. (12.19) and (12.20); Hohenberg (1979).
    """
    match law:
        case Annand():
            density = state.p / (state.gas_constant * state.t)
            reynolds = density * state.piston_speed * state.bore / viscosity(state.t)
            convection = conductivity(state.t) / state.bore * law.a * reynolds**law.exponent
            # (T^4 - Tw^4)/(T - Tw) times (T - Tw): written without the quotient, which is 0/0 at the wall's temperature
            radiation = law.radiation * (state.t**4 - law.wall_temperature**4)
            return convection * (state.t - law.wall_temperature) + radiation
        case Woschni():
            w = law.c1 * state.piston_speed + law.c2 * state.swirl
            factor = 3.26 * state.bore**-0.2 * (state.p / 1e3) ** 0.8 * state.t**-0.55 * w**0.8
            return factor * (state.t - law.wall_temperature)
        case Hohenberg():
            speed = (state.piston_speed + law.c2) ** 0.8
            factor = law.c1 * state.v**-0.06 * (state.p / 1e5) ** 0.8 * state.t**-0.4 * speed
            return factor * (state.t - law.wall_temperature)
        case Adiabatic():
            return 0.0 * state.t
    raise TypeError(f"no heat-transfer law for {type(law).__name__}")


def motored_swirl(
    law: Law, p: Pascal[Scalar], p_motored: Pascal[Scalar], scale: Annotated[Scalar, "K/Pa"]
) -> Kelvin[Scalar]:
    """Woschni's combustion term, zero where the pressure is below the motored pressure and for the other laws.

    p, p_motored: pressure, and pressure of the motored cycle at the same volume; scale: V_d T_r/(p_r V_r) of the
    reference state. Returns swirl: entry of `GasAtWall`.
    """
    return scale * ca.fmax(p - p_motored, 0.0) if isinstance(law, Woschni) else 0.0
