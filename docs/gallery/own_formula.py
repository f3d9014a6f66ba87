"""Is a formula of a textbook right?

The travel of a piston to the second power of r/l, beside the exact one of the derived mechanism.

From the shell: mechsym audit --formula "r*(1-cos(phi))+r**2/(4*l)*(1-cos(2*phi))" --against crosshead.x
"""

import numpy as np

from mechsym import cases, mechanisms, style

engine = mechanisms.build("crosshead", cases.load("zotov-89").need("parameters"))
phi, r, l = np.linspace(0, 2 * np.pi, 361), 0.5, 1.55
exact = mechanisms.evaluate(engine, "kinematics", phi=phi)["x"]
printed = r * (1 - np.cos(phi)) + r**2 / (4 * l) * (1 - np.cos(2 * phi))
print(f"off by at most {1e3 * abs(printed - exact).max():.2f} mm of a stroke of {1e3 * np.ptp(exact):.0f} mm")
figure, (axis,) = style.panels(6, 3.4, title="Error of the printed travel over the crank angle")
axis.plot(np.degrees(phi), 1e3 * (printed - exact), color=style.RED)
style.angle_axis(axis, 360)
axis.set(xlabel="crank angle [deg]", ylabel="printed minus exact [mm]")
