"""Bad declarations of stops, contacts, backlash and friction: written before the code, one line each with its line."""

import pytest
from sympy import Rational

from mechsym.derive import Mechanism, derive
from mechsym.errors import BadInput


def begin():
    m = Mechanism("bad")
    x = m.coordinates("x", "m")
    phi = m.coordinates("phi")
    m1, l, r = m.parameters("m1", "kg", above=0), *m.parameters("l r", "m", above=0)
    mu, N = m.parameters("mu", "-"), m.parameters("N", "N")
    m.body("block", mass=m1, at=(x, 0))
    arm = m.link("arm", turns=phi, mass=m1, inertia=m1 * l**2, centre=(l, 0))
    m.pin("A", m.frame, arm)
    m.gear_wheel = arm
    return m, x, phi, arm, {"mu": mu, "N": N, "l": l, "r": r, "m1": m1}


BAD = {
    "stop of nothing": (lambda m, x, phi, arm, s: m.stop(s["l"], restitution=0, name="s"), "moves with no coordinate"),
    "stop of a mass": (lambda m, x, phi, arm, s: m.stop(x * s["m1"], restitution=0, name="s"), "give a length or an"),
    "stop at a mass": (lambda m, x, phi, arm, s: m.stop(x, at=s["m1"], restitution=0), "must be in m"),
    "stop at an angle": (lambda m, x, phi, arm, s: m.stop(phi, at=s["l"], restitution=0), "must be in rad"),
    "neither law": (lambda m, x, phi, arm, s: m.stop(x), "takes restitution, or stiffness and damping"),
    "both laws": (lambda m, x, phi, arm, s: m.stop(x, restitution=0, stiffness=1e5), "give one of the two"),
    "damping alone": (lambda m, x, phi, arm, s: m.stop(x, restitution=0, damping=0.1), "without stiffness"),
    "restitution 2": (lambda m, x, phi, arm, s: m.stop(x, restitution=2), "at most 1"),
    "restitution below": (lambda m, x, phi, arm, s: m.stop(x, restitution=-0.1), "must be 0 or above"),
    "restitution in m": (lambda m, x, phi, arm, s: m.stop(x, restitution=s["l"]), "must be in -"),
    "restitution moves": (lambda m, x, phi, arm, s: m.stop(x, restitution=phi), "write it in parameters"),
    "stiffness of torsion": (lambda m, x, phi, arm, s: m.stop(phi, stiffness="3 N/m"), "3 N/m"),
    "stiffness below": (lambda m, x, phi, arm, s: m.stop(x, stiffness=-3), "must be 0 or above"),
    "side": (lambda m, x, phi, arm, s: m.stop(x, side=2, restitution=0), "must be 1"),
    "stop without name": (lambda m, x, phi, arm, s: m.stop(2 * x, restitution=0), "has no name; give name="),
    "stop twice": (lambda m, x, phi, arm, s: [m.stop(x, restitution=0) for _ in "ab"], "is declared twice"),
    "name of a stop": (lambda m, x, phi, arm, s: m.stop(x, restitution=0, name="a b"), "is not a usable name"),
    "a text": (lambda m, x, phi, arm, s: m.stop("x", restitution=0), "is no expression"),
    "two points": (lambda m, x, phi, arm, s: m.contact("c", arm, m.frame, restitution=0), "is of two points"),
    "no point": (lambda m, x, phi, arm, s: m.contact("c", x, m.frame.line(), restitution=0), "is no link and no point"),
    "one radius": (lambda m, x, phi, arm, s: m.contact("c", arm, m.frame, radii=s["r"], restitution=0), "is no pair"),
    "gain": (
        lambda m, x, phi, arm, s: m.contact(
            "c", arm.at(s["l"]), m.frame.line(), restitution=Rational(1, 2), friction=s["mu"]
        ),
        "may gain energy",
    ),
    "friction on circles": (
        lambda m, x, phi, arm, s: m.contact("c", arm, m.frame, radii=(s["r"], 0), restitution=0, friction=s["mu"]),
        "needs a line of the frame",
    ),
    "turn not known": (
        lambda m, x, phi, arm, s: m.contact(
            "c", (x, x), m.frame.line(), radii=(s["r"], 0), restitution=0, friction=s["mu"]
        ),
        "whose turn is not known",
    ),
    "play in a mass": (lambda m, x, phi, arm, s: m.backlash("b", phi, angle=s["m1"], restitution=0), "must be in rad"),
    "play of nothing": (lambda m, x, phi, arm, s: m.backlash("b", s["mu"], angle=1, restitution=0), "no coordinate"),
    "no joint": (lambda m, x, phi, arm, s: m.friction("Z", mu=s["mu"]), "which is none; there are A"),
    "joint and normal": (lambda m, x, phi, arm, s: m.friction("A", mu=s["mu"], normal=s["N"]), "leave normal out"),
    "pin without radius": (lambda m, x, phi, arm, s: m.friction("A", mu=s["mu"]), "give the radius"),
    "radius of a length": (
        lambda m, x, phi, arm, s: m.friction(x, mu=s["mu"], normal=s["N"], radius=s["r"]),
        "leave radius out",
    ),
    "pressed by nothing": (lambda m, x, phi, arm, s: m.friction(x, mu=s["mu"]), "is pressed by nothing"),
    "mu below": (lambda m, x, phi, arm, s: m.friction(x, mu=-0.2, normal=s["N"]), "must be 0 or above"),
    "mu the other way": (lambda m, x, phi, arm, s: m.friction(x, mu=(0.1, 0.3), normal=s["N"]), "sticks less than"),
    "three mu": (lambda m, x, phi, arm, s: m.friction(x, mu=(1, 1, 1), normal=s["N"]), "must be one value, or two"),
    "mu in N": (lambda m, x, phi, arm, s: m.friction(x, mu=s["N"], normal=s["N"]), "must be in -"),
    "law": (lambda m, x, phi, arm, s: m.friction(x, mu=s["mu"], normal=s["N"], law="dry"), "is not known; there are"),
    "smooth": (lambda m, x, phi, arm, s: m.friction(x, mu=s["mu"], normal=s["N"], law="smooth"), "smoothing=.."),
    "smoothing of sticking": (
        lambda m, x, phi, arm, s: m.friction(x, mu=s["mu"], normal=s["N"], smoothing=1),
        "set-valued one over none",
    ),
    "normal in m": (lambda m, x, phi, arm, s: m.friction(x, mu=s["mu"], normal=s["l"]), "must be in N"),
    "friction of nothing": (
        lambda m, x, phi, arm, s: m.friction(s["l"], mu=s["mu"], normal=s["N"], name="f"),
        "moves with no coordinate",
    ),
    "viscous of torsion": (
        lambda m, x, phi, arm, s: m.friction(x, mu=s["mu"], normal=s["N"], viscous="1 N*m*s/rad"),
        "viscous",
    ),
}


@pytest.mark.parametrize("what", BAD)
def test_bad_declarations_are_refused_in_one_line(what):
    call, words = BAD[what]
    m, *parts = begin()
    with pytest.raises(BadInput) as refused:
        call(m, *parts)
    assert words in str(refused.value)
    assert "\n" not in str(refused.value)
    assert "test_unilateral.py:" in str(refused.value)


def test_a_stop_acts_along_its_gap_and_a_friction_along_what_slides():
    """Virtual work: the generalised force of each own input is the slope of what it acts along."""
    m, x, phi, arm, s = begin()
    m.stop(x, at=s["l"], side=-1, restitution=0.5)
    m.friction("A", mu=(s["mu"], 0.1), radius="20 mm")
    equations = derive(m)
    stop, turn = m.input_list
    assert [e.diff(stop) for e in equations.generalized_force] == [-1, 0]
    assert [e.diff(turn) for e in equations.generalized_force] == [0, 1]
    (role,) = m.roles["friction"]
    assert role["reactions"] == ["R_x_A", "R_y_A"]
    assert (role["mu_s"], role["mu_k"]) == ("mu", "friction_A_mu_k")
