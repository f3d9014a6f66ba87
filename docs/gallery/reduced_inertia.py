"""The inertia that a crank feels

What the masses of an engine weigh at its crank changes over the turn; its slope is a torque.

From the shell: mechsym eval crosshead --case zotov-89 --set phi=1
"""

import numpy as np

from mechsym import cases, mechanisms, style

engine = mechanisms.build("crosshead", cases.load("zotov-89").need("parameters"))
phi = np.linspace(0, 2 * np.pi, 361)
inertia = mechanisms.evaluate(engine, "kinematics", phi=phi)["inertia"]
print(f"{inertia.min():.1f} to {inertia.max():.1f} kg m2")
figure, (axis,) = style.panels(6, 3.4, title="Reduced inertia over the crank angle")
axis.plot(np.degrees(phi), inertia, color=style.BLUE)
style.angle_axis(axis, 360)
axis.set(xlabel="crank angle [deg]", ylabel="inertia at the crank [kg m$^2$]")
