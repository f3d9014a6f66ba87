"""The derivation core on machines with known answers, and what it refuses."""

import pytest
import sympy as sp

from mechsym.derive import Mechanism, cos, derive, sin
from mechsym.derive.emit import module_text
from mechsym.derive.tape import Intermediates, derivative_name
from mechsym.derive.textbook import disagreements, proved
from mechsym.errors import BadInput


def pendulum():
    m = Mechanism("pendulum", source="textbook")
    phi = m.coordinates("phi")
    m1, l = m.parameters("m1", "kg"), m.parameters("l", "m")
    g = m.parameters("g", "m/s^2")
    x_O, y_O = m.joints("x_O y_O", "pivot on rod")
    m.body("bob", mass=m1, at=(l * sin(phi) + x_O, -l * cos(phi) + y_O), turns=phi)
    m.weight(0, -g)
    return m


def double_pendulum():
    m = Mechanism("double_pendulum", source="textbook")
    a, b = m.coordinates("a b")
    m1, m2 = m.parameters("m1 m2", "kg")
    l1, l2 = m.parameters("l1 l2", "m")
    I2 = m.parameters("I2", "kg*m^2")
    g = m.parameters("g", "m/s^2")
    m.body("upper", mass=m1, at=(l1 * sin(a), -l1 * cos(a)), turns=a)
    m.body("lower", mass=m2, at=(l1 * sin(a) + l2 * sin(b), -l1 * cos(a) - l2 * cos(b)), turns=b, inertia=I2)
    m.weight(0, -g)
    return m


def flat(equations, expression):
    held = dict.fromkeys(equations.mechanism.joint_list, 0)
    return equations.mechanism.tape.flat(expression).xreplace(held)


def letter(name):
    return sp.Symbol(name, real=True)


def test_pendulum_has_the_textbook_equation():
    e = derive(pendulum())
    m1, l, g, phi = map(letter, ("m1", "l", "g", "phi"))
    assert sp.simplify(flat(e, e.mass_matrix[0][0]) - m1 * l**2) == 0
    assert sp.simplify(flat(e, e.bias[0])) == 0
    assert sp.simplify(flat(e, e.generalized_force[0]) + m1 * g * l * sin(phi)) == 0
    assert sp.simplify(flat(e, e.potential_energy) + m1 * g * l * cos(phi)) == 0


def test_pendulum_pivot_carries_weight_and_centripetal_force():
    e = derive(pendulum())
    m1, l, g, phi, phid, phidd = map(letter, ("m1", "l", "g", "phi", "phid", "phidd"))
    x = m1 * l * (cos(phi) * phidd - sin(phi) * phid**2)
    y = m1 * l * (sin(phi) * phidd + cos(phi) * phid**2) + m1 * g
    assert sp.simplify(flat(e, e.reactions["R_x_O"]) - x) == 0
    assert sp.simplify(flat(e, e.reactions["R_y_O"]) - y) == 0


@pytest.mark.parametrize("declare", [pendulum, double_pendulum])
def test_geometric_form_is_the_textbook_lagrangian(declare):
    e = derive(declare())
    assert disagreements(e) == []
    assert proved(e)


def test_a_wrong_bias_is_noticed():
    import dataclasses

    e = derive(double_pendulum())
    spoiled = dataclasses.replace(e, bias=(e.bias[0], e.bias[1] * 2))
    assert disagreements(spoiled) == ["b"]
    assert not proved(spoiled)


def test_springs_and_dampers_enter_by_virtual_work():
    m = Mechanism("oscillator", source="textbook")
    x = m.coordinates("x", "m")
    mass, k, c = m.parameters("m", "kg"), m.parameters("k", "N/m"), m.parameters("c", "N*s/m")
    F = m.inputs("F", "N")
    m.body("block", mass=mass, at=(x, 0))
    m.spring(k, stretch=x)
    m.damper(c, stretch=x)
    m.force_at((F, 0), (x, 0))
    e = derive(m)
    assert sp.expand(e.generalized_force[0] - (F - k * x - c * letter("xd"))) == 0


def test_a_spring_that_nothing_stretches_is_refused():
    m = Mechanism("oscillator", source="textbook")
    x = m.coordinates("x", "m")
    k = m.parameters("k", "N/m")
    with pytest.raises(BadInput, match="moves with no coordinate"):
        m.spring(k, stretch=x - x)


def test_constraints_give_jacobian_and_bias():
    m = Mechanism("bead", source="textbook")
    x, y = m.coordinates("x y", "m")
    mass, l = m.parameters("m", "kg"), m.parameters("l", "m")
    m.body("bead", mass=mass, at=(x, y))
    m.constraint("rod", x**2 + y**2 - l**2)
    e = derive(m)
    assert [sp.expand(v) for v in e.constraint_jacobian[0]] == [2 * x, 2 * y]
    assert sp.expand(e.constraint_bias[0] - 2 * letter("xd") ** 2 - 2 * letter("yd") ** 2) == 0
    assert '"constraints"' in module_text(e, "derivations/bead.py", "0" * 16)


def test_derivatives_are_named_once():
    phi = letter("phi")
    tape = Intermediates([phi])
    x = tape.define("x", sp.sin(phi) ** 3)
    first = tape.derivative(x, phi)
    assert first.name == "dx_dphi"
    assert tape.derivative(first, phi).name == "d2x_dphi2"
    assert tape.derivative(x, phi) is first
    assert sp.expand(tape.flat(tape.derivative(first, phi)) - sp.diff(sp.sin(phi) ** 3, phi, 2)) == 0


def test_names_of_derivatives_stay_readable():
    assert derivative_name("x0", ["phi0", "phi0"]) == "d2x0_dphi0_dphi0"
    assert derivative_name("x", ["phi", "theta"]) == "d2x_dphi_dtheta"


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [("x", sp.Float(0.5), "floating-point"), ("2x", 1, "usable name"), ("_t0", 1, "usable name"), ("phi", 1, "taken")],
)
def test_unusable_names_and_floats_are_refused(name, value, message):
    with pytest.raises(ValueError, match=message):
        Intermediates([letter("phi")]).define(name, value)


def test_undeclared_letters_are_refused_by_name():
    m = pendulum()
    with pytest.raises(ValueError, match=r"test_core.py:\d+: the letter 'Q9' is not declared"):
        m.force(letter("Q9"), along=letter("phi"))


def test_a_letter_declared_twice_is_refused():
    m = pendulum()
    with pytest.raises(ValueError, match="twice"):
        m.parameters("l", "m")
