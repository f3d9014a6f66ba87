"""An outside multibody code (exudyn, C++) as the judge of slider crank and crank train; skipped where it is missing."""

import dataclasses
import math

import numpy as np
import pytest

from mechsym.mechanisms.crank_throw import CrankThrowParameters
from mechsym.mechanisms.crank_throw import build as build_throw
from mechsym.mechanisms.crank_train import build_rigid
from mechsym.mechanisms.crank_train.parameters import CrankTrainParameters, each
from mechsym.mechanisms.state import state

exu = pytest.importorskip("exudyn", reason="exudyn is an optional outside judge: pip install exudyn")
# what exudyn itself deprecates is not ours to fix
pytestmark = pytest.mark.filterwarnings("ignore::DeprecationWarning")

THROW = CrankThrowParameters(
    r=0.05, l1=0.06, l2=0.1, offset=0.008, m0=0.0, m_rod=0.7, m_piston=0.5, I0=0.02, I_rod=2e-3, g=9.81, axis_tilt=0.4
)


def rigid(mbs, mass, inertia, place, angle, velocity, turn, weight):
    node = mbs.AddNode(
        exu.itemInterface.NodeRigidBody2D(
            referenceCoordinates=[*place, angle], initialVelocities=[*velocity, turn], initialCoordinates=[0, 0, 0]
        )
    )
    body = mbs.AddObject(exu.itemInterface.RigidBody2D(physicsMass=mass, physicsInertia=inertia, nodeNumber=node))
    if mass > 0:
        marker = mbs.AddMarker(exu.itemInterface.MarkerBodyPosition(bodyNumber=body))
        mbs.AddLoad(exu.itemInterface.Force(markerNumber=marker, loadVector=[mass * w for w in weight] + [0]))
    return body, node


def at(mbs, body, x, y):
    return mbs.AddMarker(exu.itemInterface.MarkerBodyPosition(bodyNumber=body, localPosition=[x, y, 0]))


def acceleration(throws, phi, rate, torque, weight):
    """Angular acceleration of a rigid shaft with cylinders: (parameters, shift, bank, gas force) each."""
    container = exu.SystemContainer()  # must outlive its system
    mbs = container.AddSystem()
    ground = mbs.AddObject(exu.itemInterface.ObjectGround())
    crank, crank_node = rigid(mbs, 1e-9, sum(p.I0 for p, *_ in throws), [0, 0], 0.0, [0, 0], rate, [0, 0])
    mbs.AddObject(exu.itemInterface.RevoluteJoint2D(markerNumbers=[at(mbs, ground, 0, 0), at(mbs, crank, 0, 0)]))
    turning = mbs.AddMarker(exu.itemInterface.MarkerBodyRigid(bodyNumber=crank))
    mbs.AddLoad(exu.itemInterface.Torque(markerNumber=turning, loadVector=[0, 0, torque]))
    for p, shift, bank, force in throws:
        cylinder(mbs, ground, crank, p, phi + shift, bank, rate, force, weight)
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps = 1
    settings.timeIntegration.endTime = 1e-9
    settings.timeIntegration.generalizedAlpha.computeInitialAccelerations = True
    settings.solution.file.write = False
    settings.timeIntegration.verboseMode = 0
    mbs.SolveDynamic(settings, solverType=exu.DynamicSolverType.TrapezoidalIndex2)
    return mbs.GetNodeOutput(crank_node, exu.OutputVariableType.AngularAcceleration)[2]


def cylinder(mbs, ground, crank, p, phi, bank, rate, force, weight):
    """One rod and piston; phi is its own crank angle, the crank body stands at angle 0 of the common frame."""
    l = p.l1 + p.l2
    turned = np.array([[math.cos(bank), -math.sin(bank)], [math.sin(bank), math.cos(bank)]])
    psi = math.asin((p.r * math.sin(phi) - p.offset) / l)
    swing = p.r * math.cos(phi) / (l * math.cos(psi)) * rate
    pin = p.r * np.array([math.cos(phi), math.sin(phi)])
    middle = pin + p.l1 * np.array([math.cos(psi), -math.sin(psi)])
    end = pin + l * np.array([math.cos(psi), -math.sin(psi)])
    pin_speed = rate * p.r * np.array([-math.sin(phi), math.cos(phi)])
    across = np.array([-math.sin(psi), -math.cos(psi)])
    place, speed = turned @ middle, turned @ (pin_speed + p.l1 * swing * across)
    rod, _ = rigid(mbs, p.m_rod, p.I_rod, place, bank - psi, speed, -swing, weight)
    place, speed = turned @ end, turned @ (pin_speed + l * swing * across)
    piston, _ = rigid(mbs, p.m_piston, 1.0, place, bank, speed, 0.0, weight)
    local = turned @ pin
    joint = exu.itemInterface.RevoluteJoint2D
    mbs.AddObject(joint(markerNumbers=[at(mbs, crank, *local), at(mbs, rod, -p.l1, 0)]))
    mbs.AddObject(joint(markerNumbers=[at(mbs, rod, p.l2, 0), at(mbs, piston, 0, 0)]))
    on_axis = turned @ np.array([0.0, p.offset])
    slide = [mbs.AddMarker(exu.itemInterface.MarkerBodyRigid(bodyNumber=ground, localPosition=[*on_axis, 0])),
             mbs.AddMarker(exu.itemInterface.MarkerBodyRigid(bodyNumber=piston))]  # fmt: skip
    axis, normal = turned @ [1.0, 0.0], turned @ [0.0, 1.0]
    mbs.AddObject(
        exu.itemInterface.PrismaticJoint2D(
            markerNumbers=slide, axisMarker0=[*axis, 0], normalMarker1=[0.0, 1.0, 0.0], constrainRotation=True
        )
    )
    assert normal @ axis == pytest.approx(0, abs=1e-15)
    push = mbs.AddMarker(exu.itemInterface.MarkerBodyPosition(bodyNumber=piston))
    mbs.AddLoad(exu.itemInterface.Force(markerNumber=push, loadVector=[*(-force * axis), 0]))


def down(p):
    return [-p.g * math.sin(p.axis_tilt), -p.g * math.cos(p.axis_tilt)]


@pytest.mark.parametrize("phi", [0.3, 1.7, 4.1])
def test_slider_crank(phi):
    truth = acceleration([(THROW, 0.0, 0.0, 900.0)], phi, 80.0, 12.0, down(THROW))
    found = state(build_throw(THROW), {"phi": phi, "phid": 80.0, "F": 900.0, "M": 12.0})
    assert found.acceleration[0] == pytest.approx(truth, rel=1e-6)


def test_crank_train():
    train = CrankTrainParameters(
        throw=(1, 2), phase=(0.2, 2.0), bank=(0.5, -0.4), I_f=0.05, k=1e5,
        **{n: getattr(THROW, n) for n in ("r", "l1", "l2", "offset", "m_rod", "m_piston")},
        **{n: getattr(THROW, n) for n in ("I_rod", "I0", "g", "axis_tilt")},
    )  # fmt: skip
    forces, rows = (900.0, -400.0), []
    for i, force in enumerate(forces):
        extra = 0.05 if i == 0 else 0.0
        p = dataclasses.replace(THROW, I0=THROW.I0 + extra)
        bank = each(train, "bank")[i]
        rows.append((p, each(train, "phase")[i] - bank, bank, force))
    truth = acceleration(rows, 0.9, 80.0, -7.0, down(THROW))
    found = state(build_rigid(train), {"phi": 0.9, "phid": 80.0, "F1": 900.0, "F2": -400.0, "M": 7.0})
    assert found.acceleration[0] == pytest.approx(truth, rel=1e-6)
