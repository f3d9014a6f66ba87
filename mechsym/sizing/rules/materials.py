"""Materials as data: the source's five and the maraging steel of its chapter 6.1, extensible by TOML files.

Source: Nunes (2017), tables 4.1 to 4.5 and chapter 6.1; see `materials.toml` for the place of each value.
"""

import dataclasses
import difflib
import tomllib
from collections.abc import Mapping
from importlib import resources
from pathlib import Path

from mechsym.errors import BadInput
from mechsym.files import Json
from mechsym.files.inputs import read_text
from mechsym.quantities import parse, quantity, record


@record
class Material:
    """Strengths and physical properties; what is not known is None."""

    #: Short name in the file and the full one
    key: str
    name: str
    ultimate: float = quantity("Pa", above=0, about="ultimate tensile strength")
    youngs_modulus: float = quantity("Pa", above=0, about="modulus of elasticity")
    poisson: float = quantity("-", low=0, below=0.5, about="Poisson's ratio")
    density: float = quantity("kg/m^3", above=0, about="density")
    yield_strength: float | None = quantity("Pa", default=None, above=0, about="yield strength")
    ultimate_shear: float | None = quantity("Pa", default=None, above=0, about="ultimate shear strength")
    #: Endurance strength in rotating bending, unnotched [Pa]
    fatigue: float | None = quantity("Pa", default=None, above=0, about="endurance strength")
    hot_ultimate: float | None = quantity("Pa", default=None, above=0, about="ultimate strength when hot")
    hot_temperature: float | None = quantity("K", default=None, above=0, about="temperature of hot_ultimate")
    gear_bending: float | None = quantity("Pa", default=None, above=0, about="allowable bending stress number")
    gear_contact: float | None = quantity("Pa", default=None, above=0, about="allowable contact stress number")
    conductivity: float | None = quantity("W/m/K", default=None, above=0, about="thermal conductivity")


def load(extra: str | Path | None = None) -> dict[str, Material]:
    """The built-in materials, and those of a TOML file of the same form.

    extra: file with more materials; a key that exists already is replaced. Raises BadInput: file not readable, key not
    known, or a value out of range.

    >>> load()["ferrium-s53"].ultimate_shear
    1250000000.0
    """
    text = (resources.files("mechsym.sizing.rules") / "materials.toml").read_text(encoding="utf-8")
    tables = _tables(text, "materials.toml")
    if extra is not None:
        tables |= _tables(read_text(extra, "materials", "name an existing TOML file"), str(extra))
    return tables


def get(materials: Mapping[str, Material], key: str) -> Material:
    """One material by its key."""
    if key not in materials:
        near = difflib.get_close_matches(key, materials, n=1)
        hint = f"did you mean {near[0]!r}? " if near else ""
        raise BadInput(f"material {key!r} is not known; {hint}there are {', '.join(sorted(materials))}")
    return materials[key]


def need(material: Material, field: str) -> float:
    """A property that a rule cannot do without.

    Returns value: its value [SI]. Raises BadInput: the material has no such value.

    >>> need(load()["al-242-t571"], "fatigue")
    75000000.0
    """
    value = getattr(material, field)
    if value is None:
        raise BadInput(f"material {material.key} has no {field}; give it in a TOML file or choose another material")
    return value


def _tables(text: str, file: str) -> dict[str, Material]:
    try:
        tables = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise BadInput(f"{file}: not valid TOML: {error}") from None
    return {key: _material(key, table, file) for key, table in tables.items()}


def _material(key: str, table: object, file: str) -> Material:
    if not isinstance(table, dict):
        raise BadInput(f"{file}: {key!r} is no material; write a section [{key}] with ultimate, youngs_modulus, ...")
    fields = {f.name: f for f in dataclasses.fields(Material)}
    values: Json = {"name": table.get("name", key)}
    for name, value in table.items():
        if name == "name":
            continue
        if name not in fields or name == "key":
            raise BadInput(f"{file}: [{key}] {name!r} is not known; allowed are {', '.join(sorted(fields))}")
        values[name] = parse(value, fields[name].metadata["unit"], f"{key}.{name}")
    missing = [n for n in ("ultimate", "youngs_modulus", "poisson", "density") if n not in values]
    if missing:
        raise BadInput(f"{file}: [{key}] {', '.join(missing)} is missing")
    try:
        return Material(key=key, **values)
    except BadInput as error:
        raise BadInput(f"{file}: [{key}] {error}") from None
