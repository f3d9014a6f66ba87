"""Gas exchange of a four-stroke cylinder by filling and emptying, and the turbocharger before it.

flow        flow through throats, lift of valves, ports
records     valves and volumes, the charge, the walls, what surrounds the engine, a cycle found
equations   slopes of masses and energies
run         cycles until one repeats
compressor_map  efficiency of a compressor at flow and ratio
turbocharger    boost, its shaft balance, the atmosphere at a height
scavenging  areas, charge air and residual gas of a two-stroke engine
marine      its scavenge pressure from the balance of engine and turbocharger
engine      an engine of a case: its balance with the turbocharger, pressure, figures over the speeds, curves
"""
