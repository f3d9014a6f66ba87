"""Theories of source 004: opposed-piston engines, the ideal Otto cycle, one step of the closed cycle, performance."""

from collections.abc import Mapping

import sympy
from sympy import Symbol, diff, integrate, pi

from mechsym.audit.theory.conversion import tape_of
from mechsym.audit.theory.guides import generic
from mechsym.audit.theory.mechanisms import mechanism_theory
from mechsym.audit.theory.record import Letter, Theory, extended
from mechsym.audit.theory.sliders import slider_crank
from mechsym.derive import derive
from mechsym.derive.build import declared

# table 3.2; the pressure is a value of the order of the cycle's peak
_CHAMBER = {
    "A_piston": Letter(unit="m^2", value=2.8274e-3), "V_c": Letter(unit="m^3", value=3.2673e-5),
    "V_displacement": Letter(unit="m^3", value=2.9405e-4), "CR": Letter(unit="-", value=10.0),
    "p": Letter(unit="Pa", value=5e6),
}  # fmt: skip
_STEP = {
    "P1": Letter(unit="Pa", value=1e6), "V1": Letter(unit="m^3", value=1e-4), "V2": Letter(unit="m^3",
    value=9.6e-5),
    "Q_R": Letter(unit="J", value=8.0), "Q_L": Letter(unit="J", value=1.0), "Q_vap": Letter(unit="J", value=0.5),
    "gamma": Letter(unit="-", value=1.4), "m2": Letter(unit="kg", value=4e-4), "R": Letter(unit="J/kg/K",
    value=287.0),
    "N": Letter(unit="1/s", value=2000.0), "n_R": Letter(unit="-", value=2.0), "W_c": Letter(unit="J", value=456.0),
    "V_displaced": Letter(unit="m^3", value=2.9405e-4), "m_fuel": Letter(unit="kg", value=2.3923e-5),
    "QHV": Letter(unit="J/kg", value=43.5e6), "S": Letter(unit="m", value=0.104), "dtheta": Letter(unit="-",
    value=1.0),
    "B": Letter(unit="m", value=0.06), "T": Letter(unit="K", value=900.0), "p": Letter(unit="Pa", value=2e6),
    "m": Letter(unit="kg", value=4e-4), "P_kW": Letter(unit="W", value=25.0),
}  # fmt: skip
_SPEED = 8000 * 2 * 3.141592653589793 / 60
_CLEARANCE = {"clearance_volume": ("V_displacement/(CR - 1)", "m^3")}  # CR = (V_d + V_c)/V_c solved for V_c


def opposed_slider_crank(values: Mapping[str, float], data: str) -> Theory:
    """One of the two slider cranks of the opposed-piston engine, and the chamber between both pistons.

    Returns
    -------
    theory : Theory
        The slider crank's with `piston_position` from the shaft, `chamber_volume`, `clearance_volume`
    """
    base = slider_crank({}, data)
    table = {"r": 0.026, "l": 0.09, "m": 0.25, "phid": _SPEED, "F": 14000.0}
    letters = {k: Letter(unit=v.unit, value=table.get(k, v.value)) for k, v in base.letters.items()}
    position = {
        "piston_position": ("r + l - x", "m"),
        "piston_velocity": ("-dx_dphi*phid", "m/s"),
        "piston_acceleration_outwards": ("-d2x_dphi2*phid**2", "m/s^2"),
        "force_on_piston": ("p*A_piston - m*d2x_dphi2*phid**2", "N"),
        "chamber_volume": ("V_c + 2*A_piston*x", "m^3"),
    }
    return extended(base, "opposed_slider_crank", letters | _CHAMBER, position | _CLEARANCE)


def opposed_hypocycloid(values: Mapping[str, float], data: str) -> Theory:
    """One of the two geared hypocycloids of the opposed-piston engine, and the chamber between both pistons.

    Returns
    -------
    theory : Theory
        The hypocycloid's with `piston_position`, `total_force`, `chamber_volume`; l is the length of the piston rod
    """
    known = {"e": 0.013, "m3": 0.25, "thetad": _SPEED, "thetadd": 0.0, "theta": 1.0, "F": 14000.0, "alpha_n": 0.436}
    base = mechanism_theory(derive(declared("hypocycloid")), known, (), data, {})
    position = {
        "piston_position": ("2*e + l - x", "m"),
        "piston_velocity": ("-dx_dtheta*thetad", "m/s"),
        "piston_acceleration_outwards": ("-d2x_dtheta2*thetad**2", "m/s^2"),
        "total_force": ("F - m3*(dx_dtheta*thetadd + d2x_dtheta2*thetad**2)", "N"),
        "chamber_volume": ("V_c + 2*A_piston*x", "m^3"),
    }
    rod = {"l": Letter(unit="m", value=0.0886)}
    return extended(base, "opposed_hypocycloid", rod | _CHAMBER, position | _CLEARANCE)


def otto(values: Mapping[str, float], data: str) -> Theory:
    """The ideal Otto cycle 1-2-3-4 of a perfect gas with heat Q at constant volume.

    Returns
    -------
    theory : Theory
        Pressures, temperatures, works, heats and the efficiency
    """
    letters = {
        "p1": Letter(unit="Pa", value=101325.0), "T1": Letter(unit="K", value=288.15),
        "V1": Letter(unit="m^3", value=3.2673e-4), "V2": Letter(unit="m^3", value=3.2673e-5),
        "C_v": Letter(unit="J/kg/K", value=718.0), "gamma": Letter(unit="-", value=1.4),
        "Q_23": Letter(unit="J", value=900.0), "V_displaced": Letter(unit="m^3", value=2.9405e-4),
        "AFR": Letter(unit="-", value=15.06), "eta_c": Letter(unit="-", value=0.87),
        "QHV": Letter(unit="J/kg", value=43.5e6), "C_p": Letter(unit="J/kg/K", value=1005.2),
    }  # fmt: skip
    p1, T1, V1, V2, C_v, gamma, Q, V_d, AFR, eta_c, QHV, C_p = (Symbol(k, positive=True) for k in letters)
    R, m1, m_air, m_fuel, p2, T2, p3, T3, p4, T4, V = (
        Symbol(k, positive=True) for k in "R m1 m_air m_fuel p2 T2 p3 T3 p4 T4 V".split()
    )
    compressed, expanded = (generic(integrate(c * V**-gamma, V)) for c in (p1 * V1**gamma, p3 * V2**gamma))
    # p V^gamma is constant from 1 to 2 and from 3 to 4, p V = m R T everywhere, the volume is constant from 2 to 3
    expressions = {
        "R": (gamma - 1) * C_v, "CR": V1 / V2, "m1": p1 * V1 / (R * T1), "m_air": p1 * V_d / (R * T1),
        "m_fuel": m_air / AFR, "fuel_heat": eta_c * m_fuel * QHV, "p2": p1 * (V1 / V2) ** gamma,
        "T2": p2 * V2 / (m1 * R), "T3": T2 + Q / (m1 * C_v), "p3": m1 * R * T3 / V2, "p4": p3 * (V2 / V1) ** gamma,
        "T4": p4 * V1 / (m1 * R), "W_12": compressed.subs(V, V2) - compressed.subs(V, V1),
        "W_34": expanded.subs(V, V1) - expanded.subs(V, V2), "U_12": m1 * C_v * (T2 - T1),
        "U_23": m1 * C_v * (T3 - T2), "U_34": m1 * C_v * (T4 - T3), "Q_41": m1 * C_v * (T1 - T4),
        "heat_capacity_ratio": C_p / C_v,
    }  # fmt: skip
    expressions["efficiency"] = (Symbol("W_12") + Symbol("W_34")) / Q
    units = {"R": "J/kg/K", "CR": "-"} | {k: "Pa" for k in ("p2", "p3", "p4")}
    return Theory(
        name="otto", letters=letters, tape=tape_of(expressions), results=tuple(expressions), units=units, data=data
    )


def cylinder(values: Mapping[str, float], data: str) -> Theory:
    """One step of the closed cycle, and the figures of performance.

    Returns
    -------
    theory : Theory
        `pressure_after` solves the first law with trapezoidal work for a perfect gas; the rest follows from the work
        per cycle `W_c` of a four-stroke engine at N rpm
    """
    s = {k: Symbol(k, positive=True) for k in _STEP}
    P2, gamma, P1, V1, V2 = Symbol("P2", positive=True), s["gamma"], s["P1"], s["V1"], s["V2"]
    heat = s["Q_R"] - s["Q_L"] - s["Q_vap"]
    # internal energy of a perfect gas is p V/(gamma - 1); the work is that of the mean pressure
    balance = heat - (P2 * V2 - P1 * V1) / (gamma - 1) - (P1 + P2) / 2 * (V2 - V1)
    after = -balance.subs(P2, 0) / diff(balance, P2)  # the balance is linear in it
    rev = s["N"] / 60  # revolutions per second
    power, omega = s["W_c"] * rev / s["n_R"], 2 * pi * rev
    flow = s["m_fuel"] * rev / s["n_R"]
    expressions = {
        "pressure_after": after,
        "temperature_after": after * V2 / (s["m2"] * s["R"]),
        "gas_factor": (gamma + 1) / (gamma - 1),
        "omega": omega,
        "power": power,
        "power_kw": power / 1000,
        "horsepower": s["P_kW"] / sympy.Rational("0.74569987158227022"),
        "Tq": power / omega,
        "mep": s["W_c"] / s["V_displaced"],
        "mdot_fuel": flow,
        "sfc": flow / power,
        "efficiency": s["W_c"] / (s["m_fuel"] * s["QHV"]),
        "mean_piston_speed": 2 * s["S"] * rev,
        "time_step": s["dtheta"] / 360 / rev,
        "density": s["p"] / (s["R"] * s["T"]),
    }
    units = {"power": "W", "Tq": "N*m", "mep": "Pa", "mdot_fuel": "kg/s", "omega": "rad/s"}
    return Theory(
        name="cylinder", letters=_STEP, tape=tape_of(expressions), results=tuple(expressions), units=units, data=data
    )
