"""A reciprocating compressor on a motor, held below a current pulsation of 40 % (API 618): codesign_compressor.py."""

import numpy as np

from mechsym import codesign, hinge

BORE, STROKE, CLEARANCE, N = 0.3, 0.25, 0.12, 1.35  # one single-acting cylinder, all assumed
SUCTION = (1.0e5, 2.0e5)  # two suction pressures of the plant [Pa]
DELIVERY, SPEED, SLIP, PULSATION = 6e5, 735 * np.pi / 30, 0.02, 0.40
# the current of an induction motor follows its slip, so 40 % of it is 0.4 of the slip in speed
RIPPLE = PULSATION * SLIP


def torque(suction: float, phi: np.ndarray) -> np.ndarray:
    """Torque of the gas on the shaft [N m]: suction, compression, delivery, expansion of what stays [suction in Pa]."""
    area, r = np.pi / 4 * BORE**2, STROKE / 2
    x = r * (1 - np.cos(phi)) + CLEARANCE * STROKE  # from the head
    out = np.sin(phi) >= 0  # away from the head
    full, least = STROKE * (1 + CLEARANCE), STROKE * CLEARANCE
    pressure = np.where(out, np.maximum(DELIVERY * (least / x) ** N, suction),
                        np.minimum(suction * (full / x) ** N, DELIVERY))  # fmt: skip
    return (pressure - 1.013e5) * area * r * np.sin(phi)


def main() -> None:
    phi = np.arange(720) * np.pi / 360
    points = tuple(codesign.from_curve(phi, torque(p, phi), 6.0, SPEED) for p in SUCTION)
    spring = hinge.AirAbsolute(A=0.004, H=0.25, n=1.4, p0=3e6)
    hardware = codesign.Hardware(spring=spring, rho0=0.25, radius=0.04, width=0.04, moving_mass=4.0)
    limits = hinge.Limits(spring_pressure=25e6, closing_share=0.9, pressure_angle=0.52, profile_radius=2e-3,
                          roller_reaction=60e3, hertz_stress=1.5e9)  # fmt: skip
    task = codesign.CoDesignTask(points=points, hardware=hardware, bounds=limits, ripple=RIPPLE)
    design, bare = codesign.solve(task), codesign.bare_flywheel(points, RIPPLE)
    print(f"{design.status}: flywheel {design.flywheel:.2f} kg m2 for {PULSATION:.0%} of current, bare {bare:.2f}")


if __name__ == "__main__":
    main()
