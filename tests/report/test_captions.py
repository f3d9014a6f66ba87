"""What a caption says is what its picture shows: every number with a unit is read off what is drawn."""

import dataclasses
import re

import numpy as np
import pytest

from mechsym import cases
from mechsym.quantities.units import scale
from mechsym.report import case_report

# the speed at which something is done is said, not drawn
_NUMBER = re.compile(
    r"(?<!at )(?<![\d.])(-?\d[\d.]*(?:e-?\d+)?) (%|MPa|kPa|bar|kN\*m|N\*m|kN|N|kJ|J|kW|W|rpm|deg|mm)(?![\w/])"
)
_UNIT = re.compile(r"\[(.*?)\]")
_READINGS = (
    np.min, np.max, np.ptp, np.mean, lambda v: np.abs(v).max(), lambda v: np.ptp(v) / (abs(np.mean(v)) or 1.0)
)  # fmt: skip


def drawn(figure):
    """What may be read off a picture, in SI: extremes, swings and means of curves, of their ends and between them."""
    read = []
    for axis in figure.axes:
        curves = []
        for label, values in curves_of(axis):
            unit = _UNIT.search(label)
            if unit is not None and len(values):
                factor = scale(unit[1].replace("N m", "N*m")) if unit[1] != "-" else 1.0
                curves.append(factor * np.asarray(values, dtype=float))
        for values in curves:
            parts = (values, values[len(values) - len(values) // 10 :])
            read += [reading(part) for part in parts if len(part) for reading in _READINGS]
        for one, other in ((a, b) for a in curves for b in curves if len(a) == len(b)):
            far = np.hypot(one, other)
            read += [np.abs(one - other).max(), far.min(), far.max()]
    return np.array(read, dtype=float)


def curves_of(axis):
    """Label of the axis and values of lines, bands and bars, both ways, and of means that a legend tells."""
    across, up = axis.get_xlabel(), axis.get_ylabel()
    for line in axis.lines:
        yield up, line.get_ydata()
        yield across, line.get_xdata()
    for band in axis.collections:
        for path in band.get_paths():
            yield up, path.vertices[:, 1]
    for bar in axis.patches:
        if hasattr(bar, "get_height"):
            yield up, [bar.get_height()]
            yield across, [bar.get_width()]
    for text in axis.get_legend().get_texts() if axis.get_legend() else ():
        if mean := re.search(r"mean ([\d.]+) (\w+)", text.get_text()):
            yield f"[{mean[2]}]", [float(mean[1])]


def unsaid(picture):
    """Numbers of a caption that its picture does not show to their last digit."""
    read, missing = drawn(picture.draw()), []
    for text, unit in _NUMBER.findall(picture.see):
        factor, value = 0.01 if unit == "%" else scale(unit), float(text)
        digit = 10.0 ** -len(text.partition(".")[2])
        allowed = max(0.6 * digit, 1e-3 * abs(value))  # curves are drawn through samples
        if np.abs(read - factor * value).min(initial=np.inf) > factor * allowed:
            missing.append(f"{text} {unit}")
    return missing


FAST = ("zotov-89",)
NAMES = [name if name in FAST else pytest.param(name, marks=pytest.mark.slow) for name in cases.names()]


@pytest.mark.parametrize("name", NAMES)
def test_numbers_of_a_caption_are_read_off_its_picture(name):
    report = case_report(cases.load(name))
    pictures = [p for part in report.parts if part.view for p in part.view.pictures]
    said = [n for p in pictures for n in _NUMBER.findall(p.see)]
    assert len(pictures) >= 3 and len(said) >= 3
    assert {p.name: missing for p in pictures if (missing := unsaid(p))} == {}


def test_a_wrong_number_would_be_noticed():
    report = case_report(cases.load("zotov-89"), ["cycle"])
    (picture,) = (p for part in report.parts for p in part.view.pictures)
    wrong = dataclasses.replace(picture, see=picture.see.replace("7.427 MPa", "7.527 MPa"))
    assert unsaid(picture) == [] and unsaid(wrong) == ["7.527 MPa"]
