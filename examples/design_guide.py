"""Cut the guide of a marine engine for three springs and compare them: design_guide.py [FOLDER]."""

import sys
from pathlib import Path

import numpy as np

from mechsym import cases, files, hinge, jobs
from mechsym.hinge import AirAbsolute, Coil

SPRINGS = {
    "air": AirAbsolute(A=0.031, H=1.0, p0=5e6, n=1.25),
    "stiffer air": AirAbsolute(A=0.031, H=1.0, p0=10e6, n=1.25),
    "coil": Coil(k=6e5, F0=1.5e5, H=1.0),
}


def main(folder: Path) -> None:
    case = cases.load("zotov-89")
    rollers, limits = case.need("rollers"), case.need("limits")
    wanted = hinge.torque(jobs.machine(case))

    for name, spring in SPRINGS.items():
        guide = hinge.cut(wanted, spring, case.need("guide"))
        verdict = hinge.judge(guide, rollers, limits)
        print(f"{name:12} {'can be cut' if verdict.feasible else 'cannot be built'}: {verdict.reason}")
        if guide.status == "cut":
            turn = hinge.at_angles(guide, rollers, np.linspace(0, 2 * np.pi, 721))
            x, y = hinge.parallel(turn.rho, turn.drho, turn.theta, rollers.radius)
            print("wrote", files.write_csv(folder / f"profile {name}.csv", {"x": x, "y": y}))


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "guides"))
