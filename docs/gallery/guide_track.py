"""The guide of a hinge, to scale

Rollers run along this track against an air spring. The profile is the exact parallel curve at the roller radius.

From the shell: mechsym guide zotov-89 --dxf guide.dxf
"""

from mechsym import cases, jobs

design = jobs.hinge(cases.load("zotov-89"))
print(f"roller centres between {design.verdict.rho_min:.3f} and {design.verdict.rho_max:.3f} m")
figure = design.plot("track")
