"""Forces through a marine engine

Exact reactions from the equations of motion, with the printed chain of the rod as two masses beside them.

From the shell: mechsym forces moroianu
"""

from mechsym import cases, jobs

result = jobs.forces(cases.load("moroianu"))
print(f"crank pin {result.columns['crank_pin_load'].max() / 1e3:.0f} kN")
figure = result.plot("forces")
