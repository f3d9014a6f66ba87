"""What to cite for a result: the program, the source of its data, the laws that its case chose; `bibliography.toml`."""

import tomllib
from collections.abc import Iterator, Mapping
from importlib import resources

import mechsym
from mechsym import cases, mechanisms
from mechsym.errors import BadInput, suggest
from mechsym.files import Json
from mechsym.papers.sources import short_name, sources

_OWN = ("what", "when", "type")  # what is no field of BibTeX


def bibliography() -> Mapping[str, Json]:
    """All entries by key: `what` it is cited for, `when`, the `type` and the fields of BibTeX."""
    return tomllib.loads((resources.files("mechsym.papers") / "bibliography.toml").read_text(encoding="utf-8"))


def cited(name: str) -> list[Json]:
    """Rows `key`, `what`, `bibtex` of a case, a derived mechanism or a source.

    Raises BadInput: NAME is none of them.

    >>> [row["key"] for row in cited("hypocycloid")]
    ['mechsym', 'nunes2017', 'casadi2019', 'sympy2017']
    """
    reasons = set(_reasons(name))
    entries = {key: one for key, one in bibliography().items() if not one.get("when") or reasons & {*one["when"]}}
    return [{"key": key, "what": one["what"], "bibtex": _bibtex(key, one)} for key, one in entries.items()]


def _reasons(name: str) -> Iterator[str]:
    """What a name stands for, as `when` of an entry says it."""
    short = [source.name for source in sources()]
    if name in short or name in [source.stem for source in sources()]:
        yield f"source={short_name(name)}"
    elif name in mechanisms.names():
        yield f"mechanism={name}"
    elif name in cases.names() or name.endswith(".toml"):
        case = cases.load(name)
        yield f"source={short_name(case.source)}"
        yield f"mechanism={case.mechanism}"
        for section, table in cases.written(case).items():
            yield section
            yield from (f"{section}.{key}={value}" for key, value in table.items() if isinstance(value, str))
    else:
        known = [*cases.names(), *mechanisms.names(), *short]
        raise BadInput(f"{name!r} is neither a case, a mechanism nor a source; {suggest(name, known)}")


def _bibtex(key: str, entry: Json) -> str:
    fields = {name: value for name, value in entry.items() if name not in _OWN}
    fields |= {"version": mechsym.__version__} if key == "mechsym" else {}
    lines = [f"  {name} = {{{value}}}" for name, value in fields.items()]
    return f"@{entry['type']}{{{key},\n" + ",\n".join(lines) + "\n}"
