"""A spring that is too weak

Below some pressure no guide gives the torque: the verdict says so, with the limit that is not kept.

From the shell: mechsym sweep zotov-89 --over "spring.p0=2..9 MPa:8"
"""

import numpy as np

from mechsym import cases, jobs, style

pressures = np.linspace(2e6, 9e6, 8)  # Pa
designs = [jobs.hinge(cases.load("zotov-89", {"spring.p0": float(p)})) for p in pressures]
for p, design in zip(pressures, designs, strict=True):
    print(f"{p / 1e6:.0f} MPa: {design.answer}")
figure, (axis,) = style.panels(6, 3.4, title="Margin of the tightest limit over the pressure of the spring")
axis.plot(pressures / 1e6, [100 * design.verdict.margin for design in designs], "o-", color=style.BLUE)
axis.set(xlabel="pressure of the spring [MPa]", ylabel="margin of the tightest limit [%]")
