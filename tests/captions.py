"""Captions read off their pictures: which numbers of a sentence a figure does not show."""

import re

import numpy as np

from mechsym.quantities.units import scale

# the speed at which something is done is said, not drawn
_NUMBER = re.compile(
    r"(?<!at )(?<!flywheel of )(?<![\d.])(-?\d[\d.]*(?:e-?\d+)?) "
    r"(%|MPa|kPa|bar|kN\*m|N\*m|kN|N|kJ|J|kW|W|rpm|deg|mm|kg\*m\^2)(?![\w/])"
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
                factor = scale(plain(unit[1])) if unit[1] != "-" else 1.0
                curves.append(factor * np.asarray(values, dtype=float))
        for values in curves:
            parts = (values, values[len(values) - len(values) // 10 :])
            read += [reading(part) for part in parts if len(part) for reading in _READINGS]
        for one, other in ((a, b) for a in curves for b in curves if len(a) == len(b)):
            far = np.hypot(one, other)
            read += [np.abs(one - other).max(), far.min(), far.max()]
    return np.array(read, dtype=float)


def plain(text):
    """Units as they are typed."""
    return text.replace("N m", "N*m").replace("kg m²", "kg*m^2")


def curves_of(axis):
    """Label of the axis and values of lines, bands and bars, both ways, and of means that a legend tells."""
    across, up = axis.get_xlabel(), axis.get_ylabel()
    if axis.name == "polar":
        across, up = up, across  # the radius is named below the circle
    for line in axis.lines:
        yield up, line.get_ydata()
        yield across, line.get_xdata()
    for band in axis.collections:
        for path in band.get_paths():
            yield up, path.vertices[:, 1]
    for bar in axis.patches:
        if hasattr(bar, "get_y"):
            yield up, [bar.get_height()]
            yield up, [bar.get_y() + bar.get_height()]  # on others
            yield across, [bar.get_width()]
    for text in axis.get_legend().get_texts() if axis.get_legend() else ():
        if mean := re.search(r"mean ([\d.]+) (\w+)", text.get_text()):
            yield f"[{mean[2]}]", [float(mean[1])]


def numbers_of(see):
    """Numbers of a caption, each with its unit."""
    return _NUMBER.findall(plain(see))


def unsaid(see, figure):
    """Numbers of a caption that its picture does not show to their last digit."""
    read, missing = drawn(figure), []
    for text, unit in numbers_of(see):
        factor, value = 0.01 if unit == "%" else scale(unit), float(text)
        digit = 10.0 ** -len(text.partition(".")[2])
        allowed = max(0.6 * digit, 1e-3 * abs(value))  # curves are drawn through samples
        if np.abs(read - factor * value).min(initial=np.inf) > factor * allowed:
            missing.append(f"{text} {unit}")
    return missing
