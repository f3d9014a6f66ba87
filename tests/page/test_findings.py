"""What has to be known first: every critical near the speed, missed targets, runs that drift, ideal models; and no
word of praise beside them.
"""

import json
import math
import re
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from scipy.optimize import brentq

from mechsym.cli import mechsym
from mechsym.page.finding import Finding, ranked, title_mark
from mechsym.simulate.result import period_means

RECORDED = Path(__file__).parents[1] / "recorded"
PRAISE = re.compile(r"\b(optimal|converged|within all limits|can be built)\b")


def records(*commands):
    """Records of commands that have findings, with their name."""
    for path in sorted(RECORDED.glob("*/*.json")):
        if path.stem in commands:
            found = json.loads(path.read_text(encoding="utf-8"))
            if "json" in found:
                yield f"{path.parent.name}/{path.stem}", found


def test_every_critical_within_a_tenth_is_told_first():
    seen = 0
    for name, found in records("simulate", "forces"):
        told = found["json"]["headline"]
        first = "\n".join(found["text"][: len(told)])
        for one in (found["json"]["vibration"] or {}).get("criticals", ()):
            away = abs(one["speed"] / found["json"]["vibration"]["omega"] - 1)
            if away <= 0.1:
                seen += 1
                assert away > 0.02 or min(row["rank"] for row in told) == 1, name
                assert f"order {one['order']:g} is critical" in first, name
                assert any(row["value"] == pytest.approx(one["away"], abs=1e-8) for row in told), name
    assert seen >= 3


def test_a_missed_target_and_a_shaft_that_stops_are_not_met():
    seen = 0
    for name, found in records("hinge"):
        missed = not found["json"]["target"]["met"]
        rows = [row for row in found["json"]["headline"] if row["rank"] == 1 and row["words"] in found["text"][0]]
        assert [row["rank"] for row in rows] == [1] * missed, name
        stops = found["json"]["misfire_speed_share"] == 0
        assert any("stops the shaft" in row["words"] for row in found["json"]["headline"]) == stops, name
        seen += missed
    assert seen >= 3


def test_a_cycle_with_the_efficiency_of_carnot_is_an_upper_bound():
    (found,) = (one for name, one in records("cycle") if name == "alpha-stirling/cycle")
    (row,) = found["json"]["headline"]
    assert row["value"] == pytest.approx(1 - 330 / 900, abs=1e-9) and "upper bound" in found["text"][0]
    beale = 0.15 * 5e5 * (600 / 60) * math.pi / 4 * 0.09**2 * 0.12  # of the case's mean pressure, speed, bore, stroke
    assert f"about {round(beale, -1):.0f} W (Beale's rule" in row["words"]
    for name, other in records("cycle"):
        hot, cold = (other["json"].get(key) for key in ("T_e_max_k", "T_c_min_k"))
        ideal = bool(hot) and abs(other["json"]["efficiency"][0] - (1 - cold[0] / hot[0])) < 1e-6
        assert ideal == bool(other["json"].get("headline")), name


def test_no_word_of_praise_stands_beside_what_is_not_met_or_not_settled():
    seen = 0
    for name, found in records("simulate", "forces", "hinge", "cycle", "flywheel"):
        if any(row["rank"] < 3 for row in found["json"].get("headline", ())):
            seen += 1
            assert [line for line in found["text"] if PRAISE.search(line)] == [], name
    assert seen >= 8


def test_a_flywheel_for_a_shaft_that_twists_says_so_first():
    for name, found in records("flywheel"):
        if "json" in found and found["json"]:
            assert found["json"]["twists"] == ("rigid shaft" in "".join(found["text"][:1])), name


class Decaying:
    """A shaft whose speed dies out to 100 rad/s: phi = 100 t + 20 (1 - exp(-t))."""

    t = np.linspace(0.0, 1.0, 4001)
    columns = {"phi": 100 * t + 20 * (1 - np.exp(-t))}


def test_means_over_each_period_are_those_of_the_closed_form():
    ends = [brentq(lambda t, k=k: 100 * t + 20 * (1 - math.exp(-t)) - 4 * math.pi * k, 0, 1) for k in range(5)]
    wanted = 4 * math.pi / np.diff(ends)
    means = period_means(Decaying(), "phi", 4 * math.pi)
    assert means[:4] == pytest.approx(wanted, rel=1e-6) and means[-1] < means[0]


def test_the_worst_colours_the_title_and_each_sentence_stands_once():
    one, two = Finding(rank=3, words="a"), Finding(rank=1, words="b")
    assert ranked([one, two, one]) == (two, one)
    assert [title_mark(rows) for rows in ([], [one], [one, two], [Finding(rank=2, words="c")])] == [
        "",
        "",
        "no",
        "open",
    ]


@pytest.mark.parametrize(("case", "mark"), [("alpha-stirling", "open"), ("nunes-hypocycloid", "")])
def test_the_report_has_it_before_its_cards(case, mark, tmp_path):
    done = CliRunner().invoke(mechsym, ["report", case, "--parts", "cycle", "--out", str(tmp_path)])
    assert done.exit_code == 0, done.output
    text = (tmp_path / f"{case}-report.html").read_text(encoding="utf-8")
    assert f'<h1 class="{mark}">' in text
    assert ("upper bound" in text.partition('class="card"')[0]) == bool(mark)
