"""Quantities of one line each: both truths of them, side by side.

Neither imports mechsym. What is an empirical law (Woschni, Hohenberg) has its source for a truth, in two units.
"""

from collections.abc import Mapping

import mpmath
from mpmath import mpf

State = Mapping[str, mpf]
Both = tuple[dict[str, mpf], dict[str, mpf]]


def piston_speed(state: State) -> Both:
    """Mean speed: the way of a turn over its time, and the mean of a harmonic motion."""
    turn = 2 * mpmath.pi / state["omega"]
    harmonic = mpmath.quad(lambda a: abs(state["stroke"] / 2 * state["omega"] * mpmath.sin(a)), [0, mpmath.pi])
    speed = {"speed": 1 / turn}
    return {"mean_piston_speed": 2 * state["stroke"] / turn, **speed}, {
        "mean_piston_speed": harmonic / mpmath.pi, **speed,
    }  # fmt: skip


def flywheel(state: State) -> Both:
    """Inertia for two per cent: from the swing of the energy, and from the speeds at its ends."""
    T, n, w = (state[k] for k in ("T_a", "n", "w"))
    swing = mpmath.quad(lambda a: T * mpmath.cos(n * a), [-mpmath.pi / (2 * n), mpmath.pi / (2 * n)])
    fast, slow = w * mpf("1.01"), w * mpf("0.99")
    other = 2 * T / n
    return {"needed": swing / (w**2 / 50), "swing": swing}, {"needed": 2 * other / (fast**2 - slow**2), "swing": other}


def inline_balance(state: State) -> Both:
    """Force of one cylinder to the second order, outwards: from a motion, and from its two harmonics."""
    m, r, lam, phi, w = (state[k] for k in ("m", "r", "lam", "phi", "phid"))

    def place(t: mpf) -> mpf:
        a = phi + w * t
        return r * (mpmath.cos(a) - lam / 2 * mpmath.sin(a) ** 2)

    pair = m * r * w**2 * mpmath.re(mpmath.expj(phi) + lam * mpmath.expj(2 * phi))
    return {"single": -m * mpmath.diff(place, 0, 2)}, {"single": pair}


def knife_cam(state: State) -> Both:
    """Harmonic lift of a cam over half a turn."""
    h, phi = state["h"], state["phi"]
    lift = mpmath.quad(lambda a: h / 2 * mpmath.sin(a), [0, phi])
    slope = mpmath.diff(lambda a: h * mpmath.sin(a / 2) ** 2, phi)
    return {"s": lift, "ds_dphi": slope}, {
        "s": h * mpmath.sin(phi / 2) ** 2, "ds_dphi": h * mpmath.sin(phi / 2) * mpmath.cos(phi / 2),
    }  # fmt: skip


def schmidt_alpha(state: State) -> Both:
    """Harmonic volumes of two cylinders: by the piston's way, and by half angles."""
    phi, dx = state["phi"], state["dx"]

    def volume(swept: mpf, dead: mpf, angle: mpf) -> tuple[mpf, mpf]:
        way = mpmath.quad(lambda a: swept / 2 * mpmath.sin(a), [0, angle])
        return dead + way, dead + swept * mpmath.sin(angle / 2) ** 2

    E, C = volume(state["V_SE"], state["V_DE"], phi), volume(state["V_SC"], state["V_DC"], phi - dx)
    return {"V_E": E[0], "V_C": C[0]}, {"V_E": E[1], "V_C": C[1]}


def heat_transfer(state: State) -> Both:
    """Woschni's and Hohenberg's laws, with pressures in kPa and bar, and by logarithms in SI."""
    B, p, T, V = (state[k] for k in ("B", "p", "T", "V"))
    S_p = 2 * state["S"] * state["speed"]
    lift = state["V_d"] * state["T_r"] / (state["p_r"] * state["V_r"]) * (p - state["p_m"])
    w = state["C_1"] * S_p + state["C_2"] * lift
    ln = mpmath.log
    woschni = mpmath.exp(ln(mpf("3.26")) - ln(B) / 5 + (ln(p) - 3 * ln(10) + ln(w)) * mpf("0.8") - mpf("0.55") * ln(T))
    hohenberg = mpmath.exp(
        ln(130) - mpf("0.06") * ln(V) + mpf("0.8") * (ln(p) - 5 * ln(10) + ln(S_p + mpf("1.4"))) - mpf("0.4") * ln(T)
    )
    plain = mpf("3.26") * (p / 1000 * w) ** mpf("0.8") / (B ** mpf("0.2") * T ** mpf("0.55"))
    first = {
        "w": w, "S_p": S_p, "woschni": plain,
        "hohenberg": 130 * (p / 100000 * (S_p + mpf("1.4"))) ** mpf("0.8") / (V ** mpf("0.06") * T ** mpf("0.4")),
    }  # fmt: skip
    return first, {"w": w, "S_p": S_p, "woschni": woschni, "hohenberg": hohenberg}
