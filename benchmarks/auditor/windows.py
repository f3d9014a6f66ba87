"""Traps of size, domain, window, branch and unit, and their right twins: what the auditor says of each."""

import tempfile
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from benchmarks.auditor.spoiled import content
from mechsym.audit.hosts.formula import check_formula
from mechsym.audit.verdict import PASSED
from mechsym.errors import BadInput


@cache
def _theories() -> dict[str, str]:
    # files of the theories that the traps declare
    folder = Path(tempfile.mkdtemp(prefix="windows"))
    files = {}
    for name, text in content("windows.toml")["theories"].items():
        file = folder / f"{name}.toml"
        file.write_text(text, encoding="utf-8")
        files[name] = str(file)
    return files


def asked(kinds: tuple[str, ...] = ()) -> Iterator[tuple[str, str, str, bool]]:
    """Kind, text, quantity of every trap and twin, and whether it is right."""
    for trap in content("windows.toml")["trap"]:
        if kinds and trap["kind"] not in kinds:
            continue
        right = f"({trap['right']})"
        for texts, fine in ((trap["texts"], False), (trap["twins"], True)):
            for text in texts:
                yield trap["kind"], text.replace("@", right), trap["against"], fine


def passed(text: str, against: str) -> bool:
    """Whether a formula is passed without an assumption that the answer prints."""
    try:
        row = check_formula(text, against, theory=_theories().get(against.partition(".")[0], ""))
    except BadInput:
        return False  # a number with more digits than are kept is refused
    return row["verdict"] in PASSED and "where " not in row["note"]


def missed(kinds: tuple[str, ...] = ()) -> list[str]:
    """Traps that are passed, and twins that are not."""
    return [
        f"{kind} {against}: {text}" for kind, text, against, fine in asked(kinds) if passed(text, against) is not fine
    ]
