"""Torque and power of a small engine over its speed

The closed period is integrated at each speed; gas exchange and friction are told apart from it.

From the shell: mechsym cycle nunes-slider-crank --speeds 1000:8000:1000
"""

import numpy as np

from mechsym import cases, jobs

result = jobs.cycle(cases.load("nunes-slider-crank"), np.linspace(1000, 8000, 8) * np.pi / 30)
print(result.table())
figure = result.plot("speeds")
