"""A start for a mechanism of one's own: declaration, case and test, commented, ready to run."""

from pathlib import Path

from mechsym.errors import BadInput
from mechsym.files import write_text

_DECLARATION = '''"""NAME: say what it is, and draw it with its letters.

          y ^         A
            |   r  . ' ' - .  l          x from the shaft O towards the head, phi = 0 at top dead centre.
            | . ' phi        ' - .       F on the piston, positive away from the head.
            O - - - - - - - - - - B ==[] x
"""

from mechsym.derive import Mechanism


def NAME():
    m = Mechanism("NAME", about="A slider crank to start from.")
    # letters with their units and ranges
    phi = m.coordinates("phi")
    r, l = m.parameters("r l", "m", above=0)
    m_rod, m_piston = m.parameters("m_rod m_piston", "kg", above=0)
    I, I_rod = m.parameters("I I_rod", "kg*m^2", above=0)
    F, M_r = m.inputs("F", "N"), m.inputs("M_r", "N*m")
    # links with axes of their own; a point of one is link.at(u, v)
    crank = m.link("crank", turns=phi, inertia=I)
    rod = m.link("rod", mass=m_rod, centre=(l / 3, 0), inertia=I_rod)
    piston = m.link("piston", mass=m_piston)
    # joints: the first link acts on the second
    m.pin("O", m.frame, crank)
    m.pin("A", crank.at(r), rod)
    m.slider("G", m.frame, piston)
    m.pin("B", rod.at(l), piston)
    # what acts, and what parts are for
    x = m.let("x", r + l - piston.at().x, "m")
    m.force(F, along=x)
    m.torque(-M_r, along=phi)
    m.piston("piston", travel=x, force=F)
    m.rotor("crank", angle=phi, load=M_r)
    return m
'''
_CASE = """mechanism = "./NAME.py"
about = "NAME with assumed data"

[parameters]  # assumed: replace by yours, with where each value comes from
r = "50 mm"
l = "160 mm"
m_rod = "0.6 kg"
m_piston = "0.5 kg"
I = "0.05 kg*m^2"
I_rod = "0.003 kg*m^2"

[operation]
speed = "1500 rpm"

[inputs]  # constants, for inputs that nothing else drives
F = "500 N"

[simulation]
t_end = "0.2 s"
speed_start = "1500 rpm"
"""
_TEST = '''"""What must hold for NAME whatever its numbers are. Run it with pytest."""

from pathlib import Path

import numpy as np

from mechsym import cases
from mechsym.derive import derive
from mechsym.derive.autodiff import disagreement
from mechsym.derive.files import chosen
from mechsym.jobs import own, own_gas, own_turn
from mechsym.jobs.problem import problem_of, settings_of
from mechsym.simulate import simulate

HERE = Path(__file__).parent
CASE = cases.load(str(HERE / "NAME.toml"))


def test_the_equations_are_those_of_the_textbook():
    states, difference = disagreement(derive(chosen(HERE / "NAME.py")))
    assert states > 0 and difference < 1e-9


def test_a_run_keeps_its_energy():
    result = simulate(problem_of(CASE), settings_of(CASE))
    assert result.status == "converged" and abs(result.energy.residual) < 1e-8


def test_virtual_work_and_finite_differences_agree():
    found = own_turn.turn(CASE)
    assert found.power_residual < 1e-12
    x, phi = found.columns["x"], found.phi
    spectrum = np.fft.rfft(x) * 1j * np.arange(len(phi) // 2 + 1)
    np.testing.assert_allclose(np.fft.irfft(spectrum, len(phi)), found.columns["dx_dphi"], atol=1e-9 * np.ptp(x))
    dynamics = own.one_coordinate(CASE).functions["dynamics"]
    with_force, without = (float(dynamics(1.0, 0.0, F, 0.0)[2]) for F in (1.0, 0.0))
    step = 1e-6
    travel = own_gas.travel_of(own.one_coordinate(CASE), "x")
    slope = (float(travel(1.0 + step)[0]) - float(travel(1.0 - step)[0])) / (2 * step)
    assert abs(with_force - without - slope) < 1e-8
'''


def write(name: str, folder: Path) -> list[Path]:
    """Write declaration, case and test of a new mechanism; nothing that exists is overwritten."""
    if not name.isidentifier() or name.startswith("_"):
        raise BadInput(f"{name!r} cannot name a mechanism; use letters, digits and inner underscores")
    texts = {f"{name}.py": _DECLARATION, f"{name}.toml": _CASE, f"test_{name}.py": _TEST}
    for file in texts:
        if (folder / file).exists():
            raise BadInput(f"{folder / file} exists; choose another name or remove it")
    return [write_text(folder / file, text.replace("NAME", name)) for file, text in texts.items()]
