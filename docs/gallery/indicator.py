"""An indicator diagram of a marine diesel

Two Wiebe functions give the pressure in the cylinder; the area over the volume is the work of a turn.

From the shell: mechsym cycle zotov-89
"""

from mechsym import cases, jobs

gas = jobs.gas(cases.load("zotov-89"))
print(f"peak {gas.pressure.p_max / 1e6:.2f} MPa, mean {gas.pressure.mean_indicated / 1e5:.2f} bar")
figure = gas.plot()
