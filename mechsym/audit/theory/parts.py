"""Theory of source 004, chapter 4: statics, sections and plates, from which its sizes of parts follow."""

from collections.abc import Mapping

import sympy
from sympy import Expr, Symbol, integrate, pi, sin, sqrt

from mechsym.audit.theory.conversion import tape_of
from mechsym.audit.theory.record import Letter, Theory

# values of chapter 4; w_crankweb is that of (4.33)
_LETTERS = {
    "p": Letter(unit="Pa", value=9.604e6), "B": Letter(unit="m", value=0.060), "sigma_t": Letter(unit="Pa", value=60e6),
    "H": Letter(unit="W", value=1735.0), "k": Letter(unit="W/m/K", value=134.0),
    "T_C": Letter(unit="K", value=548.0), "T_E": Letter(unit="K", value=473.0),
    "F_t": Letter(unit="N", value=27140.0), "sigma_f": Letter(unit="Pa", value=50e6),
    "p_w": Letter(unit="Pa", value=0.025e6), "sigma_ring": Letter(unit="Pa", value=110e6),
    "sigma_c": Letter(unit="Pa", value=52.5e6), "C_reboring": Letter(unit="m", value=0.002),
    "V_C": Letter(unit="m^3", value=3.2673e-5), "A_piston": Letter(unit="m^2", value=2.8274e-3),
    "S": Letter(unit="m", value=0.104), "L_piston": Letter(unit="m", value=0.0243),
    "n_bolt": Letter(unit="-", value=5.0), "sigma_bolt": Letter(unit="Pa", value=70e6),
    "d_pinion": Letter(unit="m", value=0.026), "N": Letter(unit="1/s", value=8000.0),
    "nu_pinion": Letter(unit="-", value=0.3), "nu_gear": Letter(unit="-", value=0.28),
    "E_pinion": Letter(unit="Pa", value=200e9), "E_gear": Letter(unit="Pa", value=210e9),
    "d_force": Letter(unit="m", value=0.043), "d_bearing": Letter(unit="m", value=0.086),
    "sigma_b": Letter(unit="Pa", value=454.7125e6), "l_crankpin": Letter(unit="m", value=0.034),
    "t_crankweb": Letter(unit="m", value=0.015), "w_crankweb": Letter(unit="m", value=0.04082),
    "Tq_max": Letter(unit="N*m", value=243.6), "sigma_S": Letter(unit="Pa", value=1250e6 / 1.5),
}  # fmt: skip
_UNITS = {"F_bearing": "N", "mesh_speed": "m/s", "web_stress": "Pa"}
_d, _r, _t, _u = (Symbol(k, positive=True) for k in ("d", "radius", "thickness", "angle"))

Letters = Mapping[str, Symbol]


def engine_parts(values: Mapping[str, float], data: str) -> Theory:
    """Sizes of the parts of the opposed-piston engine, each solved from its balance.

    Returns
    -------
    theory : Theory
        Thicknesses, diameters and lengths, the bearing's load, the web's stress, the gears' mesh
    """
    s = {k: Symbol(k, positive=True) for k in _LETTERS}
    expressions = {**_cylinder(s), **_crankshaft(s), **_mesh(s)}
    units = {k: "m" for k in expressions if k != "Z_E"} | _UNITS  # Z_E has the root of a unit
    return Theory(
        name="engine_parts",
        letters=_LETTERS,
        tape=tape_of(expressions),
        results=tuple(expressions),
        units=units,
        data=data,
    )


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


def _mesh(s: Letters) -> dict[str, Expr]:
    omega = 2 * pi * s["N"] / 60
    # the carrier turns by omega, the planet by -omega
    speed = s["d_pinion"] / 2 * (omega - -omega)
    # Hertz, a line load w on a curvature of radius rho: a = sqrt(4 w rho c/pi), p_0 = 2 w/(pi a)
    w, rho = Symbol("line_load", positive=True), Symbol("rho", positive=True)
    softness = sum((1 - s[f"nu_{m}"] ** 2) / s[f"E_{m}"] for m in ("pinion", "gear"))
    pressure = 2 * w / (pi * sqrt(4 * w * rho * softness / pi))
    return {"mesh_speed": speed, "Z_E": pressure / sqrt(w / rho)}


def _positive(balance: Expr) -> Expr:
    power = 2 if balance.has(_d**2) else 3
    return _linear(balance.subs(_d, _u ** sympy.Rational(1, power)), _u) ** sympy.Rational(1, power)


def _linear(balance: Expr, unknown: Symbol) -> Expr:
    # the numerator of the balance is linear in the unknown
    numerator = sympy.fraction(sympy.together(balance))[0]
    return -numerator.subs(unknown, 0) / sympy.diff(numerator, unknown)
