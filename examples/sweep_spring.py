"""Find the air spring with the widest margin, over pressure and free height: sweep_spring.py [FOLDER]."""

import sys
from pathlib import Path

import numpy as np

from mechsym import sweep


def main(folder: Path) -> None:
    plan = sweep.Plan(case="zotov-89", over=("spring.p0=3..7 MPa:5", "spring.H=0.8,1.0 m"))
    found = sweep.sweep(plan)

    margin = sweep.columns(found)["guide.margin"]
    best = int(np.nanargmax(margin))
    values = ", ".join(f"{a.key} = {v:g} {a.unit}" for a, v in zip(found.axes, found.points[best], strict=True))
    print(f"{np.sum(margin > 0)} of {len(margin)} springs can be cut; widest margin {margin[best]:.3f} at {values}")

    for index, reason in sweep.failures(found).items():
        print(f"no result at {found.points[index]}: {reason}")
    print("wrote", sweep.write_table(found, folder))


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "springs"))
