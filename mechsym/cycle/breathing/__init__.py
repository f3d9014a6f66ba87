"""Gas exchange of a four-stroke cylinder by filling and emptying, and the turbocharger before it.

flow        records of valves, volumes, charge, walls, surroundings; flow through throats, lift of valves, ports;
            areas, charge air and residual gas of a two-stroke engine
run         slopes of masses and energies, cycles until one repeats
turbocharger    boost, its shaft balance, the atmosphere at a height
marine      the scavenge pressure from the balance of engine and turbocharger
engine      an engine of a case: its balance with the turbocharger, pressure, figures over the speeds, curves
"""
