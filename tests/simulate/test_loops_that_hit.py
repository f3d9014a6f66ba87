"""Stops, contacts and friction on loops that close by constraint, against the same linkage in closed form."""

import numpy as np
import pytest

from mechsym import cases
from mechsym.jobs.problem import problem_of
from mechsym.simulate import Settings, simulate

HEAD = """from mechsym.derive import Mechanism

def own():
    m = Mechanism("own")
    m.by_constraint = {by}
    phi = m.coordinates("phi")
    crank = m.link("crank", turns=phi, inertia="0.02 kg*m^2", pose="60 deg")
    rod = m.link("rod", mass="0.6 kg", centre=("0.15 m", 0), inertia="5e-3 kg*m^2", pose="-15 deg")
    slider = m.link("slider", mass="1.5 kg")
    m.pin("A", m.frame, crank)
    m.pin("B", crank.at("80 mm"), rod)
    m.slider("G", m.frame.line(), slider)
    m.pin("C", rod.at("300 mm"), slider)
    m.weight(0, -9.81)
    m.spring("600 N/m", stretch=slider.at().x - m.parameters("rest", "m", default="0.25 m"))
{more}
    return m
"""
STOP = '    m.stop(slider.at().x - m.parameters("wall", "m", default="0.3 m"), name="wall", restitution=0.6)\n'
PINS = '    for joint in "BC":\n        m.friction(joint, mu=(0.25, 0.2), radius="12 mm")\n'
SLIDES = '    m.friction("G", mu=0.3)\n'


def run(folder, by, more, start):
    (folder / "own.py").write_text(HEAD.format(by=by, more=more))
    file = folder / "own.toml"
    file.write_text(f'mechanism = "./own.py"\n[start]\n{start}\n[simulation]\nt_end = 0.8\noutput_step = 0.05\n')
    problem = problem_of(cases.load(str(file)))
    assert bool(problem.mechanism.dependents) is by
    return simulate(problem, Settings(tolerance=1e-11, check="none"))


def before_chatter(events):
    """Events up to the first blow that takes less than a microjoule, behind which a bounce is nearly over; of frictions
    that turn at one time, which come in any order, the time."""
    last = next((k for k, e in enumerate(events) if e.kind == "hit" and e.lost < 1e-6), len(events))
    kept = []
    for event in sorted(events[:last], key=lambda e: e.t):
        if event.kind == "hit" or not kept or event.t - kept[-1].t > 1e-7:
            kept.append(event)
    return kept


@pytest.mark.slow
@pytest.mark.parametrize(
    ("more", "start"),
    [(STOP, "phi = 1.0"), (PINS, "phi = 1.0"), (STOP + SLIDES, "phi = 1.0\nphid = 3"), (STOP + PINS, "phi = 0.9")],
    ids=["stop", "pins that rub", "stop and slide that rubs", "stop and pins that rub"],
)
def test_a_loop_by_constraint_hits_and_rubs_as_one_in_closed_form(tmp_path, more, start):
    here, there = (run(tmp_path, by, more, start) for by in (True, False))
    ours, others = (before_chatter(one.happened.events) for one in (here, there))
    assert [e.kind for e in ours] == [e.kind for e in others]
    assert len(others) > 1
    for a, b in zip(ours, others, strict=True):
        assert a.t == pytest.approx(b.t, abs=1e-9)
        assert a.lost == pytest.approx(b.lost, abs=1e-8)
    for name in ("phi", "phid"):
        np.testing.assert_allclose(here.columns[name], there.columns[name], atol=1e-8)
    assert abs(here.energy.residual) < 1e-9
