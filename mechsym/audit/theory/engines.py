r"""Theories without a mechanism: the air spring of source 000 in its guide; cycle, performance and parts of source 004.

z = 2 rho0 - 2 rho closes the spring of height H and area A; p0 is the pressure at z = 0.
W(phi) is the work of the hinge on the crank from phi = 0, M_h its torque: the spring gives what it loses.
"""

from collections.abc import Mapping

import sympy
from sympy import Expr, Symbol, diff, integrate, pi, sin, sqrt

from mechsym.audit.theory.mechanisms import expressed, mechanism_theory, slider_crank
from mechsym.audit.theory.record import Letter, Theory, extended, letters_of
from mechsym.derive import derive
from mechsym.derive.build import declared

_GUIDE = letters_of(
    "H 1.0 m; A 0.031 m^2; n 1.25 -; p0 5000000.0 Pa; p0s 5000000.0 Pa; rho0 0.8 m; rho 0.7 m; W -20000.0 J; "
    "M_h -15000.0 N*m"
)


def guide(values: Mapping[str, float], data: str) -> Theory:
    """The guide of the air spring with the law that the paper prints; the data stand in the caption of Fig. 5."""
    H, A, n, p0, p0s, rho0, rho, W, M_h = (Symbol(k, positive=True) for k in _GUIDE)
    z = Symbol("z", positive=True)
    height = Symbol("y", positive=True)  # y = H - z
    force = p0 * A * (H / height) ** n  # p V^n = p0 (A H)^n with V = A y
    stored = height * force / (1 - n)  # the integral of force over height for n other than 1
    closed, reference = (_path(H, A, n, p, rho0, W) for p in (p0, p0s))
    slope = diff(reference, W) * M_h
    expressions = {
        "z": 2 * rho0 - 2 * rho,
        "spring_force": force.subs(height, H - z),
        "work": stored.subs(height, H - z) - stored.subs(height, H),
        "rho_of_work": closed,
        "rho_star": reference,
        "drho_dphi": slope,
        "dz_dphi": -2 * slope,
        "torque_at_pressure": 2 * force.subs(height, H - 2 * rho0 + 2 * Symbol("rho_star")) * slope,
    }
    units = {"z": "m", "spring_force": "N", "work": "J", "rho_of_work": "m", "torque_at_pressure": "N*m"}
    return expressed("guide", _GUIDE, expressions, units, data)


def generic(expression: sympy.Expr) -> sympy.Expr:
    """The branch of an integral that holds for a general exponent."""
    return expression.replace(sympy.Piecewise, lambda *branches: branches[0][0])


def _path(H: Symbol, A: Symbol, n: Symbol, p0: Symbol, rho0: Symbol, W: Symbol) -> sympy.Expr:
    # W = A p0 H^n (H^(1-n) - y)/(n-1) is linear in y = (H - z)^(1-n)
    y = Symbol("y", positive=True)
    balance = A * p0 * H**n * (H ** (1 - n) - y) / (n - 1) - W
    power = -balance.subs(y, 0) / diff(balance, y)
    return rho0 - H / 2 + power ** (1 / (1 - n)) / 2


# table 3.2; the pressure is a value of the order of the cycle's peak
_CHAMBER = letters_of(
    "A_piston 0.0028274 m^2; V_c 3.2673e-05 m^3; V_displacement 0.00029405 m^3; CR 10.0 -; p 5000000.0 Pa"
)
_STEP = letters_of(
    "P1 1000000.0 Pa; V1 0.0001 m^3; V2 9.6e-05 m^3; Q_R 8.0 J; Q_L 1.0 J; Q_vap 0.5 J; gamma 1.4 -; m2 0.0004 kg; "
    "R 287.0 J/kg/K; N 2000.0 1/s; n_R 2.0 -; W_c 456.0 J; V_displaced 0.00029405 m^3; m_fuel 2.3923e-05 kg; "
    "QHV 43500000.0 J/kg; S 0.104 m; dtheta 1.0 -; B 0.06 m; T 900.0 K; p 2000000.0 Pa; m 0.0004 kg; P_kW 25.0 W"
)
_SPEED = 8000 * 2 * 3.141592653589793 / 60
_CLEARANCE = {"clearance_volume": ("V_displacement/(CR - 1)", "m^3")}  # CR = (V_d + V_c)/V_c solved for V_c


def opposed_slider_crank(values: Mapping[str, float], data: str) -> Theory:
    """One of the two slider cranks of the opposed-piston engine, and the chamber between both pistons."""
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
    """One of its two geared hypocycloids, and the chamber; l is the length of the piston rod."""
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
    """The ideal Otto cycle 1-2-3-4 of a perfect gas with heat Q at constant volume."""
    letters = letters_of(
        "p1 101325.0 Pa; T1 288.15 K; V1 0.00032673 m^3; V2 3.2673e-05 m^3; C_v 718.0 J/kg/K; gamma 1.4 -; "
        "Q_23 900.0 J; V_displaced 0.00029405 m^3; AFR 15.06 -; eta_c 0.87 -; QHV 43500000.0 J/kg; "
        "C_p 1005.2 J/kg/K"
    )
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
    return expressed("otto", letters, expressions, units, data)


def cylinder(values: Mapping[str, float], data: str) -> Theory:
    """One step of the closed cycle, its work trapezoidal, and the figures of a four-stroke engine at N rpm."""
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
    return expressed("cylinder", _STEP, expressions, units, data)


# values of chapter 4; w_crankweb is that of (4.33)
_PARTS = letters_of(
    "p 9604000.0 Pa; B 0.06 m; sigma_t 60000000.0 Pa; H 1735.0 W; k 134.0 W/m/K; T_C 548.0 K; T_E 473.0 K; "
    "F_t 27140.0 N; sigma_f 50000000.0 Pa; p_w 25000.0 Pa; sigma_ring 110000000.0 Pa; sigma_c 52500000.0 Pa; "
    "C_reboring 0.002 m; V_C 3.2673e-05 m^3; A_piston 0.0028274 m^2; S 0.104 m; L_piston 0.0243 m; n_bolt 5.0 -; "
    "sigma_bolt 70000000.0 Pa; d_pinion 0.026 m; N 8000.0 1/s; nu_pinion 0.3 -; nu_gear 0.28 -; "
    "E_pinion 200000000000.0 Pa; E_gear 210000000000.0 Pa; d_force 0.043 m; d_bearing 0.086 m; sigma_b 454712500.0 Pa; "
    "l_crankpin 0.034 m; t_crankweb 0.015 m; w_crankweb 0.04082 m; Tq_max 243.6 N*m; sigma_S 833333333.3333334 Pa"
)
_UNITS = {"F_bearing": "N", "mesh_speed": "m/s", "web_stress": "Pa"}
_d, _r, _t, _u = (Symbol(k, positive=True) for k in ("d", "radius", "thickness", "angle"))

Letters = Mapping[str, Symbol]


def engine_parts(values: Mapping[str, float], data: str) -> Theory:
    """Sizes of the parts of the opposed-piston engine, each solved from its balance."""
    s = {k: Symbol(k, positive=True) for k in _PARTS}
    omega = 2 * pi * s["N"] / 60
    # the carrier turns by omega, the planet by -omega
    speed = s["d_pinion"] / 2 * (omega - -omega)
    # Hertz, a line load w on a curvature of radius rho: a = sqrt(4 w rho c/pi), p_0 = 2 w/(pi a)
    w, rho = Symbol("line_load", positive=True), Symbol("rho", positive=True)
    softness = sum((1 - s[f"nu_{m}"] ** 2) / s[f"E_{m}"] for m in ("pinion", "gear"))
    pressure = 2 * w / (pi * sqrt(4 * w * rho * softness / pi))
    expressions = {**_cylinder(s), **_crankshaft(s), **{"mesh_speed": speed, "Z_E": pressure / sqrt(w / rho)}}
    units = {k: "m" for k in expressions if k != "Z_E"} | _UNITS  # Z_E has the root of a unit
    return expressed("engine_parts", _PARTS, expressions, units, data)


def _cylinder(s: Letters) -> dict[str, Expr]:
    a, B, p, F = s["B"] / 2, s["B"], s["p"], s["F_t"]
    # a disc clamped at its edge bends to p (a^2 - r^2)^2/(64 D); the moment is largest at the edge
    bend = -sympy.diff(p * (a**2 - _r**2) ** 2 / 64, _r, 2).subs(_r, a)
    # heat that comes in evenly over the disc flows outwards through a thickness t
    drop = integrate(s["H"] * (_r / a) ** 2 / (s["k"] * 2 * pi * _r * _t), (_r, 0, a))
    # opposite to its gap a ring bears the pressure on half its circumference, per width
    ring = integrate(s["p_w"] * a * a * sin(_u), (_u, 0, pi))
    gap = s["V_C"] / s["A_piston"]
    return {
        "head_strength": sqrt(6 * sympy.Abs(bend) / s["sigma_t"]),
        "head_heat": _linear(drop - (s["T_C"] - s["T_E"]), _t),
        "rod_diameter": _positive(F - s["sigma_f"] * pi * _d**2 / 4),
        "ring_thickness": sqrt(6 * ring / s["sigma_ring"]),
        "wall_thickness": p * B / 2 / s["sigma_c"] + s["C_reboring"],
        "d_TDC": gap,
        "d_BDC": gap + 2 * (s["S"] / 2),
        # 15 % of a piston's stroke to spare at both ends
        "cylinder_length": gap + s["S"] + 2 * s["L_piston"] + 2 * sympy.Rational(15, 100) * s["S"] / 2,
        "bolt_core": _positive(p * pi * B**2 / 4 - s["n_bolt"] * s["sigma_bolt"] * pi * _d**2 / 4),
    }


def _crankshaft(s: Letters) -> dict[str, Expr]:
    load, arm = Symbol("F_bearing", positive=True), s["d_force"]
    # second moments of a round section, by strips and by rings
    half = integrate(_r**2 * sin(_u) ** 2 * _r, (_r, 0, _d / 2), (_u, 0, 2 * pi))
    polar = integrate(_r**2 * 2 * pi * _r, (_r, 0, _d / 2))
    w, t = s["w_crankweb"], s["t_crankweb"]
    web = integrate(w * _r**2, (_r, -t / 2, t / 2))
    moment = load * (arm - s["l_crankpin"] / 2 - t / 2)
    return {
        "F_bearing": s["F_t"] * arm / s["d_bearing"],
        "crankpin_diameter": _positive(s["sigma_b"] - load * arm * _d / 2 / half),
        "web_stress": moment * t / 2 / web + load / (w * t),
        "shaft_diameter": _positive(s["sigma_S"] - s["Tq_max"] * _d / 2 / polar),
    }


def _positive(balance: Expr) -> Expr:
    power = 2 if balance.has(_d**2) else 3
    return _linear(balance.subs(_d, _u ** sympy.Rational(1, power)), _u) ** sympy.Rational(1, power)


def _linear(balance: Expr, unknown: Symbol) -> Expr:
    # the numerator of the balance is linear in the unknown
    numerator = sympy.fraction(sympy.together(balance))[0]
    return -numerator.subs(unknown, 0) / sympy.diff(numerator, unknown)
