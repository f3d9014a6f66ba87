"""Where friction takes its power

Guides, pins, bearings and rings by their reactions, to the first order.

From the shell: mechsym forces zotov-89
"""

from mechsym import cases, jobs

result = jobs.forces(cases.load("zotov-89"))
print(f"mechanical efficiency {100 * result.losses.mechanical_efficiency:.1f} %")
figure = result.plot("friction")
