"""Where friction takes its power

Guides, pins, bearings and rings by their reactions, to the first order.

From the shell: mechsym forces zotov-89
"""

from mechsym import cases, jobs

found = jobs.forces(cases.load("zotov-89"))
print(f"mechanical efficiency {100 * found.losses.mechanical_efficiency:.1f} %")
figure = found.plot("friction")
