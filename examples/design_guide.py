"""Cut the guide of a marine engine for three springs and compare them: design_guide.py [FOLDER]."""

import sys
from pathlib import Path

import numpy as np

from mechsym import cases, files
from mechsym.hinge import balance, guide, rollers, springs
from mechsym.hinge import contact as turn
from mechsym.hinge import limits as feasibility
from mechsym.hinge import torque as hinge
from mechsym.jobs import machine as assembly

SPRINGS = {
    "air": springs.AirAbsolute(A=0.031, H=1.0, p0=5e6, n=1.25),
    "stiffer air": springs.AirAbsolute(A=0.031, H=1.0, p0=10e6, n=1.25),
    "coil": springs.Coil(k=6e5, F0=1.5e5, H=1.0),
}


def main(folder: Path) -> None:
    case = cases.load("zotov-89")
    engine = assembly.assemble(case)
    wanted = hinge.build(engine.torques, engine.omega)
    part = balance.build(wanted, "whole_cycle")
    track, limits = case.need("rollers"), case.need("limits")

    for name, spring in SPRINGS.items():
        cut = guide.build(part, spring, case.need("guide"))
        verdict = feasibility.judge(cut, spring, track, limits)
        print(f"{name:12} {'can be built' if verdict.feasible else 'cannot be built'}: {verdict.reason}")
        if cut.status == "cut":
            around = turn.at_angles(cut, spring, track, np.linspace(0, 2 * np.pi, 721))
            x, y = rollers.parallel(around.rho, around.drho, around.theta, track.radius)
            print("wrote", files.write_csv(folder / f"profile {name}.csv", {"x": x, "y": y}))


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "guides"))
