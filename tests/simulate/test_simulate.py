"""Simulation core: exact splitting, events, energy audit, convergence check, and backends against closed forms."""

import dataclasses
import shutil
import sys

import numpy as np
import pytest
from simulated import double_pendulum, oscillator, shaft

from mechsym.errors import BadInput, MissingExtra
from mechsym.native.runs import Level
from mechsym.simulate import Part, Problem, Settings, Steps, simulate, write_netcdf
from mechsym.simulate.backends import advance
from mechsym.simulate.equations import held, system
from mechsym.simulate.fixed_step import fixed_step
from mechsym.simulate.phase import Phase
from mechsym.simulate.problem import FormulaForce, Kinks, Stop
from mechsym.simulate.result import dataset, last_period, speed_ripple, speeds_over, summary, write_series
from mechsym.simulate.settings import BACKENDS

JUMP = 0.731  # no multiple of any output step


def stepped(output=0.05, **changes):
    """An oscillator at rest that a torque of 5 N m meets at t = JUMP."""
    values = {
        "mechanism": oscillator(),
        "parts": (Part(name="drive", input="M", value=Steps(times=(JUMP,), values=(0.0, 5.0))),),
        "q0": (0.0,),
        "u0": (0.0,),
        "t_end": 3.0,
        "output": output,
    }
    return Problem(**(values | changes))


def step_response(t):
    """phi = M/k (1 - cos(omega (t - t1))) of the oscillator with I = 2, k = 50."""
    return np.where(t > JUMP, 0.1 * (1 - np.cos(5.0 * (t - JUMP))), 0.0)


def braked(inertia=3.0, speed=10.0, torque=4.0, **changes):
    """A shaft that a constant load brings to rest at t = I u0 / M."""
    values = {
        "mechanism": shaft(inertia),
        "parts": (Part(name="load", input="M_r", role="load", value=Steps(values=(torque,))),),
        "q0": (0.0,),
        "u0": (speed,),
        "t_end": 20.0,
        "stops": (Stop(name="stall", of="phid", direction="falling"),),
        "output": 0.5,
    }
    return Problem(**(values | changes))


def test_torque_step_is_split_exactly():
    result = simulate(stepped(), Settings(tolerance=1e-11))
    np.testing.assert_allclose(result.columns["phi"], step_response(result.t), atol=2e-11)
    assert result.status == "converged"
    assert abs(result.energy.residual) < 1e-10


def test_jump_of_a_callable_is_split_where_it_is_announced():
    def torque(t, q, u):
        return 5.0 if t >= JUMP else 0.0

    part = (Part(name="drive", input="M", value=torque),)
    told = simulate(stepped(parts=part, breaks=(JUMP,)), Settings(tolerance=1e-9, check="none"))
    untold = simulate(stepped(parts=part), Settings(tolerance=1e-9, check="none"))
    np.testing.assert_allclose(told.columns["phi"], step_response(told.t), atol=1e-9)
    assert told.steps < 0.7 * untold.steps  # without the split the step size must shrink to nothing at the jump


@pytest.mark.parametrize("name", ["auto", "scipy-dop853"])
def test_error_follows_the_tolerance(name):
    errors, tolerances = [], (1e-5, 1e-7, 1e-9)
    for tolerance in tolerances:
        result = simulate(stepped(), Settings(backend=name, tolerance=tolerance, check="none"))
        errors.append(np.abs(result.columns["phi"] - step_response(result.t)).max())
    assert np.all(np.array(errors) < 5 * np.array(tolerances))
    # where the equations are linear, steps of order 16 are exact at any tolerance
    assert name == "auto" or (errors[0] > 20 * errors[1] and errors[1] > 20 * errors[2])


def test_fixed_step_has_its_order():
    smooth = stepped(parts=(Part(name="drive", input="M", value=Steps(values=(5.0,))),), t_end=1.0)
    for order in (3, 4):
        errors = []
        for step in (0.01, 0.005):
            t, y = fixed_step(smooth, step, order)
            errors.append(abs(y[-1, 0] - 0.1 * (1 - np.cos(5.0 * t[-1]))))
        assert np.log2(errors[0] / errors[1]) == pytest.approx(order, abs=0.15)


def test_damper_is_in_the_balance():
    result = simulate(stepped(mechanism=oscillator(damping=3.0), output=0.1), Settings(tolerance=1e-11))
    audit = result.energy
    assert audit.dissipation > 0.1 * audit.work_in
    assert abs(audit.residual) < 1e-10
    assert abs(audit.work_in - audit.change) > 0.1 * audit.work_in  # without the damper it would not balance


def test_stall_time_and_angle():
    result = simulate(braked(), Settings(tolerance=1e-11))
    assert (result.end, result.event.name) == ("stall", "stall")
    assert result.event.t == pytest.approx(3.0 * 10.0 / 4.0, abs=1e-9)
    assert result.event.state["phi"] == pytest.approx(3.0 * 10.0**2 / 2 / 4.0, abs=1e-9)
    assert abs(result.event.state["phid"]) < 1e-9
    assert result.t[-1] == result.event.t


def test_crank_with_a_weight_stops_where_its_energy_is_used_up():
    unbalance, angle = 20.0, 2.0
    speed = np.sqrt(2 * unbalance * (1 - np.cos(angle)) / 3.0)
    result = simulate(
        braked(mechanism=shaft(3.0, unbalance), parts=(), speed=speed), Settings(tolerance=1e-12, check="none")
    )
    assert result.event.state["phi"] == pytest.approx(angle, abs=1e-8)
    assert abs(result.energy.residual) < 1e-10


@pytest.mark.parametrize("direction, angle", [("rising", 1 / 3), ("falling", 5 / 3), ("either", 1 / 3)])
def test_direction_of_a_stop(direction, angle):
    # phi = 0.1 (1 - cos 5 t) passes 0.05 upwards at 5 t = pi/3, downwards at 5 pi/3
    drive = (Part(name="drive", input="M", value=Steps(values=(5.0,))),)
    stop = (Stop(name="level", of="phi", level=0.05, direction=direction),)
    result = simulate(stepped(parts=drive, stops=stop), Settings(tolerance=1e-11))
    assert result.event.t == pytest.approx(angle * np.pi / 5.0, abs=1e-10)


def test_turns_end_a_run():
    result = simulate(braked(parts=(), turns=2.5), Settings(tolerance=1e-11))
    assert result.end == "turns" and result.event is None
    assert result.columns["phi"][-1] == pytest.approx(5 * np.pi, abs=1e-10)
    assert result.t[-1] == pytest.approx(5 * np.pi / 10.0, abs=1e-10)


def saw(phi):
    """A torque with kinks at 0 and 2 rad, period 2 pi: rises to 3 N m, falls back to 0."""
    phi = phi % (2 * np.pi)
    return 3 * phi / 2 if phi < 2 else 3 * (2 * np.pi - phi) / (2 * np.pi - 2)


def saw_work(phi):
    """Integral of the saw over less than a turn."""
    fall = 2 * np.pi - 2
    return np.where(phi < 2, 0.75 * phi**2, 3 + 1.5 * (fall**2 - (2 * np.pi - phi) ** 2) / fall)


def saw_error(result):
    return np.abs(result.columns["work_drive"] - saw_work(result.columns["phi"])).max()


def sawn(kinks, turns):
    """A shaft that the saw drives from 5 rad/s."""
    return braked(
        parts=(Part(name="drive", input="M", value=lambda t, q, u: saw(q[0])),),
        speed=5.0,
        stops=(),
        turns=turns,
        kinks=kinks,
        output=0.01,
    )


def test_kinks_are_split():
    kinks = (Kinks(coordinate="phi", angles=(0.0, 2.0), period=2 * np.pi),)
    result = simulate(sawn(kinks, 0.95), Settings(tolerance=1e-10, check="none"))
    assert saw_error(result) < 1e-9  # a tenth of tolerance times work
    unsplit = simulate(sawn((), 0.95), Settings(tolerance=1e-10, check="none"))
    assert saw_error(unsplit) > 3 * saw_error(result)


def test_jumps_over_an_angle_are_split():
    def torque(t, q, u):
        return 3.0 if q[0] % (2 * np.pi) < 2.0 else 0.0

    def work(phi):
        turns, rest = np.divmod(phi, 2 * np.pi)
        return 6.0 * turns + 3.0 * np.minimum(rest, 2.0)

    kinks = (Kinks(coordinate="phi", angles=(0.0, 2.0), period=2 * np.pi),)
    problem = dataclasses.replace(sawn(kinks, 5), parts=(Part(name="drive", input="M", value=torque),))
    split = simulate(problem, Settings(tolerance=1e-10))
    whole = simulate(dataclasses.replace(problem, kinks=()), Settings(tolerance=1e-10, check="none"))
    np.testing.assert_allclose(split.columns["work_drive"], work(split.columns["phi"]), atol=1e-8)
    assert split.status == "converged"
    assert 2 * split.steps < whole.steps


def test_no_accepted_step_reaches_across_a_kink():
    kinks = (Kinks(coordinate="phi", angles=(2.0,), period=2 * np.pi),)
    equations = system(sawn(kinks, 3))
    y = np.zeros(len(equations.columns))
    y[1] = 5.0
    surface = Level(state=0, level=2.0, direction=1)
    phase = Phase(
        system=equations, t_start=0.0, t_end=9.0, y=y, w=held(equations, 0.0), surfaces=(surface,),
        times=np.linspace(0.01, 9.0, 900), tolerance=1e-10,
    )  # fmt: skip
    leg = advance(phase, "DOP853")
    assert leg.met == 0
    assert leg.y[0] == pytest.approx(2.0, abs=1e-9)
    assert len(leg.samples) == int(leg.t / 0.01) and np.all(leg.samples[:, 0] < 2.0)


def test_kinks_are_met_backwards_too():
    kinks = (Kinks(coordinate="phi", angles=(0.0, 2.0), period=2 * np.pi),)
    problem = dataclasses.replace(sawn(kinks, None), q0=(1.0,), u0=(-5.0,), t_end=2.0, turns=None)
    result = simulate(problem, Settings(tolerance=1e-10))
    plain = simulate(dataclasses.replace(problem, kinks=()), Settings(tolerance=1e-12, check="none"))
    assert result.columns["phi"].min() < -2 * np.pi
    np.testing.assert_allclose(result.columns["phid"], plain.columns["phid"], atol=1e-8)


def test_wanted_times():
    times = (0.1, 0.25, JUMP, 1.7)
    result = simulate(stepped(output=times), Settings(tolerance=1e-11))
    np.testing.assert_array_equal(result.t, [0.0, *times, 3.0])
    np.testing.assert_allclose(result.columns["phi"], step_response(result.t), atol=2e-11)


@pytest.mark.parametrize("name", [n for n in BACKENDS if n != "scipy-dop853"])
def test_backends_agree(name):
    if name == "heyoka":
        pytest.importorskip("heyoka")
    if name == "native" and not any(map(shutil.which, ("gcc", "clang", "cc"))):
        pytest.skip("no C compiler")
    load = Part(
        name="load", input="M", role="load", value=FormulaForce(function=lambda t, q, u: -0.3 * u[0] * abs(u[0]))
    )
    parts = (*stepped().parts, load)
    if name == "heyoka":  # its Taylor series know no absolute value
        parts = (parts[0], dataclasses.replace(load, value=FormulaForce(function=lambda t, q, u: -0.3 * u[0])))
    tolerance, allowed = (1e-6, 1e-3) if name in ("scipy-rk23", "scipy-bdf") else (1e-9, 1e-6)
    result = simulate(stepped(parts=parts), Settings(backend=name, tolerance=tolerance, check="none"))
    best = simulate(stepped(parts=parts), Settings(tolerance=1e-12, check="none"))
    np.testing.assert_array_equal(result.t, best.t)
    for column in ("phi", "phid", "work_drive", "work_load"):
        np.testing.assert_allclose(result.columns[column], best.columns[column], atol=allowed)


@pytest.mark.parametrize("name", ["sundials", "heyoka"])
def test_symbolic_backends_refuse_what_they_cannot_do(name, monkeypatch):
    with pytest.raises(BadInput, match="no events"):
        simulate(braked(), Settings(backend=name))
    with pytest.raises(BadInput, match="plain callables"):
        simulate(stepped(parts=(Part(name="drive", input="M", value=lambda t, q, u: 1.0),)), Settings(backend=name))


def test_missing_heyoka_names_the_extra(monkeypatch):
    monkeypatch.setitem(sys.modules, "heyoka", None)
    with pytest.raises(MissingExtra, match=r"mechsym\[heyoka\]"):
        simulate(stepped(), Settings(backend="heyoka"))


def test_chaos_is_reported():
    problem = Problem(mechanism=double_pendulum(), parts=(), q0=(2.5, 2.0), u0=(0.0, 0.0), t_end=60.0, output=0.05)
    result = simulate(problem, Settings(tolerance=1e-10))
    assert result.status == "chaotic"
    assert abs(result.energy.residual) < 1e-6
    assert "trust it until then" in result.reason
    calm = dataclasses.replace(problem, q0=(0.1, 0.1))
    assert simulate(calm, Settings(tolerance=1e-10)).status == "converged"


def test_loose_tolerance_is_reported():
    result = simulate(stepped(t_end=200.0, output=0.5), Settings(tolerance=1e-2, backend="scipy-rk45"))
    assert result.status == "not converged"
    assert result.tolerance_difference > 1e-4


def test_blow_up_is_a_result():
    # phi'' = phi'^2 goes to infinity at t = 1 / u0
    square = Part(name="drive", input="M", value=FormulaForce(function=lambda t, q, u: 3.0 * u[0] ** 2))
    result = simulate(braked(parts=(square,), speed=1.0, stops=(), t_end=2.0), Settings())
    assert result.status == "failed" and result.end == "failure"
    assert "stopped at t = " in result.reason
    assert result.t[-1] == pytest.approx(1.0, abs=1e-3)
    limited = simulate(stepped(), Settings(max_steps=3))
    assert limited.status == "failed" and "3 steps" in limited.reason


def test_run_without_drive_is_judged_by_its_energy():
    result = simulate(stepped(parts=(), u0=(1.0,)), Settings(tolerance=1e-11))
    assert result.energy.work_in == 0
    assert result.energy.reference == pytest.approx(1.0)
    assert abs(result.energy.residual) < 1e-10


def test_model_without_energies_has_no_residual():
    mechanism = oscillator()
    bare = dataclasses.replace(mechanism, functions={"dynamics": mechanism.functions["dynamics"]})
    result = simulate(stepped(mechanism=bare), Settings(tolerance=1e-11))
    assert result.energy.residual is None and result.energy.change is None
    np.testing.assert_allclose(result.columns["phi"], step_response(result.t), atol=2e-11)


def test_files(tmp_path):
    result = simulate(stepped(), Settings(check="none"))
    lines = write_series(result, tmp_path / "series.csv").read_text().splitlines()
    assert lines[0] == (
        "t [s],phi [rad],phid [rad/s],work_drive [J],dissipation [J],kinetic_energy [J],potential_energy [J]"
    )
    assert len(lines) == len(result.t) + 1
    xr = pytest.importorskip("xarray")
    pytest.importorskip("h5netcdf")
    with xr.open_dataset(write_netcdf(result, tmp_path / "series.nc"), engine="h5netcdf") as data:
        np.testing.assert_array_equal(data["phid"], result.columns["phid"])
        assert data["phid"].attrs["units"] == "rad/s" and data["t"].attrs["units"] == "s"
    assert dataset(result).attrs["status"] == "unchecked"


def test_summary_of_a_uniform_run():
    result = simulate(braked(parts=(), turns=3, output=0.01), Settings(tolerance=1e-11))
    numbers = summary(result, ("phi",), None)
    assert numbers.speed_mean == pytest.approx(10.0, abs=1e-9)
    assert numbers.window == pytest.approx(2 * np.pi / 10.0, abs=1e-12)
    assert numbers.event is None and numbers.end == "turns"
    assert speed_ripple(result, "phi") < 1e-10


def test_summary_of_a_braked_run():
    result = simulate(braked(output=0.01), Settings(tolerance=1e-11))
    speed = dataclasses.asdict(speeds_over(result, ("phi",), 0.0)["phi"])
    assert speed == pytest.approx({"mean": 5.0, "min": 0.0, "max": 10.0}, abs=1e-9)
    # the last turn begins where phi = phi_end - 2 pi, M (t_end - t)^2 / (2 I) = 2 pi
    assert last_period(result, "phi") == pytest.approx(7.5 - np.sqrt(4 * np.pi * 3.0 / 4.0), abs=1e-9)
    assert summary(result, ("phi",), 1.0).event["name"] == "stall"


@pytest.mark.parametrize(
    "changes, words",
    [
        ({"q0": (0.0, 1.0)}, "start has 2 coordinates"),
        ({"t_end": -1.0}, "later than t_start"),
        ({"parts": (Part(name="x", input="F", value=Steps(values=(1.0,))),)}, "part names 'F'"),
        ({"parts": (Part(name="x", input="M", value=Steps(values=(1.0,))),) * 2}, "one name"),
        ({"stops": (Stop(name="s", of="omega"),)}, "stop names 'omega'"),
        ({"kinks": (Kinks(coordinate="alpha", angles=(0.0,), period=1.0),)}, "kinks names 'alpha'"),
        ({"output": 0.0}, "output must be"),
        ({"output": (0.2, 0.1)}, "output must be"),
    ],
)
def test_bad_problems_are_refused(changes, words):
    with pytest.raises(BadInput, match=words):
        stepped(**changes)


def test_bad_parts_are_refused():
    with pytest.raises(BadInput, match="one more value"):
        Steps(times=(1.0,), values=(0.0,))
    with pytest.raises(BadInput, match="times must ascend"):
        Steps(times=(2.0, 1.0), values=(0.0, 1.0, 2.0))
    with pytest.raises(BadInput, match="role = 'brake'"):
        Part(name="x", input="M", role="brake", value=Steps(values=(1.0,)))
    with pytest.raises(BadInput, match="backend = 'euler'"):
        Settings(backend="euler")
    with pytest.raises(BadInput, match="order = 2"):
        fixed_step(stepped(), 0.1, 2)
