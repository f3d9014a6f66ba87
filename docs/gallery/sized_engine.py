"""An engine sized for its loads

Each part with load, limit, factor and rule; the section shows whether they fit.

From the shell: mechsym size nunes-hypocycloid
"""

from mechsym import cases, jobs

result = jobs.size(cases.load("nunes-hypocycloid"))
print(len(result.rows), "rows,", len(result.failing), "factors too low")
figure = result.plot("section")
