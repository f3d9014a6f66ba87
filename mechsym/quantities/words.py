"""Keys of results and cases as words for people: no key is shown where somebody reads."""

import re
from collections.abc import Mapping

_WHOLE: Mapping[str, str] = {
    "p_max": "largest pressure", "p_max_mpa": "largest pressure", "p_max_angle": "angle of the largest pressure",
    "t_end": "end of the run", "wall": "time it took", "steps": "steps of the integrator", "backend": "integrator",
    "energy_residual": "energy left over", "power_residual": "power left over", "facts": "assumed",
    "tolerance_difference": "difference to a finer run", "each": "one is a", "F": "gas force F",
    "misfire_speed_share": "speed left by a lost combustion", "p": "pressure p",
    "natural": "natural frequency", "natural_bare": "natural frequency, bare",
    "x": "travel x", "psi": "rod angle psi",
    "closing_share": "closing", "failing": "safety factors too low",
    "dx_dphi": "slope of x", "rms_before": "before, root mean square", "rms_after": "after, root mean square",
}  # fmt: skip
_FRONT = {"max": "largest", "min": "least", "mean": "mean", "avg": "mean", "peak": "largest", "rms": "rms"}
_TOKENS = {"mep": "IMEP", "sfc": "consumption", "deg": "", "ca10": "CA10", "ca50": "CA50", "ca90": "CA90"}
_PLACE = re.compile(r"\[(\d+)\]")


def key_words(key: str, known: Mapping[str, str] | None = None) -> str:
    """A key, or the path of a number, as words; what is no key stays as it is.

    known: words of keys that have their own.

    >>> key_words("torque_max"), key_words("speeds.phi.mean"), key_words("twist[0].twist_peak")
    ('largest torque', 'speeds, phi, mean', 'twist 1, largest twist')
    >>> key_words("energy_residual"), key_words("load torque")
    ('energy left over', 'load torque')
    """
    if " " in key:
        return key
    return ", ".join(filter(None, (_part(part, known or {}) for part in key.split("."))))


def _part(part: str, known: Mapping[str, str]) -> str:
    name, place = _PLACE.sub("", part), _PLACE.search(part)
    number = f" {int(place[1]) + 1}" if place else ""
    if (words := _WHOLE.get(name) or known.get(name, "")) and "_" not in words:
        return words + number
    *tokens, last = [_TOKENS.get(token, token) for token in name.split("_")]
    if tokens and last in _FRONT:
        tokens, last = [_FRONT[last], *tokens[:-1]], tokens[-1]
    return " ".join(filter(None, (*tokens, last))) + number
