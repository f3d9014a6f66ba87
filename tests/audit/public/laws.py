"""The same quantities from the laws of books: loops of velocities, balances and closed forms in other letters.

One of the two truths that formulas as printed are labelled with; the other is points.py. Neither imports mechsym.
"""

from collections.abc import Mapping

import mpmath
from mpmath import mpf

State = Mapping[str, mpf]


def _loop(first: complex, second: complex, drive: complex) -> tuple[mpf, mpf]:
    # two rates along two directions that make up a third vector
    a = mpmath.matrix([[mpmath.re(first), mpmath.re(second)], [mpmath.im(first), mpmath.im(second)]])
    found = mpmath.lu_solve(a, mpmath.matrix([mpmath.re(drive), mpmath.im(drive)]))
    return found[0], found[1]


def _slider(state: State) -> dict[str, mpf]:
    # s = r e^(i phi) + l e^(-i beta), differentiated twice
    r, l, phi, w, e = (state[k] for k in ("r", "l", "phi", "phid", "phidd"))  # noqa: E741
    beta = mpmath.asin(r * mpmath.sin(phi) / l)
    s = l * mpmath.sin(phi + beta) / mpmath.sin(phi)  # law of sines
    crank, rod = r * mpmath.expj(phi), l * mpmath.expj(-beta)
    s_p, beta_p = _loop(mpf(1), 1j * rod, 1j * crank)
    s_pp, beta_pp = _loop(mpf(1), 1j * rod, -crank - rod * beta_p**2)
    return {
        "s": s, "beta": beta, "ds_dphi": s_p, "d2s_dphi2": s_pp, "s_d": s_p * w, "s_dd": s_pp * w**2 + s_p * e,
        "beta_d": beta_p * w, "beta_dd": beta_pp * w**2 + beta_p * e,
    }  # fmt: skip


def cylinder_volume(state: State) -> dict[str, mpf]:
    """Heywood's volume in the ratio of the rod to the crank."""
    found = _slider(state)
    B, r, l, r_c, phi = (state[k] for k in ("B", "r", "l", "r_c", "phi"))  # noqa: E741
    n, area = l / r, mpmath.pi * B**2 / 4
    swept = 2 * r * area
    V = swept / (r_c - 1) * (1 + (r_c - 1) / 2 * (n + 1 - mpmath.cos(phi) - mpmath.sqrt(n**2 - mpmath.sin(phi) ** 2)))
    slope = swept / 2 * mpmath.sin(phi) * (1 + mpmath.cos(phi) / mpmath.sqrt(n**2 - mpmath.sin(phi) ** 2))
    x = 2 * r * mpmath.sin(phi / 2) ** 2 + 2 * l * mpmath.sin(found["beta"] / 2) ** 2
    return {
        **found, "x": x, "velocity": -found["s_d"], "A_piston": area, "V_d": swept, "V_c": swept / (r_c - 1), "V": V,
        "dV_dphi": slope, "V_rate": slope * state["phid"], "wall": 2 * area + 4 * V / B,
    }  # fmt: skip


def slider_crank(state: State) -> dict[str, mpf]:
    """Forces by virtual work of the rod's two components."""
    found = _slider(state)
    piston = -found["s_dd"]
    total = state["F"] - state["m"] * piston
    torque = -total * found["ds_dphi"]
    # the rod's pull on the crank pin has the arm r sin(phi + beta)
    rod = torque / (state["r"] * mpmath.sin(state["phi"] + found["beta"]))
    return {
        **found, "piston_acceleration": piston, "inertia_force": -state["m"] * piston, "total_force": total,
        "rod_force": rod, "normal_force": rod * mpmath.sin(found["beta"]),
    }  # fmt: skip


def four_bar(state: State) -> dict[str, mpf]:
    """Freudenstein's equation in the half angle, and the loop of velocities."""
    a, b, c, d, t2 = (state[k] for k in ("a", "b", "c", "d0", "alpha"))
    K1, K2, K3 = d / a, d / c, (a**2 - b**2 + c**2 + d**2) / (2 * a * c)
    A = mpmath.cos(t2) - K1 - K2 * mpmath.cos(t2) + K3
    B, C = -2 * mpmath.sin(t2), K1 - (K2 + 1) * mpmath.cos(t2) + K3
    gamma = 2 * mpmath.atan((-B - mpmath.sqrt(B**2 - 4 * A * C)) / (2 * A))
    end = d + c * mpmath.expj(gamma) - a * mpmath.expj(t2)
    crank, coupler, rocker = a * mpmath.expj(t2), end, c * mpmath.expj(gamma)
    w3, w4 = _loop(-1j * coupler, 1j * rocker, 1j * crank * state["alphad"])
    diagonal = mpmath.sqrt(a**2 + d**2 - 2 * a * d * mpmath.cos(t2))
    return {
        "gamma": gamma, "beta": mpmath.arg(end), "coupler_speed": w3, "rocker_speed": w4, "diagonal": diagonal,
        "transmission": 2 * mpmath.atan(mpmath.sqrt((diagonal**2 - (b - c) ** 2) / ((b + c) ** 2 - diagonal**2))),
    }  # fmt: skip


def scotch_yoke(state: State) -> dict[str, mpf]:
    """A harmonic motion."""
    r, phi, w, e = (state[k] for k in ("r", "phi", "phid", "phidd"))
    return {
        "from_centre": r * mpmath.cos(phi), "from_centre_d": -r * w * mpmath.sin(phi),
        "from_centre_dd": -r * w**2 * mpmath.cos(phi) - r * e * mpmath.sin(phi), "x": 2 * r * mpmath.sin(phi / 2) ** 2,
    }  # fmt: skip


def trochoid(state: State) -> dict[str, mpf]:
    """The wheel's spin from the speed of its point on the ring, which rests."""
    R, q, b, phi = (state[k] for k in ("R", "q", "b", "phi"))
    spin = mpmath.findroot(lambda w: (R - q) + w * q, -1)
    return {
        "x": (R - q) * mpmath.cos(phi) + b * mpmath.cos(spin * phi),
        "y": (R - q) * mpmath.sin(phi) + b * mpmath.sin(spin * phi),
    }  # fmt: skip


def wiebe(state: State) -> dict[str, mpf]:
    """Wiebe's closed forms."""
    z = (state["theta"] - state["theta_s"]) / state["duration"]
    a, m = state["a"], state["m"]
    left = mpmath.exp(-a * z ** (m + 1))
    rate = a * (m + 1) / state["duration"] * z**m * left
    return {"burned": 1 - left, "burn_rate": rate, "heat_release_rate": state["Q"] * rate}


def air_cycles(state: State) -> dict[str, mpf]:
    """Closed forms of the books."""
    g, r, T_1, c_v, alpha, beta = (state[k] for k in ("gamma", "r_c", "T_1", "c_v", "alpha", "beta"))
    T_2 = T_1 * r ** (g - 1)
    T_5 = T_1 * alpha * beta**g
    return {
        "T_2": T_2, "T_4": alpha * beta * T_2, "T_5": T_5, "p_2": state["p_1"] * r**g,
        "p_3": alpha * state["p_1"] * r**g, "q_in": c_v * T_2 * (alpha - 1 + g * alpha * (beta - 1)),
        "q_out": c_v * (T_5 - T_1), "eta_otto": 1 - r ** (1 - g),
        "eta_diesel": 1 - r ** (1 - g) * (beta**g - 1) / (g * (beta - 1)),
    }  # fmt: skip


def nozzle(state: State) -> dict[str, mpf]:
    """Flow by the Mach number."""
    g, R, p_0, T_0 = (state[k] for k in ("gamma", "R", "p_0", "T_0"))
    M = mpmath.sqrt(2 / (g - 1) * (state["x"] ** (-(g - 1) / g) - 1))
    T = T_0 / (1 + (g - 1) / 2 * M**2)
    speed, rho = M * mpmath.sqrt(g * R * T), state["x"] * p_0 / (R * T)
    area = state["C_d"] * state["A"]
    sonic = T_0 * 2 / (g + 1)
    return {
        "mach": M, "T_throat": T, "velocity": speed, "density": rho, "mass_flow": area * rho * speed,
        "critical_ratio": (sonic / T_0) ** (g / (g - 1)),
        "choked_flow": area * p_0 / (R * T_0) * (sonic / T_0) ** (1 / (g - 1)) * mpmath.sqrt(g * R * sonic),
    }  # fmt: skip


def helical_spring(state: State) -> dict[str, mpf]:
    """The formulas of the books in the spring's index."""
    d, D, n, G, F = (state[k] for k in ("d", "D", "n", "G", "F"))
    C = D / d
    rate, wahl = G * d / (8 * C**3 * n), (4 * C - 1) / (4 * C - 4) + mpf("0.615") / C
    return {
        "index": C, "rate": rate, "deflection": F / rate, "wahl": wahl, "stress": wahl * 8 * F * C / (mpmath.pi * d**2),
        "mass": mpmath.pi**2 / 4 * C * d**3 * n * state["rho"],
    }  # fmt: skip


def strength(state: State) -> dict[str, mpf]:
    """Lame and Hertz in the ratio of the radii and in compliances."""
    k = (state["r_o"] / state["r_i"]) ** 2
    E = 1 / ((1 - state["nu_1"] ** 2) / state["E_1"] + (1 - state["nu_2"] ** 2) / state["E_2"])
    R = state["R_1"] * state["R_2"] / (state["R_1"] + state["R_2"])
    peak = mpmath.sqrt(state["F"] * E / (mpmath.pi * state["L"] * R))
    return {
        "hoop_inside": state["p"] * (k + 1) / (k - 1), "axial": state["p"] / (k - 1), "R_star": R, "E_star": E,
        "contact_pressure": peak, "half_width": 2 * peak * R / E,
    }  # fmt: skip


def epicyclic(state: State) -> dict[str, mpf]:
    """Willis: seen from the carrier the train is a plain one."""
    s, p, w_s, w_c = (state[k] for k in ("z_s", "z_p", "w_s", "w_c"))
    ring = s + 2 * p
    return {
        "z_r": ring, "w_r": w_c - (w_s - w_c) * s / ring, "w_p": w_c - (w_s - w_c) * s / p,
        "ratio_fixed_ring": (s + ring) / s, "ratio_fixed_sun": (s + ring) / ring, "ratio_fixed_carrier": -ring / s,
        "centre_distance": state["module"] * (s + ring) / 4,
    }  # fmt: skip
