"""Where the programme starts: the exact guide of the middle point, and pressures by the ratio of the works."""

import numpy as np

from mechsym.codesign.hardware import Hardware
from mechsym.codesign.points import Samples
from mechsym.codesign.task import CoDesignTask
from mechsym.hinge.setting import setting_of

_SECOND = (0.15, 0.05)  # closing of a second spring at the start and its swing, by the height of its column
_DEEPEST = 0.98  # share of the allowed closing that the start may take


def closing(hardware: Hardware, energy: np.ndarray, p0: float, deepest: float) -> np.ndarray:
    """Closing [m], at most `deepest`, at which a spring of pressure p0 [Pa] stores an energy [J]."""
    z = np.linspace(0, deepest, 4001)
    return np.interp(energy, hardware.charged(p0).energy(z), z)


def middle(samples: Samples) -> int:
    """The point whose wanted work has the middle swing."""
    order = np.argsort(np.ptp(samples.work, axis=1))
    return int(order[(len(order) - 1) // 2])


def start_pressures(task: CoDesignTask, samples: Samples) -> list[np.ndarray]:
    """Excess pressures for each spring and point [Pa]: in proportion to the swing of the work."""
    swing = np.ptp(samples.work, axis=1)
    p0 = setting_of(task.hardware.spring) * swing / swing[middle(samples)]
    return [p0 if s == 0 else p0 / 4 for s in range(task.springs)]


def shapes(task: CoDesignTask, samples: Samples) -> list[np.ndarray]:
    """Closing of each spring over the angles [m]."""
    hardware, work = task.hardware, samples.work[middle(samples)]
    spring = hardware.spring
    deepest = _DEEPEST * task.bounds.closing_share * spring.H
    first = closing(hardware, float(spring.energy(hardware.z_margin)) + work.max() - work, setting_of(spring), deepest)
    mean, swing = _SECOND
    turn = 2 * np.pi / (samples.phi[-1] + samples.step[-1])
    others = [spring.H * (mean + swing * np.cos((s + 1) * turn * samples.phi)) for s in range(task.springs - 1)]
    return [first, *others]
