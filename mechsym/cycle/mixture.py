r"""Gas properties by name: the constant heat-capacity ratio of the hand calculation, or NASA polynomials.

A property function takes the temperature and the burnt fraction and returns what the first law needs: specific
internal energy u, heat capacity c_v = du/dT, du/dX at constant T, and gas constant R. Energies are sensible, zero at
298.15 K (NASA) or at 0 K (constant gamma); the heat of combustion enters the cycle as heat release.
"""

from collections.abc import Callable
from typing import Annotated, NamedTuple

import casadi as ca

from mechsym.quantities import quantity, record
from mechsym.quantities.units import Kelvin, Pure, Scalar, Viscosity

UNIVERSAL = 8.31446261815324  # [J/(mol K)], CODATA 2018, exact
T_REFERENCE = 298.15  # zero of the sensible energies [K]
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
            air, products = _air(), _products(gas)
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


def _air() -> dict[str, float]:
    return _mass_fractions({"O2": 1.0, "N2": _N2_PER_O2})


def _products(gas: NasaMixture) -> dict[str, float]:
    oxygen = 1 + gas.hydrogen_carbon / 4
    moles = {
        "CO2": 1.0,
        "H2O": gas.hydrogen_carbon / 2,
        "O2": (gas.excess_air - 1) * oxygen,
        "N2": gas.excess_air * oxygen * _N2_PER_O2,
    }
    return _mass_fractions(moles)


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
