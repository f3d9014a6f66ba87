"""What is ready to turn.

record    Machine: mechanism, gas, forces over the angle, load, speed
loads     laws of the load torque over the speed
"""

from mechsym.machine.loads import ConstantLoad, PropellerLoad, TableLoad, load_torque, settle
from mechsym.machine.record import AngleForce, Machine

__all__ = ["AngleForce", "ConstantLoad", "Machine", "PropellerLoad", "TableLoad", "load_torque", "settle"]


def __dir__() -> list[str]:
    return __all__
