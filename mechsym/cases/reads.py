"""Which sections of a case each command reads; held to what a case records when a command runs on it (`Case.read`)."""

from mechsym.cases.facts import CaseFacts

GUIDE = ("spring", "guide", "rollers", "limits")
PARTS = ("part_piston", "part_cylinder", "part_gears", "part_crank", "part_bearings", "part_masses")


def of_gas(case: CaseFacts) -> set[str]:
    """Sections that the gas of a case is made of."""
    return {"cycle", *case.kind.needs, *case.kind.reads} if case.kind is not None else set()


def of_turn(case: CaseFacts) -> set[str]:
    """Sections that a turn at constant speed reads."""
    by_kind = {"closing", "faces"} if case.undetermined else set()
    return {"parameters", "operation", "inputs", "torque", *of_gas(case), *by_kind, "start"}


def of_friction(case: CaseFacts) -> set[str]:
    """Sections of the mean pressure of friction, which engines have."""
    if case.kind is None or case.kind.shared or case.kind.measured:
        return set()
    fitted = type(case.sections.get("friction_pressure")).__name__ == "MechanismFriction"
    return {"friction_pressure", *(("friction", "rings") if fitted else ())}


def cycle(case: CaseFacts) -> set[str]:
    """Sections that figures of the gas read, also of a record by `--diagram`."""
    measured = set() if case.shared else {"combustion", "measured"}  # also of a record by --diagram
    return of_turn(case) | of_friction(case) | measured | {"gas_limits"}


def forces(case: CaseFacts) -> set[str]:
    """Sections that forces over a turn read, or over time where `[motion]` says how a mechanism moves."""
    if case.has("motion"):
        return {"parameters", "inputs", "start", "flywheel", "motion"}
    shaft = {"simulation", "speeds"} if case.vibrates else set()
    rubs = of_friction(case) | {"friction", "rings"}
    return of_turn(case) | rubs | {"shaking", "shaft", "comparison", "gas_limits"} | shaft


def hinge(case: CaseFacts) -> set[str]:
    """Sections that a hinge, its runs and its losses read."""
    return guide(case) | {"losses", "trials", "retune", "gas_limits"}


def flywheel(case: CaseFacts) -> set[str]:
    """Sections that the motion of a loaded shaft reads."""
    return of_turn(case) | {"flywheel", "load", "drive"}


def guide(case: CaseFacts) -> set[str]:
    """Sections that a guide is cut and judged by."""
    return flywheel(case) | {*GUIDE}


def size(case: CaseFacts) -> set[str]:
    """Sections that sizes and safety factors read."""
    if not case.rules or not case.closed:
        given = case.rules == "slider crank" and case.has("part_crosshead")
        return of_turn(case) | ({"part_crosshead"} if given else set())
    parts = set() if case.rules == "slider crank" else set(PARTS)
    return of_turn(case) | of_friction(case) | parts | {"sizing", "speeds"}


def run(case: CaseFacts) -> set[str]:
    """Sections that a run in time reads whose gas hangs on the angle alone."""
    every = {"parameters", "simulation", "inputs", "start", "drive", "flywheel"}
    loaded = case.roles is None or bool(case.roles.load)
    hinge = {"spring", "guide"} if case.free == 1 and not case.twists else set()
    turned = of_turn(case) if case.has("cycle") or case.has("torque") or case.has(*hinge, "spring") else set()
    return every | turned | hinge | ({"load", "operation"} if loaded else set())


def page(case: CaseFacts) -> set[str]:
    """Sections that the page of a run reads: those of the run, and what its moving picture shows of a hinge."""
    every = run(case)
    return every | {"rollers"} if "guide" in every else every


def simulate(case: CaseFacts) -> set[str]:
    """Sections that `simulate` reads: those of a run, and of what explains it."""
    shaft = {"speeds", "shaft"} if case.vibrates else {"startup"} if case.twists else set()
    if case.in_loop:
        loop = of_turn(case) - {"closing"} | of_friction(case) | {"simulation", "load", "flywheel"}
        return loop | shaft | {"gas_limits"}
    return run(case) | shaft | ({"gas_limits"} if case.has("cycle") else set())


def identify(case: CaseFacts) -> set[str]:
    """Sections that a model for a measured run reads."""
    return {"parameters", "drive", "simulation", "flywheel", "inputs", "start"}
