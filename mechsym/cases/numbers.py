"""Numbers by letter from a case, for whoever needs values of a mechanism and no case."""

import dataclasses
import tomllib

from mechsym import cases
from mechsym.errors import BadInput
from mechsym.mechanisms.own import file_of, is_file, located


def usual(mechanism: str) -> str:
    """The first built-in case of a mechanism, or the first beside its file; empty where there is none."""
    if not is_file(mechanism):
        return next((c for c in cases.names() if tomllib.loads(cases.text(c)).get("mechanism") == mechanism), "")
    folder = file_of(mechanism)[0].resolve().parent
    for file in sorted(folder.glob("*.toml")):
        try:
            said = str(tomllib.loads(file.read_text(encoding="utf-8")).get("mechanism", ""))
        except (OSError, ValueError):
            continue
        if is_file(said) and _same(located(said, folder), mechanism):
            return str(file)
    return ""


def _same(one: str, other: str) -> bool:
    """Whether two names are of one mechanism; a file alone stands for the one that it declares."""
    if not (is_file(one) and is_file(other)):
        return one == other
    (file, which), (wanted, meant) = file_of(one), file_of(other)
    return file.resolve() == wanted.resolve() and ("" in (which, meant) or which == meant)


def numbers(case: str, mechanism: str = "") -> dict[str, float]:
    """Values of the parameters of a case, and its speed of operation.

    mechanism: mechanism that the case must be of; empty takes any. Returns values: by letter, and `speed` [SI].
    """
    data = cases.load(case)
    if mechanism and not _same(data.mechanism, mechanism):
        other = f"of the mechanism {data.mechanism}, not of {mechanism}"
        raise BadInput(f"case {case} is {other}; name another with --case")
    values = {k: v for k, v in dataclasses.asdict(data.need("parameters")).items() if isinstance(v, float)}
    operation = data.sections.get("operation")
    return values | ({"speed": operation.speed} if operation else {})
