"""One guide for a generator set at two loads, from its own diagrams: codesign_generator.py HALF.csv FULL.csv."""

import sys

from mechsym import cases, codesign, jobs

SAME = {"cycle.inlet_pressure": "0.6 bar"}
RIPPLE = 0.02  # assumed: flicker of lamps at four-stroke frequency asks for less, a battery charger for nothing


def main(half: str, full: str) -> None:
    points = []
    for file, changes in ((half, SAME), (full, {"cycle.inlet_pressure": "0.95 bar"})):  # full: throttle open, assumed
        machine = jobs.machine(cases.load("generator", changes), file)
        points.append(codesign.point(machine, machine.gas.pressure.mean_indicated, "constant"))
        print(f"{file}: {points[-1].load / 1e5:.2f} bar, load torque {points[-1].load_torque:.2f} N m")
    case = cases.load("generator")
    hardware = codesign.hardware(case.need("spring"), case.need("guide"), case.need("rollers"), 0.3)  # kg, assumed
    task = codesign.CoDesignTask(points=tuple(points), hardware=hardware, bounds=case.need("limits"), ripple=RIPPLE)
    bare, design = codesign.bare_flywheel(task.points, RIPPLE), codesign.solve(task)
    verified = codesign.verify(design)
    print(
        f"{design.reason}: flywheel {design.flywheel:.4f} kg m2 beside a bare {bare:.4f}; limits "
        f"{verified.broken or 'kept'}, without losses"
    )
    for k in range(len(points)):
        found = codesign.misfire(design, k)
        print(f"load {k}: p0 {design.tracks[0].p0[k] / 1e6:.3f} MPa, ripple {verified.steady_ripple[k]:.4f}, "
              f"a lost combustion: {found.outcome}")  # fmt: skip


if __name__ == "__main__":
    main(*sys.argv[1:3])
