"""Mechanisms in space against an own [M J'; J 0] in six coordinates a body, which shares nothing with mechsym."""

import numpy as np
import pytest
from spatial_machines import FILE, NUMBERS

from mechsym.mechanisms import own
from mechsym.mechanisms.loops import followed
from mechsym.mechanisms.record import bind
from mechsym.mechanisms.state import state


@pytest.mark.parametrize("name", NUMBERS)
def test_accelerations_and_reactions(name):
    make, numbers = NUMBERS[name]
    file = f"{FILE}:{name}"
    listing = own.load(file).listing
    mechanism = bind(file, {k: numbers.get(k, 9.81) for k in listing["parameters"]})
    inputs = {k: numbers[k] for k in listing["inputs"]}
    for phi in (0.4, 1.9, 4.4):
        machine, loads = make(phi, 7.0, numbers)
        pose = {"phi": phi}
        if mechanism.dependents:
            at = followed(mechanism, pose, mechanism.dependents)
            pose = dict(zip(mechanism.coordinates, at, strict=True))
        found = state(mechanism, {**pose, "phid": 7.0, **inputs})
        accelerations, reactions, open_ = machine.solve(loads)
        axis = np.argmax(np.abs(machine.bodies[0].w))
        wanted = accelerations[0, 3 + axis]
        assert found.acceleration[0] == pytest.approx(wanted, rel=1e-10, abs=1e-10)
        if name == "pump":  # its shoes go over the plate: z = x tan(tilt), and the pistons press and shake on it
            behind = phi + 2 * np.pi * np.arange(3) / 3
            rise = numbers["R"] * np.tan(numbers["tilt"]) * np.cos(behind)
            assert [pose[f"slide_G{k}"] for k in (1, 2, 3)] == pytest.approx(rise, abs=1e-14)
        largest = max(np.abs(r).max() for r in reactions.values())
        for joint in machine.joints:
            for k, kind in enumerate(("R_x", "R_y", "R_z", "M_x", "M_y", "M_z")):
                output = f"{kind}_{joint.name}"
                if open_[joint.name][k]:
                    assert found.outputs[output] is None
                elif joint.name != "G":
                    assert found.outputs.get(output, 0.0) == pytest.approx(
                        reactions[joint.name][k], abs=1e-10 * max(1, largest)
                    )
