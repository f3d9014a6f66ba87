"""An engine sized for its loads

Each part with load, limit, factor and rule; the section shows whether they fit.

From the shell: mechsym size nunes-hypocycloid
"""

from mechsym import cases, jobs

found = jobs.size(cases.load("nunes-hypocycloid"))
print(len(found.rows), "rows,", len(found.failing), "factors too low")
figure = found.plot("section")
