"""The record that the package ships for the case `generator`: simulated, marked as such.

`python tests/shipped_record.py` writes it again.
"""

from pathlib import Path

import numpy as np
from simulated_engine import DEG, Engines, whole_cycle

PATH = Path(__file__).parents[1] / "mechsym/cases/generator-synthetic.csv"
TRUE_DEAD_CENTRE = 598.3  # [deg]


def text() -> str:
    """Three cycles at part load, 3000 rpm, over the angles of an encoder; sensor with an offset of 2 bar and noise."""
    rng = np.random.default_rng(1)

    sizes = {"bore": 0.0677, "stroke": 0.055, "rod": 0.0842, "ratio": 8.5, "omega": 100 * np.pi}
    charge = {"p_closed": 0.72e5, "t_closed": 340.0, "wall": 430.0, "cv0": 2.6, "cv1": 0.8}
    losses = {"heat": 1.6, "leak": 1e-4, "evaporation": 0.02, "burn_start": -8 * DEG}
    e = Engines(
        **{name: np.full((1, 3), value) for name, value in (sizes | charge | losses).items()},
        law=np.zeros((1, 3), dtype=int),
        burn_length=np.array([[58.0, 64.0, 60.0]]) * DEG,
        burn_heat=np.array([[6.2, 5.8, 6.0]]),
    )
    phi, p = whole_cycle(e, 0.7e5, 1.05e5)
    angle = np.arange(0, 2160)
    at = np.remainder(angle - TRUE_DEAD_CENTRE + 360, 720) - 360
    number = np.minimum((angle - TRUE_DEAD_CENTRE + 360 + 720) // 720, 2).astype(int) % 3
    bar = np.array([np.interp(a * DEG, phi, p[0, k]) for a, k in zip(at, number, strict=True)]) / 1e5
    bar += 2.0 + rng.normal(0, 0.01, bar.size)
    head = [
        "# SYNTHETIC: simulated, not measured (first law, heat loss, blow-by); stands in for a record of the engine",
        "# one cylinder, four-stroke petrol, bore 67.7 mm, stroke 55 mm, rod 84.2 mm, compression ratio 8.5, 3000 rpm",
        f"# true dead centre {TRUE_DEAD_CENTRE - 360:.1f} deg (mod 360); the sensor adds 2 bar",
        "crank_angle_deg,time_s,pressure_bar",
    ]
    rows = [f"{a},{a * DEG / (100 * np.pi):.6f},{b:.3f}" for a, b in zip(angle, bar, strict=True)]
    return "\n".join([*head, *rows]) + "\n"


if __name__ == "__main__":
    PATH.write_text(text(), encoding="utf-8")
