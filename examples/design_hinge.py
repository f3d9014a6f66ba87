"""Design the elastic hinge of a marine engine with a stiffer spring, and write the report: design_hinge.py [FOLDER]."""

import sys
from pathlib import Path

from mechsym import cases, jobs
from mechsym.hinge import shown


def main(folder: Path) -> None:
    case = cases.load("zotov-89", {"spring.p0": "8 MPa"})
    found = jobs.hinge(case)

    hinge, verdict = found.hinge, found.verdict
    print(f"load torque        {hinge.load_torque:.0f} N*m")
    print(f"hinge torque       {hinge.torque_min:.0f} to {hinge.torque_max:.0f} N*m")
    print(f"{found.answer}; {verdict.reason}")
    for trial in found.trials:
        ripple = "stops" if trial.speed_ripple is None else f"speed ripple {trial.speed_ripple:.2g}"
        print(f"{trial.about:40} {ripple}")
    print(f"an ideal hinge saves {found.flywheels.steady.inertia:.0f} kg*m^2")

    files = shown.write(found, folder)
    print(f"open {files[0]}")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "hinge-report"))
