"""A Stirling engine turns up

Gas, two pistons and a shaft integrated together, from a start by hand; the energy balance closes.

From the shell: mechsym simulate alpha-stirling
"""

from mechsym import cases, jobs

run = jobs.run(cases.load("alpha-stirling", {"simulation.turns": 5}), check="none")
print(run.summary.end, "after", round(run.summary.t_end, 2), "s; columns:", *list(run.table())[:4])
figure = run.plot("speed")
