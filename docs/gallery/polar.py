"""Where a bearing is loaded

The load of the crank pin as the crank sees it: where the curve never comes, oil may enter.

From the shell: mechsym forces nunes-slider-crank --out forces
"""

from mechsym import cases, jobs

result = jobs.forces(cases.load("nunes-slider-crank"))
figure = result.plot("polar")
