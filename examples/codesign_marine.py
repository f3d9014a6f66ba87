"""Guide, pressures and a small flywheel for two speeds of a marine engine: codesign_marine.py [FOLDER]."""

import sys
from pathlib import Path

from mechsym import cases, codesign, files, jobs

CHANGES = {"codesign.speeds": ["89 rpm", "142 rpm"], "codesign.ripple": "1 %"}


def main(folder: Path) -> None:
    case = cases.load("zotov-89", CHANGES)
    task = jobs.codesign_task(case)
    print(f"without a hinge {codesign.bare_flywheel(task.points, task.ripple):.0f} kg m2")
    print(f"the best shape of one spring leaves {codesign.rank(task.points).swing[0]:.1f} kg m2 of swing")

    design = codesign.solve(task)
    verified = codesign.verify(design)
    can = "can be cut" if design.status == "optimal" and not verified.broken else "cannot be built"
    print(f"{can}: flywheel {design.flywheel:.0f} kg m2, ripple without losses {verified.steady_ripple.max():.4f} over "
          f"the angle, {verified.time_ripple.max():.4f} in time")  # fmt: skip
    for k, point in enumerate(task.points):
        lost = codesign.misfire(design, k)
        print(f"{point.omega * 9.549:.0f} rpm: p0 {design.tracks[0].p0[k] / 1e6:.2f} MPa, one misfire: {lost.outcome}")
    phi, path = codesign.fine_path(design.tracks[0], task.points[0].period)
    print("wrote", files.write_csv(folder / "track.csv", {"theta [rad]": phi, "rho [m]": path.rho}))


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "codesign"))
