"""A start for a mechanism of one's own: declaration, case and test, commented, ready to run."""

import keyword
import sys
import tomllib
from importlib import resources
from pathlib import Path

from mechsym import mechanisms
from mechsym.errors import BadInput
from mechsym.files import together, write_text
from mechsym.trust import keep

_MODULES = ("casadi", "mechsym", "numpy", "pytest", "scipy", "sympy")  # that a declaration or its test reads


def write(name: str, folder: Path) -> list[Path]:
    """Write declaration, case and test of a new mechanism; nothing that exists is overwritten."""
    if not name.isidentifier() or name.startswith("_") or keyword.iskeyword(name):
        raise BadInput(f"{name!r} cannot name a mechanism; use letters, digits and inner underscores")
    if name in mechanisms.names():
        raise BadInput(f"{name} is a built-in mechanism; choose another NAME, for example {name}_own")
    if name in sys.stdlib_module_names or name in _MODULES:
        raise BadInput(f"{name}.py would hide Python's module {name} from what stands beside it; choose another NAME")
    starts = tomllib.loads(resources.files("mechsym.cases").joinpath("starts/mechanism.toml").read_text("utf-8"))
    texts = {f"{name}.py": starts["declaration"], f"{name}.toml": starts["case"], f"test_{name}.py": starts["test"]}
    with together(folder):
        for file in texts:
            if (folder / file).exists():
                raise BadInput(f"{folder / file} exists; choose another name or remove it")
        written = [write_text(folder / file, text.replace("NAME", name)) for file, text in texts.items()]
    keep(folder)
    return written
