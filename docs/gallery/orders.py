"""What shakes the frame

Amplitudes by order: a counterweight on the shaft can take the first order, and no other.

From the shell: mechsym forces zotov-89
"""

from mechsym import cases, jobs

result = jobs.forces(cases.load("zotov-89"))
weight = result.shaking.counterweight
print(f"{weight.rms_before / 1e3:.1f} kN rms, {weight.rms_after / 1e3:.1f} kN with {weight.unbalance:.0f} kg m")
figure = result.plot("orders")
