"""Quantities from the places of points and from integrals: derivatives are differences, nothing is solved in symbols.

One of the two truths that formulas as printed are labelled with; the other is laws.py. Neither imports mechsym.
"""

from collections.abc import Callable, Mapping

import mpmath
from mpmath import mpf

State = Mapping[str, mpf]


def _in_time(place: Callable[[mpf], mpf], state: State, angle: str = "phi") -> dict[str, mpf]:
    start, speed, rate = state[angle], state[f"{angle}d"], state[f"{angle}dd"]

    def at(t: mpf) -> mpf:
        return place(start + speed * t + rate * t**2 / 2)

    return {
        "": place(start), "_d": mpmath.diff(at, 0), "_dd": mpmath.diff(at, 0, 2), "_p": mpmath.diff(place, start),
        "_pp": mpmath.diff(place, start, 2),
    }  # fmt: skip


def _pin(state: State, angle: mpf) -> mpf:
    # where a circle about the crank pin meets the cylinder's axis, farther from the crank
    r, l = state["r"], state["l"]  # noqa: E741
    return mpmath.findroot(lambda s: (s - r * mpmath.cos(angle)) ** 2 + (r * mpmath.sin(angle)) ** 2 - l**2, r + l)


def cylinder_volume(state: State) -> dict[str, mpf]:
    """Piston, volume and wall of a cylinder."""
    s = _in_time(lambda angle: _pin(state, angle), state)
    half = state["B"] / 2
    area = 4 * mpmath.quad(lambda a: half**2 * mpmath.cos(a) ** 2, [0, mpmath.pi / 2])
    swept = area * (_pin(state, mpf(0)) - _pin(state, mpmath.pi))
    clearance = mpmath.findroot(lambda v: (swept + v) - state["r_c"] * v, swept / 10)
    x = _pin(state, mpf(0)) - s[""]
    height = x + clearance / area
    return {
        "s": s[""], "s_d": s["_d"], "s_dd": s["_dd"], "ds_dphi": s["_p"], "d2s_dphi2": s["_pp"], "x": x,
        "velocity": -s["_d"], "A_piston": area, "V_d": swept, "V_c": clearance, "V": clearance + area * x,
        "V_rate": -area * s["_d"], "dV_dphi": -area * s["_p"], "wall": 2 * area + 4 * area / state["B"] * height,
    }  # fmt: skip


def slider_crank(state: State) -> dict[str, mpf]:
    """Rod and forces of a slider crank without mass of the rod; the piston's forces from its equilibrium."""

    def rod(angle: mpf) -> mpf:
        return mpmath.atan2(state["r"] * mpmath.sin(angle), _pin(state, angle) - state["r"] * mpmath.cos(angle))

    beta = _in_time(rod, state)
    piston = -_in_time(lambda angle: _pin(state, angle), state)["_dd"]
    total = state["F"] - state["m"] * piston
    # rod in compression and guide on the piston: along the axis and across it
    along = mpmath.matrix([[mpmath.cos(beta[""]), 0], [-mpmath.sin(beta[""]), 1]])
    rod_force, guide = mpmath.lu_solve(along, mpmath.matrix([total, 0]))
    return {
        "beta": beta[""], "beta_d": beta["_d"], "beta_dd": beta["_dd"], "piston_acceleration": piston,
        "inertia_force": -state["m"] * piston, "total_force": total, "rod_force": rod_force, "normal_force": guide,
    }  # fmt: skip


def _meeting(state: State, angle: mpf) -> tuple[mpf, mpf]:
    # the point that is b from the crank pin and c from the rocker's pivot
    a, b, c, d0 = (state[k] for k in ("a", "b", "c", "d0"))
    x, y = a * mpmath.cos(angle), a * mpmath.sin(angle)
    gap = mpmath.hypot(d0 - x, y)
    along = (b**2 - c**2 + gap**2) / (2 * gap)
    across = mpmath.sqrt(b**2 - along**2)
    ex, ey = (d0 - x) / gap, -y / gap
    return x + along * ex - across * ey, y + along * ey + across * ex


def four_bar(state: State) -> dict[str, mpf]:
    """Angles of a four-bar from where its circles meet, speeds by differences."""
    a, d0 = state["a"], state["d0"]

    def rocker(angle: mpf) -> mpf:
        x, y = _meeting(state, angle)
        return mpmath.atan2(y, x - d0)

    def coupler(angle: mpf) -> mpf:
        x, y = _meeting(state, angle)
        return mpmath.atan2(y - a * mpmath.sin(angle), x - a * mpmath.cos(angle))

    gamma, beta = _in_time(rocker, state, "alpha"), _in_time(coupler, state, "alpha")
    return {
        "gamma": gamma[""], "beta": beta[""], "rocker_speed": gamma["_d"], "coupler_speed": beta["_d"],
        "diagonal": mpmath.hypot(d0 - a * mpmath.cos(state["alpha"]), a * mpmath.sin(state["alpha"])),
        "transmission": gamma[""] - beta[""],
    }  # fmt: skip


def scotch_yoke(state: State) -> dict[str, mpf]:
    """A yoke on a crank pin."""
    pin = _in_time(lambda angle: mpmath.re(state["r"] * mpmath.expj(angle)), state)
    return {"from_centre": pin[""], "from_centre_d": pin["_d"], "from_centre_dd": pin["_dd"], "x": state["r"] - pin[""]}


def trochoid(state: State) -> dict[str, mpf]:
    """A point of a wheel that rolls in a ring: the wheel's turn is the length that it has rolled."""
    R, q, b, phi = (state[k] for k in ("R", "q", "b", "phi"))
    rolled = mpmath.quad(lambda _: R - q, [0, phi])
    point = (R - q) * mpmath.expj(phi) + b * mpmath.expj(-rolled / q)
    return {"x": mpmath.re(point), "y": mpmath.im(point)}


def wiebe(state: State) -> dict[str, mpf]:
    """Burned fraction from its rate law, dy/(1 - y) = a d(z^(m + 1)), and its rate by differences."""
    start, duration, a, m = (state[k] for k in ("theta_s", "duration", "a", "m"))

    def burned(angle: mpf) -> mpf:
        end = (angle - start) / duration
        return 1 - mpmath.exp(-mpmath.quad(lambda z: a * (m + 1) * z**m, [0, end]))

    rate = mpmath.diff(burned, state["theta"])
    return {"burned": burned(state["theta"]), "burn_rate": rate, "heat_release_rate": state["Q"] * rate}


def air_cycles(state: State) -> dict[str, mpf]:
    """States of the mixed cycle, its adiabats by integrals of the work of a gas; efficiency from the heats."""
    gamma, volume, c_v = state["gamma"], state["r_c"], state["c_v"]

    def adiabat(T: mpf, first: mpf, last: mpf) -> mpf:
        return T * mpmath.exp(mpmath.quad(lambda v: -(gamma - 1) / v, [first, last]))

    def turn(alpha: mpf, beta: mpf) -> dict[str, mpf]:
        T_2 = adiabat(state["T_1"], volume, mpf(1))
        T_4 = beta * alpha * T_2
        T_5 = adiabat(T_4, beta, volume)
        heat = c_v * (alpha * T_2 - T_2) + gamma * c_v * (T_4 - alpha * T_2)
        out = c_v * (T_5 - state["T_1"])
        return {"T_2": T_2, "T_4": T_4, "T_5": T_5, "q_in": heat, "q_out": out, "eta": 1 - out / heat}

    found = turn(state["alpha"], state["beta"])
    p_2 = state["p_1"] * volume * found["T_2"] / state["T_1"]
    return {
        **found, "p_2": p_2, "p_3": state["alpha"] * p_2, "eta_otto": turn(mpf(2), mpf(1))["eta"],
        "eta_diesel": turn(mpf(1), state["beta"])["eta"],
    }  # fmt: skip


def nozzle(state: State) -> dict[str, mpf]:
    """Isentropic flow by the integral of dp/rho; choked where the flow is largest."""
    gamma, R, p_0, T_0 = (state[k] for k in ("gamma", "R", "p_0", "T_0"))

    def flow(x: mpf) -> tuple[mpf, mpf, mpf]:
        rho = p_0 / (R * T_0) * x ** (1 / gamma)
        work = mpmath.quad(lambda y: p_0 / (p_0 / (R * T_0) * y ** (1 / gamma)), [x, 1])
        return rho, mpmath.sqrt(2 * work), rho * mpmath.sqrt(2 * work)

    rho, speed, flux = flow(state["x"])
    T = state["x"] * p_0 / (rho * R)
    best = mpmath.findroot(lambda x: mpmath.diff(lambda y: flow(y)[2] ** 2, x), mpf("0.53"))
    area = state["C_d"] * state["A"]
    return {
        "velocity": speed, "density": rho, "T_throat": T, "mass_flow": area * flux, "critical_ratio": best,
        "choked_flow": area * flow(best)[2], "mach": speed / mpmath.sqrt(gamma * R * T),
    }  # fmt: skip


def helical_spring(state: State) -> dict[str, mpf]:
    """Wire of a spring as a twisted bar: its energy along the wire gives the rate."""
    d, D, n, G, F = (state[k] for k in ("d", "D", "n", "G", "F"))
    polar = 2 * mpmath.pi * mpmath.quad(lambda a: a**3, [0, d / 2])
    energy = mpmath.quad(lambda _: (F * D / 2) ** 2 / (2 * G * polar) * D / 2, [0, 2 * mpmath.pi * n])
    shear = F * D / 2 * d / 2 / polar
    index = D / d
    wahl = (index - mpf(1) / 4) / (index - 1) + mpf("0.615") / index
    volume = mpmath.quad(lambda _: mpmath.pi * (d / 2) ** 2 * D / 2, [0, 2 * mpmath.pi * n])
    return {
        "rate": F**2 / (2 * energy), "deflection": 2 * energy / F, "index": index, "wahl": wahl,
        "stress": wahl * shear, "mass": volume * state["rho"],
    }  # fmt: skip


def strength(state: State) -> dict[str, mpf]:
    """A thick wall from its equation of equilibrium, Hertz's line contact from its integral equation at two places."""
    p, r_i, r_o = (state[k] for k in ("p", "r_i", "r_o"))
    wall = mpmath.matrix([[1, -1 / r_i**2], [1, -1 / r_o**2]])
    A, B = mpmath.lu_solve(wall, mpmath.matrix([-p, 0]))
    R = 1 / (1 / state["R_1"] + 1 / state["R_2"])
    E = 1 / ((1 - state["nu_1"] ** 2) / state["E_1"] + (1 - state["nu_2"] ** 2) / state["E_2"])
    load = state["F"] / state["L"]

    # slope of the two surfaces under a half ellipse of pressure, x/R at the edge, and its load
    def misfit(half: mpf) -> mpf:
        peak = load / mpmath.quad(lambda a: half * mpmath.cos(a) ** 2, [-mpmath.pi / 2, mpmath.pi / 2])
        near = mpmath.quad(lambda t: peak * mpmath.sin(t) ** 2 / (2 * mpmath.sin(t / 2) ** 2), [0, mpmath.pi])
        return 2 / (mpmath.pi * E) * near - half / R

    half = mpmath.findroot(misfit, mpmath.sqrt(load * R / E))
    return {
        "hoop_inside": A + B / r_i**2, "axial": A, "R_star": R, "E_star": E, "half_width": half,
        "contact_pressure": load / mpmath.quad(lambda a: half * mpmath.cos(a) ** 2, [-mpmath.pi / 2, mpmath.pi / 2]),
    }  # fmt: skip


def epicyclic(state: State) -> dict[str, mpf]:
    """Speeds of a planetary gear from the speed of the points where its wheels touch."""
    sun, planet = state["module"] * state["z_s"] / 2, state["module"] * state["z_p"] / 2
    ring = sun + 2 * planet

    def speeds(w_s: mpf, w_c: mpf) -> tuple[mpf, mpf]:
        # the planet's centre moves with the carrier, its inner point with the sun, its outer point with the ring
        centre, inner = w_c * (sun + planet), w_s * sun
        return (2 * centre - inner) / ring, (centre - inner) / planet

    w_r, w_p = speeds(state["w_s"], state["w_c"])
    still = mpmath.findroot(lambda w: speeds(w, mpf(1))[0], 3)
    return {
        "z_r": 2 * ring / state["module"], "w_r": w_r, "w_p": w_p, "ratio_fixed_ring": still,
        "ratio_fixed_sun": speeds(mpf(0), mpf(1))[0], "ratio_fixed_carrier": 1 / speeds(mpf(1), mpf(0))[0],
        "centre_distance": sun + planet,
    }  # fmt: skip
