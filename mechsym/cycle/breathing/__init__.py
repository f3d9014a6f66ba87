"""Gas exchange of a four-stroke cylinder by filling and emptying, and the turbocharger before it.

flow        flow through throats, lift of valves, ports; areas, charge air and residual gas of a two-stroke engine
records     valves and volumes, the charge, the walls, what surrounds the engine, a cycle found
run         slopes of masses and energies, cycles until one repeats
turbocharger    boost, its shaft balance, the atmosphere at a height
marine      the scavenge pressure from the balance of engine and turbocharger
engine      an engine of a case: its balance with the turbocharger, pressure, figures over the speeds, curves
"""
