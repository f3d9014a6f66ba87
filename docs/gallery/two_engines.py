"""Slider crank against hypocycloid

At equal bore and stroke the piston of a hypocycloid stays longer near its dead centres: the torque curves cross.

From the shell: mechsym compare nunes-slider-crank nunes-hypocycloid
"""

import numpy as np

from mechsym import cases, jobs, style

omega = np.linspace(1000, 8000, 15) * np.pi / 30
names = ("nunes-slider-crank", "nunes-hypocycloid")
cycles = {name: jobs.cycle(cases.load(name), omega) for name in names}
print(jobs.compare(*cycles.values()).numbers.crossover_rpm)
figure, (axis,) = style.panels(6, 3.4, title="Mean torque of a slider crank and a hypocycloid over the speed")
for (name, one), color in zip(cycles.items(), (style.BLUE, style.RED), strict=True):
    axis.plot(one["speed_rpm"], one["torque_avg"], color=color, label=name)
axis.set(xlabel="speed [rpm]", ylabel="mean torque [N m]")
style.legend(axis)
