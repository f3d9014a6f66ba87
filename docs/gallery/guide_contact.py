"""Forces where roller and guide touch

N1 and N2 are the reactions that Zotov et al. (2024) leave open; here they follow from spring and geometry.

From the shell: mechsym hinge zotov-89 --set spring.p0="8 MPa"
"""

from mechsym import cases, jobs

design = jobs.hinge(cases.load("zotov-89", {"spring.p0": "8 MPa"}))
print(f"a roller carries at most {design.verdict.roller_reaction_max / 1e3:.0f} kN")
figure = design.plot("contact")
