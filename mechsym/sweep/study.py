"""Several sweeps of one file, so that a question is asked again the same way.

    title = "Compression and bore"
    case = "nunes-hypocycloid"

    [[sweep]]
    name = "compression"
    about = "Efficiency over the compression ratio"
    over = ["chamber.compression_ratio=8..14:13"]
    show = ["efficiency", "p_max_mpa"]

Keys of a sweep are those of the command: case, over, set, tied, of, samples, sobol, seed, show. What stands above the
sweeps holds for all of them.
"""

import re
import tomllib
from importlib import resources
from importlib.resources.abc import Traversable
from pathlib import Path

from mechsym import cases
from mechsym.errors import BadInput, shown, suggest
from mechsym.files import Json
from mechsym.files.inputs import read_bytes
from mechsym.quantities import record
from mechsym.sweep.run import Plan

_TEXTS, _LISTS, _NUMBERS = ("case", "of"), ("over", "tied", "show"), ("samples", "sobol", "seed")
_COMMON = (*_TEXTS, *_LISTS, *_NUMBERS, "set")
_KINDS: dict[str, type] = {
    **dict.fromkeys(_TEXTS, str), **dict.fromkeys(_LISTS, list), **dict.fromkeys(_NUMBERS, int), "set": dict,
}  # fmt: skip
_WORD = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]*")
_MOST = 100  # sweeps of a study


@record
class StudySweep:
    """One sweep of a study."""

    name: str  #: Of its folder
    about: str
    plan: Plan


@record
class Study:
    """What a file asks for."""

    title: str
    about: str
    sweeps: tuple[StudySweep, ...]


def built_in() -> list[str]:
    """Names of the studies that come with the program.

    >>> built_in()
    ['nunes2017-chapter-6']
    """
    return sorted(p.name.removesuffix(".toml") for p in _folder().iterdir() if p.name.endswith(".toml"))


def read(name: str) -> Study:
    """A study out of a TOML file, or one that comes with the program.

    Raises BadInput: no such file, no TOML, or a key that is missing, unknown or of another type.
    """
    text, beside = _text(name)
    try:
        tables = tomllib.loads(text)
        return _study(tables, beside)
    except tomllib.TOMLDecodeError as error:
        raise BadInput(f"{name}: not valid TOML: {error}") from None
    except BadInput as error:
        raise BadInput(f"{name}: {error}") from None


def _folder() -> Traversable:
    return resources.files("mechsym.sweep") / "studies"


def _text(name: str) -> tuple[str, Path]:
    if name in built_in():
        return (_folder() / f"{name}.toml").read_text(encoding="utf-8"), Path()
    try:
        return read_bytes(name).decode("utf-8"), Path(name).parent
    except (OSError, ValueError) as error:
        reason = "not UTF-8 text" if isinstance(error, UnicodeDecodeError) else getattr(error, "strerror", error)
        why = f"study {shown(name, 300)} is neither built in nor a readable file ({reason})"
        raise BadInput(f"{why}; {suggest(name, built_in())} and paths") from None


def _study(tables: Json, beside: Path) -> Study:
    common = _known(tables, ("title", "about", "sweep", *_COMMON), "")
    sweeps = tables.get("sweep")
    if not isinstance(sweeps, list) or not sweeps or not all(isinstance(s, dict) for s in sweeps):
        raise BadInput("a study has sweeps; write [[sweep]] and its name and over below it")
    if len(sweeps) > _MOST:
        raise BadInput(f"{len(sweeps)} sweeps; allowed are at most {_MOST}")
    studied = tuple(_sweep(common, table, i, beside) for i, table in enumerate(sweeps, 1))
    names = [one.name for one in studied]
    if len(set(names)) < len(names):
        raise BadInput(f"two sweeps have the name {next(n for n in names if names.count(n) > 1)}; each has its folder")
    return Study(title=_text_of(tables, "title", ""), about=_text_of(tables, "about", "", ""), sweeps=studied)


def _sweep(common: Json, table: Json, number: int, beside: Path) -> StudySweep:
    where = f"sweep {number}: "
    own = _known(table, ("name", "about", *_COMMON), where)
    name = _text_of(table, "name", where)
    if not _WORD.fullmatch(name):
        raise BadInput(f"{where}name = {shown(name)} is no word for a folder; letters, digits, - and _ are")
    values = {**common, **own, "set": {**common.get("set", {}), **own.get("set", {})}}
    for key in ("case", "over"):
        if not values.get(key):
            raise BadInput(f"{where}{key} is missing; it is what `mechsym sweep` takes")
    case, there = values["case"], beside / values["case"]
    if case not in cases.names() and not Path(case).exists() and there.exists():
        case = str(there)  # it lies beside the study and not in the working folder
    try:
        plan = Plan(
            case=case, over=tuple(values["over"]), overrides=values["set"],
            analysis=values.get("of"), samples=values.get("samples"), sobol=values.get("sobol"),
            seed=values.get("seed", 0), show=tuple(values.get("show", ())), tied=tuple(values.get("tied", ())),
        )  # fmt: skip
    except BadInput as error:
        raise BadInput(f"{where}{error}") from None
    return StudySweep(name=name, about=_text_of(table, "about", where, ""), plan=plan)


def _known(table: Json, keys: tuple[str, ...], where: str) -> Json:
    """The keys of a plan in a table, each of its type."""
    for key, value in table.items():
        if key not in keys:
            raise BadInput(f"{where}key {key} is not known; {suggest(key, keys)}")
        kind = _KINDS.get(key, object)
        texts = not isinstance(value, list) or key not in _LISTS or all(isinstance(item, str) for item in value)
        right = isinstance(value, kind) and texts
        if not right or (kind is int and isinstance(value, bool)):
            wanted = {str: "a text", list: "a list of texts", int: "a whole number", dict: "a table"}[kind]
            raise BadInput(f"{where}{key} = {shown(value)} is not {wanted}")
    return {key: value for key, value in table.items() if key in _COMMON}


def _text_of(table: Json, key: str, where: str, usual: str | None = None) -> str:
    value = table.get(key, usual)
    if value is None:
        raise BadInput(f"{where}{key} is missing")
    if not isinstance(value, str):
        raise BadInput(f"{where}{key} = {shown(value)} is not a text")
    return value
