"""All theories by name, each with the data of a case."""

import tomllib
from collections.abc import Callable, Mapping
from functools import cache, partial
from importlib import resources
from pathlib import Path

from mechsym.audit.theory import engines, mechanisms
from mechsym.audit.theory.declared import read_theory, theory_of
from mechsym.audit.theory.mechanisms import mechanism, own_theory
from mechsym.audit.theory.record import Theory
from mechsym.cases.numbers import numbers, usual
from mechsym.derive.build import scripts
from mechsym.errors import BadInput
from mechsym.mechanisms.own import is_file

Build = Callable[[Mapping[str, float], str], Theory]

# theory: (builder, case that its values come from unless another is named)
_THEORIES: dict[str, tuple[Build, str]] = {
    "crosshead": (mechanisms.crosshead, "zotov-89"),
    "crankshaft_flywheel": (mechanisms.crankshaft_flywheel, "chmielewski"),
    "crankshaft_flywheel_truncated": (mechanisms.crankshaft_flywheel_truncated, "chmielewski"),
    "guide": (engines.guide, "zotov-89"),
    "slider_crank": (mechanisms.slider_crank, "zotov-89"),
    "two_mass_rod": (mechanisms.two_mass_rod, "zotov-89"),
    "rodless": (mechanisms.rodless, ""),
    "opposed_slider_crank": (engines.opposed_slider_crank, ""),
    "opposed_hypocycloid": (engines.opposed_hypocycloid, ""),
    "otto": (engines.otto, ""),
    "cylinder": (engines.cylinder, ""),
    "engine_parts": (engines.engine_parts, ""),
}


_SHIPPED = resources.files("mechsym.audit") / "theories"


@cache
def shipped() -> dict[str, str]:
    """Theories that are data: name to the text of their file."""
    files = (f for f in _SHIPPED.iterdir() if f.name.endswith(".toml"))
    return {f.name.removesuffix(".toml"): f.read_text(encoding="utf-8") for f in files}


@cache
def _words_of_texts() -> dict[str, tuple[list[str], list[str]]]:
    # of each theory the words of which a text has one, and those of which it has none
    contents = {name: tomllib.loads(text) for name, text in shipped().items()}
    return {name: (one.get("only_of", []), one.get("not_of", [])) for name, one in contents.items()}


def shipped_for(text: str) -> list[str]:
    """Names of the shipped theories that a text may be held against by its words."""
    low = text.lower()
    return [
        name
        for name, (wanted, refused) in _words_of_texts().items()
        if (not wanted or any(word in low for word in wanted)) and not any(word in low for word in refused)
    ]


def names() -> list[str]:
    """Names of all theories: those above, those of `theories/`, and every other derived mechanism."""
    return sorted({*_THEORIES, *scripts(), *shipped()})


def target(against: str) -> tuple[str, str]:
    """Theory and quantity of THEORY.QUANTITY, ./FILE.py:QUANTITY or ./FILE.py:NAME.QUANTITY; both empty where it is
    none of them."""
    file, mark, rest = against.strip().rpartition(".py:")
    if mark:
        which, _, quantity = rest.rpartition(".")
        return f"{file}.py{':' if which else ''}{which}", quantity
    name, dot, quantity = against.strip().rpartition(".")
    return (name, quantity) if dot and quantity != "py" else ("", "")


def named(name: str, case: str = "", file: str = "") -> Theory:
    """A theory by its name: of a file of one's own, or one that is known here."""
    if file and Path(file).suffix == ".toml":
        own = read_theory(Path(file))
        if name in (own.name, Path(file).stem):
            return own
    elif file:
        raise BadInput(
            f"--theory {file}: a theory is a TOML file; a mechanism of your own is asked as ./FILE.py:QUANTITY"
        )
    try:
        return own_theory(name, case) if is_file(name) else theory(name, case)
    except BadInput as error:
        raise BadInput(f"{error}; of your own: {own.name}" if file else str(error)) from None


@cache
def theory(name: str, case: str = "") -> Theory:
    """A theory with the data of a case: its name, a path, or the source's."""
    if name not in names():
        raise BadInput(
            f"there is no theory {name!r}; theories are {', '.join(names())}, or one of your own by --theory"
        )
    if name in shipped() and name not in _THEORIES:
        return theory_of(shipped()[name], name, f"theories/{name}.toml")
    build, own = _THEORIES.get(name) or (partial(mechanism, name), usual(name))
    chosen = case or own
    return build(numbers(chosen, name if name in scripts() else "") if chosen else {}, chosen)
