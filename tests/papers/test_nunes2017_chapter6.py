"""Chapter 6 of Nunes (2017): each of its sentences has a verdict."""

import os
import re
from pathlib import Path

import numpy as np
import pytest

from mechsym.cases import load
from mechsym.cycle.engine import over_speeds
from mechsym.errors import BadInput
from mechsym.jobs.cycle import engine
from mechsym.papers import rows as record
from mechsym.papers.nunes2017 import outlook, rows
from mechsym.quantities import RPM

SEEDS = Path(os.environ.get("MECHSYM_TEST_SEEDS") or "/nowhere")
HEADINGS = {"Chapter 6", "Conclusions", "6.1 Alternative Materials and Possible Improvements", "6.2 Future Work"}


@pytest.fixture(scope="module")
def recorded():
    return [one for one in record.stored("mechsym.papers") if one["source"].startswith("004")]


@pytest.mark.skipif(not SEEDS.is_dir(), reason="the sources' texts need MECHSYM_TEST_SEEDS, the folder that holds them")
def test_no_sentence_of_the_text_is_left_out():
    (file,) = SEEDS.glob("004_*.txt")
    text = file.read_text()
    chapter = text[text.rindex("Chapter 6\n") :].partition("\nBibliography")[0]
    paragraphs = [p.strip() for p in chapter.split("\n\n") if p.strip() and p.strip() not in HEADINGS]
    sentences = [s for p in paragraphs for s in re.split(r"(?<=[.\]])\s+(?=[A-Z])", p)]
    assert len(sentences) == len(rows.SENTENCES) > 30
    for written, known in zip(sentences, rows.SENTENCES, strict=True):
        assert written.startswith(known.begins)


def test_each_sentence_has_a_verdict_in_the_record(recorded):
    items = {one["item"]: one["verdict"] for one in recorded}
    for one in rows.SENTENCES:
        assert one.decided or one.left
        for start in one.decided:
            assert any(item.startswith(start) for item in items), start
        if one.left:
            assert items[f"section {one.section}: {one.begins!r} .."] == "not computable"


def test_a_row_of_chapter_6_belongs_to_a_sentence(recorded):
    starts = tuple(start for one in rows.SENTENCES for start in one.decided)
    begins = tuple(f"section {one.section}: {one.begins!r}" for one in rows.SENTENCES)
    mine = [one["item"] for one in recorded if one["item"].startswith("section 6")]
    assert len(mine) > 30 and all(item.startswith(starts + begins) for item in mine)


def test_a_row_that_is_missing_is_noticed():
    with pytest.raises(BadInput, match="no row begins with 'section 6: average torque"):
        rows.undecided([])


def test_not_falling_behind_is_decided_by_the_two_engines(recorded):
    changes = {"cycle.vaporisation": "liquid_energy", "chamber.back_pressure": "101325 Pa"}
    speeds = np.array([500.0, 8000.0]) * RPM
    a, b = (
        over_speeds(engine(load(f"nunes-{n}", changes)), speeds).torque_avg for n in ("hypocycloid", "slider-crank")
    )
    kept = [one["computed"] for one in recorded if one["item"].startswith("section 6: average torque")]
    assert kept == pytest.approx((a / b).tolist(), rel=1e-6)


def test_rows_from_maps_are_the_recorded_ones(recorded):
    known = {one["item"]: one for one in recorded}
    found = [outlook._compression(), outlook._boost()]
    for one in found:
        assert one.computed == pytest.approx(known[one.item]["computed"], rel=1e-6)
        assert one.verdict == known[one.item]["verdict"]
