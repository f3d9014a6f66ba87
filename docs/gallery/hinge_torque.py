"""The torque that keeps a crank at constant speed

The hinge has to give what gas and masses give too little, and take what they give too much; its mean is nothing.

From the shell: mechsym hinge zotov-89
"""

from mechsym import cases, jobs

design = jobs.hinge(cases.load("zotov-89"))
wanted = design.hinge
print(f"between {wanted.torque_min / 1e3:.1f} and {wanted.torque_max / 1e3:.1f} kN m, verdict: {design.verdict.reason}")
figure = design.plot("torque")
