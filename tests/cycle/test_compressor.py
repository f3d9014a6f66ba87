"""The cycle of a compressor: its work in closed form, its valves, pistons with an offset, what is refused."""

import casadi as ca
import numpy as np
import pytest

from mechsym.cycle.chamber import chamber_over, volume
from mechsym.cycle.kinds import gas_in_cylinder
from mechsym.cycle.kinds.compressor import CompressorCycle, valves
from mechsym.errors import BadInput
from mechsym.machine.loads import ConstantLoad, PropellerLoad, settle

AIR = {"bore": 0.08, "compression_ratio": 21.0, "p_suction": 1e5, "p_delivery": 8e5, "n_c": 1.3, "n_e": 1.2}


def slider_crank(r=0.035, l=0.14, e=0.0):
    """Travel of a piston from its top dead centre on."""
    phi = ca.SX.sym("phi")
    top = np.arcsin(e / (l + r))
    angle = phi + top
    x = np.sqrt((l + r) ** 2 - e**2) - r * ca.cos(angle) - ca.sqrt(l**2 - (e - r * ca.sin(angle)) ** 2)
    return ca.Function("travel", [phi], [x, ca.jacobian(x, phi)], ["phi"], ["x", "dx_dphi"])


@pytest.mark.parametrize("offset", [0.0, 0.02])
def test_its_work_is_that_of_the_p_v_diagram(offset):
    cycle = CompressorCycle(**AIR)
    gas = gas_in_cylinder(cycle, slider_crank(e=offset))
    pressure, room = gas.pressure, gas.chamber
    full, least, ratio = room.clearance + room.displacement, room.clearance, 8.0
    V2, V4 = full * ratio ** (-1 / 1.3), least * ratio ** (1 / 1.2)
    compression = (8e5 * V2 - 1e5 * full) / (1.3 - 1)
    expansion = (8e5 * least - 1e5 * V4) / (1.2 - 1)
    taken = compression + 8e5 * (V2 - least) - expansion - 1e5 * (full - V4)
    assert pressure.mean_indicated * room.displacement == pytest.approx(-taken, rel=1e-9)
    assert pressure.p_max == pytest.approx(8e5, rel=1e-12) and pressure.period == 2 * np.pi


def test_an_offset_moves_the_bottom_dead_centre_and_lengthens_the_stroke():
    r, l, e = 0.035, 0.14, 0.02
    room = chamber_over(slider_crank(e=e), 0.08, 21.0)
    assert room.stroke == pytest.approx(np.sqrt((l + r) ** 2 - e**2) - np.sqrt((l - r) ** 2 - e**2), rel=1e-12)
    assert room.motion.bottom == pytest.approx(np.pi + np.arcsin(e / (l - r)) - np.arcsin(e / (l + r)), rel=1e-9)
    assert chamber_over(slider_crank(), 0.08, 21.0).motion.bottom == np.pi  # to the last digit


def test_valves_open_where_the_pressures_are_reached():
    gas = gas_in_cylinder(CompressorCycle(**AIR), slider_crank(e=0.01))
    pressure, room = gas.pressure, gas.chamber
    events = valves(CompressorCycle(**AIR), room)
    assert events["suction valve closes"] == room.motion.bottom
    assert float(volume(room, events["delivery valve opens"])) == pytest.approx(
        (room.clearance + room.displacement) * 8 ** (-1 / 1.3), rel=1e-12
    )
    assert sorted(pressure.kinks) == sorted(events.values())
    for angle, level in (("suction valve opens", 1e5), ("delivery valve opens", 8e5)):
        around = pressure.absolute(events[angle] + np.array([-1e-9, 1e-9]))
        assert around == pytest.approx([level, level], rel=1e-7)
    phi = np.linspace(0, 4 * np.pi, 2001)
    p = pressure.absolute(phi)
    assert (p >= 1e5 * (1 - 1e-12)).all() and (p <= 8e5 * (1 + 1e-12)).all()
    assert p[:1000] == pytest.approx(p[1000:2000], rel=1e-9)


def test_what_delivers_nothing_is_refused():
    with pytest.raises(BadInput, match="nothing is delivered"):
        CompressorCycle(**AIR | {"compression_ratio": 5.0})
    with pytest.raises(BadInput, match="must be above p_suction"):
        CompressorCycle(**AIR | {"p_delivery": 0.9e5})


def test_a_machine_that_takes_work_is_driven_by_a_steady_torque():
    assert settle(PropellerLoad(), -12.0, 94.0) == ConstantLoad(torque=-12.0)
    assert settle(PropellerLoad(), 12.0, 94.0) == PropellerLoad(torque=12.0, speed=94.0)
