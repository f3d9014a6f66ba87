"""The loop of a case: its engine on its mechanism against its load."""

import math

from mechsym import mechanisms
from mechsym.cases import Case
from mechsym.cycle.closed.performance import performance
from mechsym.errors import BadInput
from mechsym.jobs.cycle import engine
from mechsym.jobs.gas import one_cylinder
from mechsym.machine.loads import ConstantLoad, Load, PropellerLoad, TableLoad, settle
from mechsym.mechanisms.crank_train.firing import refuse_wrong_firing
from mechsym.mechanisms.crank_train.parameters import CrankTrainParameters
from mechsym.mechanisms.record import Mechanism
from mechsym.simulate.loop.system import Loop, LoopCylinder

_LOAD_INPUTS = ("M_r", "M")


def loop(case: Case) -> Loop:
    """The loop that a case describes.

    Parameters
    ----------
    case : Case
        With a spark-ignition cycle and a mechanism with pistons; of opposed pistons that share a chamber one mechanism
        is followed, which carries its share of the load; without `[load]` a propeller takes the mean torque

    Raises
    ------
    BadInput
        No spark-ignition cycle, a table as load, or cylinders that fire far from their dead centre
    """
    machine, mechanism = engine(one_cylinder(case)), mechanisms.build(case.mechanism, case.need("parameters"))
    omega = case.need("operation").speed
    cylinders = _cylinders(case, mechanism)
    load = case.sections.get("load", PropellerLoad())
    # the figures of a chamber count all its pistons, each of which drives a mechanism of its own
    torque = float(performance(machine, {"omega": omega}).torque_avg[0]) * len(cylinders) / machine.chamber.pistons
    return Loop(
        engine=machine,
        mechanism=mechanism,
        cylinders=cylinders,
        load=_smooth(case, settle(load, torque, omega)),
        load_input=next(name for name in _LOAD_INPUTS if name in mechanism.inputs),
        load_coordinate=mechanism.coordinates[-1],
    )


def _smooth(case: Case, load: Load) -> ConstantLoad | PropellerLoad:
    if isinstance(load, TableLoad):
        raise BadInput(f"{case.file}: the cycle in the loop takes a constant or a propeller load, no table")
    return load


def _cylinders(case: Case, mechanism: Mechanism) -> tuple[LoopCylinder, ...]:
    parameters = case.need("parameters")
    if not isinstance(parameters, CrankTrainParameters):
        return (LoopCylinder(input="F", coordinate=mechanism.coordinates[0], firing=0.0),)
    refuse_wrong_firing(parameters, 4 * math.pi)
    firing = parameters.firing if isinstance(parameters.firing, tuple) else (parameters.firing,) * len(parameters.throw)
    return tuple(
        LoopCylinder(input=f"F{i}", coordinate=mechanism.coordinates[throw - 1], firing=float(angle) % (4 * math.pi))
        for i, (throw, angle) in enumerate(zip(parameters.throw, firing, strict=True), 1)
    )
