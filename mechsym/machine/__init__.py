"""What is ready to turn.

record    Machine: mechanism, gas, forces over the angle, load, speed
loads     laws of the load torque over the speed
"""

from mechsym.quantities import lazily

_NAMES = {
    "AngleForce": "mechsym.machine.record:AngleForce",
    "ConstantLoad": "mechsym.machine.loads:ConstantLoad",
    "Machine": "mechsym.machine.record:Machine",
    "PropellerLoad": "mechsym.machine.loads:PropellerLoad",
    "TableLoad": "mechsym.machine.loads:TableLoad",
    "load_torque": "mechsym.machine.loads:load_torque",
    "settle": "mechsym.machine.loads:settle",
}
__all__ = sorted(_NAMES)
__getattr__ = lazily(__name__, _NAMES)
