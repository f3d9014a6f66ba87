"""Mechanisms in space beside Pinocchio and Exudyn, the same machines.

`python -m benchmarks.space [lines, chain, stewart, rssr ..]`, with `pip install pin exudyn`.

lines     of code that each machine takes: ours, Pinocchio's, Exudyn's
chain     20 links on revolute joints across one another: accelerations of one state
stewart   accelerations of a Stewart platform on its loops, all thirteen bodies with mass
rssr      10,000 turns: how far the loop gapes after them, what the energy has lost, the seconds;
          Pinocchio, which has no integrator, by Runge and Kutta's steps, its constraint stabilised, Exudyn by its
          generalised alpha

Both are called from Python, whose call takes some 0.3 us here and 2 us there; ours is C that the compiler of the
machine has made of the generated functions.
"""

import inspect
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import casadi as ca
import numpy as np

from mechsym.derive import Mechanism, derive
from mechsym.derive.emit import module_text
from mechsym.mechanisms import loops, own
from mechsym.mechanisms.arrays import solved
from mechsym.mechanisms.record import bind, bind_module
from mechsym.simulate import Problem, Settings, simulate

EXAMPLES = Path(__file__).parents[1] / "examples/space"
LINKS, TURNS = 20, 10_000
PLATFORM = dict(R=1.0, r=0.6, half=0.4, gap=0.2, plate_mass=30.0, low=3.0, up=2.0, I=2.0, A=0.1, C=0.005, g=9.81)
LINKAGE = dict(a=0.1, b=0.5, c=0.32, d=0.35, h=0.2, m2=0.8, m3=0.6, I1=0.02, I2=0.013, J2=3e-4, I3=0.006, g=9.81)


def chain():
    m = Mechanism("chain", space=3)
    q = m.coordinates(" ".join(f"q{k}" for k in range(LINKS)))
    before = m.frame
    for k in range(LINKS):
        link = m.link(
            f"b{k}", mass="1.5 kg", centre=("0.15 m", 0, 0), inertia=("0.002 kg*m^2", "0.01 kg*m^2", "0.012 kg*m^2")
        )
        m.revolute(f"j{k}", before.at("0.3 m", 0, 0) if k else before, link, axis="zyx"[k % 2], turns=q[k])
        before = link
    m.weight(0, 0, -9.81)
    return m


def whole(mechanism):
    """Accelerations of the independent coordinates from all coordinates, independent velocities and inputs."""
    n, held = len(mechanism.coordinates), tuple(mechanism.dependents)
    q, u, w = (ca.SX.sym(s, k) for s, k in (("q", n), ("u", n - len(held)), ("w", len(mechanism.inputs))))
    T, c = loops.motion(mechanism, q, u, held)
    mass, bias, force = mechanism.functions["dynamics"](
        *ca.vertsplit(q), *ca.vertsplit(ca.mtimes(T, u)), *ca.vertsplit(w)
    )
    reduced, right = ca.mtimes(T.T, ca.mtimes(mass, T)), ca.mtimes(T.T, force - bias - ca.mtimes(mass, c))
    return ca.Function("whole", [q, u, w], [solved(reduced, right)], {"cse": True})


def compiled(function, folder):
    c = Path(folder) / "f.c"
    function.generate("f.c")
    Path("f.c").replace(c)
    subprocess.run(["cc", "-O2", "-fPIC", "-shared", str(c), "-o", str(c.with_suffix(".so"))], check=True)
    return ca.external(function.name(), str(c.with_suffix(".so")))


def seconds(call, least=0.5):
    """Of one call, the best of five rounds."""
    count = 1
    while True:
        start = time.perf_counter()
        for _ in range(count):
            call()
        if time.perf_counter() - start > least / 5:
            break
        count *= 2
    rounds = []
    for _ in range(5):
        start = time.perf_counter()
        for _ in range(count):
            call()
        rounds.append((time.perf_counter() - start) / count)
    return min(rounds)


def ours(function, *values):
    buffer, call = function.buffer()
    keep = [np.ascontiguousarray(v, dtype=float) for v in values] + [np.zeros(function.size1_out(0))]
    for i, v in enumerate(keep[:-1]):
        buffer.set_arg(i, memoryview(v))
    buffer.set_res(0, memoryview(keep[-1]))
    return call, keep[-1], (buffer, keep)


def pinocchio_chain():
    import pinocchio as pin

    model, parent = pin.Model(), 0
    joints = (pin.JointModelRZ(), pin.JointModelRY())
    for k in range(LINKS):
        place = pin.SE3(np.eye(3), np.array([0.3 if k else 0.0, 0, 0]))
        parent = model.addJoint(parent, joints[k % 2], place, f"j{k}")
        model.appendBodyToJoint(
            parent, pin.Inertia(1.5, np.array([0.15, 0, 0]), np.diag([0.002, 0.01, 0.012])), pin.SE3.Identity()
        )
    model.gravity.linear = np.array([0, 0, -9.81])
    return pin, model


def pinocchio_platform():
    import pinocchio as pin

    p, model, closures = PLATFORM, pin.Model(), pin.StdVec_RigidConstraintModel()
    plate = model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "P")
    model.appendBodyToJoint(
        plate, pin.Inertia(p["plate_mass"], np.zeros(3), p["I"] * np.diag([1.0, 1, 2])), pin.SE3.Identity()
    )
    half = np.array([0, 0, p["half"]])
    inertia = np.diag([p["A"], p["A"], p["C"]])
    for k in range(6):
        side = 1 if k % 2 else -1
        foot, head = (2 * k + 1 - side) * np.pi / 6 + side * p["gap"], (2 * k + 1 + side) * np.pi / 6 - side * p["gap"]
        at, on = (s * np.array([np.cos(a), np.sin(a), 0]) for s, a in ((p["R"], foot), (p["r"], head)))
        x = model.addJoint(0, pin.JointModelRX(), pin.SE3(np.eye(3), at), f"x{k}")
        y = model.addJoint(x, pin.JointModelRY(), pin.SE3.Identity(), f"y{k}")
        model.appendBodyToJoint(y, pin.Inertia(p["low"], half, inertia), pin.SE3.Identity())
        z = model.addJoint(y, pin.JointModelPZ(), pin.SE3.Identity(), f"z{k}")
        model.appendBodyToJoint(z, pin.Inertia(p["up"], -half, inertia), pin.SE3.Identity())
        closures.append(
            pin.RigidConstraintModel(
                pin.ContactType.CONTACT_3D, model, z, pin.SE3.Identity(), plate, pin.SE3(np.eye(3), on)
            )
        )
    model.gravity.linear = np.array([0, 0, -9.81])
    return pin, model, closures


def run_chain(folder):
    start = time.process_time()
    m = chain()
    equations = derive(m)
    text = module_text(equations, "chain.py", "0" * 16)
    took = time.process_time() - start
    module = own._module(Path("chain.py"), text)
    values = {s: m.ranges[s]["default"] for s in module.PARAMETERS}
    function = whole(bind_module(module, values))
    fast = compiled(function, folder)
    q, u = np.linspace(-1, 1, LINKS), np.linspace(2, -1, LINKS)
    call, out, _keep = ours(fast, q, u, [])
    here = seconds(call)
    pin, model = pinocchio_chain()
    data, zero = model.createData(), np.zeros(LINKS)
    there = seconds(lambda: pin.aba(model, data, q, u, zero))
    gap = np.abs(out - data.ddq).max() / np.abs(out).max()
    print(
        f"chain of {LINKS}: derived in {took:.1f} s, {function.n_instructions()} operations, {1e6 * here:.2f} us; "
        f"Pinocchio {1e6 * there:.2f} us; differ by {gap:.1e}"
    )


def platform_start(mechanism):
    """A pose of the platform: coordinates, independent rates, all rates by name, accelerations."""
    e = np.array([0.0, 0.08, -0.06, 0.12])
    e[0] = np.sqrt(1 - e @ e)
    given = dict(zip(("x_P", "y_P", "z_P", "e1_P", "e2_P", "e3_P"), (0.05, -0.08, 1.1, *e[1:]), strict=True))
    q = loops.close(mechanism, given, mechanism.dependents)
    u = np.array([0.4, -0.3, 0.5, 0.2, 0.1, -0.3])
    T = np.asarray(ca.evalf(loops.motion(mechanism, ca.SX(q), ca.SX(u), tuple(mechanism.dependents))[0]))
    accelerated = np.asarray(whole(mechanism)(q, u, [100.0] * 6)).ravel()
    return q, u, dict(zip(mechanism.coordinates, T @ u, strict=True)), accelerated


def run_platform(folder):
    start = time.process_time()
    mechanism = bind(str(EXAMPLES / "stewart.py"), PLATFORM)
    took = time.process_time() - start
    function = whole(mechanism)
    q, u, full, _ = platform_start(mechanism)
    position = dict(zip(mechanism.coordinates, q, strict=True))
    place, e = q[:3], np.array([position[f"e{k}_P"] for k in range(4)])
    call, out, _keep = ours(compiled(function, folder), q, u, [100.0] * 6)
    here = seconds(call)
    pin, model, closures = pinocchio_platform()
    data, datas = model.createData(), pin.StdVec_RigidConstraintData()
    for closure in closures:
        datas.append(closure.createData())
    pin.initConstraintDynamics(model, data, closures, datas)
    R = pin.Quaternion(*e).toRotationMatrix()
    ed = np.array([full[f"e{k}_P"] for k in range(4)])
    w = 2 * (e[0] * ed[1:] - ed[0] * e[1:] - np.cross(e[1:], ed[1:]))
    legs = [n for n in mechanism.coordinates if n.startswith(("turn", "slide"))]
    qp = np.array([*place, *e[1:], e[0], *(position[n] for n in legs)])
    vp = np.array([*(R.T @ u[:3]), *w, *(full[n] for n in legs)])
    tau = np.array([0.0] * 6 + [0.0, 0.0, 100.0] * 6)
    settings = pin.ProximalSettings(1e-12, 1e-12, 10)
    step = lambda: pin.constraintDynamics(model, data, qp, vp, tau, closures, datas, settings)  # noqa: E731
    a = np.array(step())
    there = seconds(step)
    a = R @ (a[:3] + np.cross(w, vp[:3]))
    generated = sum(mechanism.functions[n].n_instructions() for n in ("dynamics", "constraints"))
    gap = np.abs(a - out[:3]).max() / np.abs(a).max()
    print(
        f"Stewart platform: derived, checked and stored in {took:.1f} s (none from the cache), {len(q)} coordinates; "
        f"dynamics and rows {generated} operations, with the solve {function.n_instructions()}, {1e6 * here:.2f} us; "
        f"Pinocchio {1e6 * there:.2f} us; differ by {gap:.1e}"
    )


def run_linkage(turns):
    mechanism = bind(f"{EXAMPLES / 'spatial_linkages.py'}:rssr", LINKAGE)
    q0 = tuple(mechanism.dependents.get(q, 0.0) for q in mechanism.coordinates)
    problem = Problem(
        mechanism=mechanism, parts=(), q0=q0, u0=(30.0, 0.0, 0.0, 0.0), turns=turns, t_end=1e5, output=0.5
    )
    start = time.perf_counter()
    found = simulate(problem, Settings(check="none"))
    took = time.perf_counter() - start
    q, u = ([found.columns[f"{n}{d}"][None, :] for n in mechanism.coordinates] for d in ("", "d"))
    gap = np.abs(np.asarray(mechanism.functions["constraints"](*q, *u)[0])).max()
    total = np.asarray(mechanism.functions["energy"](*q, *u)).reshape(2, -1).sum(axis=0)
    lost = np.abs(total / total[0] - 1).max()
    print(f"RSSR, {turns} turns: {took:.1f} s, the loop gapes by {gap:.1e} m, energy off by {lost:.1e}")


def linkage_start(speed=30.0):
    """The RSSR at phi = 0: the mechanism, coordinates and their rates by name."""
    mechanism = bind(f"{EXAMPLES / 'spatial_linkages.py'}:rssr", LINKAGE)
    held = tuple(mechanism.dependents)
    q = loops.close(mechanism, {"phi": 0.0}, mechanism.dependents)
    T = np.asarray(ca.evalf(loops.motion(mechanism, ca.SX(q), ca.SX([speed]), held)[0]))
    names = mechanism.coordinates
    return mechanism, *(dict(zip(names, v, strict=True)) for v in (q, (T @ [speed]).ravel()))


def linkage_energy(mechanism, q, qd):
    """Kinetic and potential energy of the RSSR [J]."""
    names = mechanism.coordinates
    return float(np.sum(mechanism.functions["energy"](*(q[n] for n in names), *(qd[n] for n in names))))


def exudyn_linkage(turns, step=1e-3):
    from benchmarks import space_exudyn as peer

    mechanism, q, qd = linkage_start()
    accelerated = float(whole(mechanism)(list(q.values()), [qd["phi"]], [0.0])[0])
    machine, crank, *_ = peer.linkage(LINKAGE, q, qd)
    machine.solve(1e-9, 1e-9, order=2)
    off = abs(machine.read(crank, "AngularAcceleration")[2] / accelerated - 1)
    machine, crank, rod, rocker = peer.linkage(LINKAGE, q, qd)
    before = machine.energy(LINKAGE, (crank, rod, rocker))
    took = machine.solve(turns * 2 * np.pi / 30, step)
    gap = machine.read(rod, "Position", (LINKAGE["b"] / 2, 0, 0)) - machine.read(
        rocker, "Position", (0, 0, LINKAGE["c"] / 2)
    )
    lost = abs(machine.energy(LINKAGE, (crank, rod, rocker)) / before - 1)
    steps = turns * 2 * np.pi / 30 / step
    print(
        f"RSSR in Exudyn, {machine.states} states: {turns} times the first turn's time in {took:.0f} s of a processor "
        f"by steps of {step} s, {1e6 * took / steps:.0f} us each; the loop gapes by {np.abs(gap).max():.1e} m, energy "
        f"off by {lost:.1e}; the acceleration after one step of 1e-9 s differs by {off:.1e}"
    )


def pinocchio_rssr():
    import pinocchio as pin

    p, model, closures = LINKAGE, pin.Model(), pin.StdVec_RigidConstraintModel()
    inertia = lambda m, at, J: pin.Inertia(m, np.array(at), np.diag(J))  # noqa: E731
    crank = model.addJoint(0, pin.JointModelRZ(), pin.SE3.Identity(), "A")
    turn = model.addJoint(crank, pin.JointModelRZ(), pin.SE3(np.eye(3), np.array([p["a"], 0, 0])), "B1")
    rod = model.addJoint(turn, pin.JointModelRY(), pin.SE3.Identity(), "B2")
    rocker = model.addJoint(
        0, pin.JointModelRX(), pin.SE3(np.eye(3), np.array([p["d"], p["h"], 0])), "D"
    )  # behind: subtrees are contiguous
    for joint, body in (
        (crank, inertia(1.0, [0, 0, 0], [p["I1"]] * 3)),
        (rocker, inertia(p["m3"], [0, 0, p["c"] / 2], [p["I3"]] * 3)),
        (rod, inertia(p["m2"], [p["b"] / 2, 0, 0], [p["J2"], p["I2"], p["I2"]])),
    ):
        model.appendBodyToJoint(joint, body, pin.SE3.Identity())
    model.gravity.linear = np.array([0, 0, -p["g"]])
    ends = [pin.SE3(np.eye(3), np.array(at)) for at in ([p["b"], 0, 0], [0, 0, p["c"]])]
    closures.append(pin.RigidConstraintModel(pin.ContactType.CONTACT_3D, model, rod, ends[0], rocker, ends[1]))
    return pin, model, closures


def pinocchio_linkage(turns, step=2e-3):
    pin, model, closures = pinocchio_rssr()
    held, datas = closures[0].m_baumgarte_parameters, pin.StdVec_RigidConstraintData()
    held.Kp, held.Kd = 1 / step**2 / 25, 2 / step / 5
    datas.append(closures[0].createData())
    data, settings, none = model.createData(), pin.ProximalSettings(1e-12, 1e-12, 10), np.zeros(4)
    pin.initConstraintDynamics(model, data, closures, datas)
    mechanism, at, rates = linkage_start()
    order = ("phi", "turn1_B", "turn2_B", "turn_D")
    y = np.array([*(at[n] for n in order), *(rates[n] for n in order)])

    def slope(y):
        return np.concatenate(
            [y[4:], pin.constraintDynamics(model, data, y[:4], y[4:], none, closures, datas, settings)]
        )

    accelerated = float(whole(mechanism)(list(at.values()), [rates["phi"]], [0.0])[0])
    off = abs(slope(y)[4] / accelerated - 1)
    each = seconds(lambda: slope(y))
    total = linkage_energy(mechanism, at, rates)
    start = time.process_time()
    for _ in range(round(turns * 2 * np.pi / 30 / step)):
        k1 = slope(y)
        k2 = slope(y + step / 2 * k1)
        k3 = slope(y + step / 2 * k2)
        y = y + step / 6 * (k1 + 2 * k2 + 2 * k3 + slope(y + step * k3))
    took = time.process_time() - start
    at, rates = (dict(zip(order, v, strict=True)) for v in (y[:4], y[4:]))
    q = [at[n] for n in mechanism.coordinates]
    gap = np.abs(np.asarray(mechanism.functions["constraints"](*q, *q)[0])).max()
    lost = abs(linkage_energy(mechanism, at, rates) / total - 1)
    print(
        f"RSSR in Pinocchio, 8 states: {turns} times the first turn's time in {took:.0f} s of a processor by Runge "
        f"and Kutta's steps of {step} s, {1e6 * each:.0f} us an acceleration; the loop gapes by {gap:.1e} m, energy "
        f"off by {lost:.1e}; the acceleration differs by {off:.1e}"
    )


def exudyn_platform():
    from benchmarks import space_exudyn as peer

    mechanism = bind(str(EXAMPLES / "stewart.py"), PLATFORM)
    q, u, full, accelerated = platform_start(mechanism)
    p, feet = PLATFORM, []
    for k in range(6):
        side = 1 if k % 2 else -1
        foot, head = (2 * k + 1 - side) * np.pi / 6 + side * p["gap"], (2 * k + 1 + side) * np.pi / 6 - side * p["gap"]
        feet.append([s * np.array([np.cos(a), np.sin(a), 0]) for s, a in ((p["R"], foot), (p["r"], head))])
    position = dict(zip(mechanism.coordinates, q, strict=True))
    machine, plate = peer.platform(p, position, full, [100.0] * 6, feet)
    machine.solve(1e-9, 1e-9, order=2)
    gap = np.abs(machine.read(plate, "Acceleration") - accelerated[:3]).max() / np.abs(accelerated[:3]).max()
    machine, plate = peer.platform(p, position, full, [100.0] * 6, feet)
    took = machine.solve(0.2, 1e-3)
    print(
        f"Stewart platform in Exudyn, {machine.states} states: {1e6 * took / 200:.0f} us a step of 1e-3 s; the plate's "
        f"acceleration after one step of 1e-9 s differs by {gap:.1e}"
    )


def count_lines():
    """What each machine takes to write down, a line each: without what runs it, starts it or reads it."""
    from benchmarks import space_exudyn as peer

    sys.path.insert(0, str(EXAMPLES))
    import spatial_linkages
    import stewart

    for name, functions in (
        ("chain", (chain, pinocchio_chain)),
        ("Stewart platform", (stewart.stewart, pinocchio_platform, peer.platform)),
        ("RSSR", (spatial_linkages.rssr, pinocchio_rssr, peer.linkage)),
    ):
        counts = [sum(bool(line.strip()) for line in inspect.getsource(f).splitlines()) for f in functions]
        print(f"{name}, lines of code: " + ", ".join(map(str, counts)))


def main(wanted):
    if "lines" in wanted:
        count_lines()
    with tempfile.TemporaryDirectory() as folder:
        if "chain" in wanted:
            run_chain(folder)
        if "stewart" in wanted:
            run_platform(folder)
            exudyn_platform()
    if "rssr" in wanted:
        run_linkage(TURNS)
        pinocchio_linkage(TURNS)
        exudyn_linkage(TURNS)


if __name__ == "__main__":
    main(sys.argv[1:] or ("lines", "chain", "stewart", "rssr"))
