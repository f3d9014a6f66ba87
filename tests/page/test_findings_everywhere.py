"""Over new engines, examples and all built-in cases: what is not met or near a critical heads the report, and no word
or colour of praise stands beside it.
"""

import re
from pathlib import Path

import pytest

from mechsym import cases
from mechsym.cases.new_engine import write_engine
from mechsym.quantities.results import tell
from mechsym.report import case_report, html

PRAISE = re.compile(r"\b(optimal|converged|within all limits)\b|<b class=\"yes\"")
NEW = [
    ("inline", 0.086, 0.086, 1), ("inline", 0.086, 0.086, 4), ("inline", 0.3, 0.38, 6), ("inline", 0.08, 0.09, 3),
    ("v", 0.09, 0.08, 2), ("v", 0.1, 0.1, 6), ("v", 0.084, 0.09, 8), ("opposed", 0.08, 0.08, None),
    ("two-stroke-crosshead", 0.5, 2.0, 1), ("two-stroke-crosshead", 0.26, 0.9, 6), ("hypocycloid", 0.056, 0.052, None),
    ("inline", 0.05, 0.04, 2),
]  # fmt: skip
EXAMPLES = sorted((Path(__file__).parents[2] / "examples" / "mechanisms").glob("*.toml"))


def judged(case):
    """How many criticals within a tenth of the speed the forces and the run of a case have; its page tells each."""
    report = case_report(case, ["forces", "simulate"])
    head, _, rest = html([report]).partition('<h2 id="case-1">')
    near = 0
    for part in report.parts:
        vibration = (tell(part.numbers) or {}).get("vibration") if part.name in ("forces", "simulate") else None
        for one in (vibration or {}).get("criticals", ()):
            # an order that carries less than a hundredth of a rigid shaft's torque swings nothing
            if abs(one["speed"] / vibration["omega"] - 1) <= 0.1 and one["torque"] > 0.01 * vibration["torque_rigid"]:
                near += 1
                assert f"order {one['order']:g} is critical" in head, case.name
    worst = min((f.rank for part in report.parts for f in part.findings), default=3)
    if worst < 3:
        assert f'<h1 class="{"no" if worst == 1 else "open"}">' in head
        assert not PRAISE.search(head + rest.partition("<nav")[0]), case.name
    unsettled = any("not settled" in f.words or "too short" in f.words for part in report.parts for f in part.findings)
    assert not unsettled or "settled" in head
    return near


FEW = (1, 10)  # of them in the slow suite


@pytest.mark.slow
@pytest.mark.parametrize("k", [k if k in FEW else pytest.param(k, marks=pytest.mark.heavy) for k in range(len(NEW))])
def test_of_a_new_engine(k, tmp_path):
    kind, bore, stroke, cylinders = NEW[k]
    path, *_ = write_engine(kind, bore, stroke, cylinders, tmp_path)
    judged(cases.load(str(path)))


SHIPPED = [*cases.names(), *(str(path) for path in EXAMPLES)]
NEAR = "alpha-stirling"  # whose third order is critical at its speed


@pytest.mark.slow
@pytest.mark.parametrize("name", [n if n == NEAR else pytest.param(n, marks=pytest.mark.heavy) for n in SHIPPED])
def test_of_a_shipped_case_or_example(name):
    assert (judged(cases.load(name)) > 0) >= (name == NEAR)
