"""From derivations/ to generated/: write every file, or say how what is there differs. `generated/` is never edited."""

import difflib
import importlib
import json
from collections.abc import Iterable
from pathlib import Path

from mechsym.derive.declare import Declaration
from mechsym.derive.emit import digest, module_text
from mechsym.derive.lagrange import derive
from mechsym.derive.listing import listing
from mechsym.derive.textbook import disagreements
from mechsym.errors import BadInput
from mechsym.files import write_text


def folders() -> tuple[Path, Path, Path]:
    """Where the derivations, the generated code and the derivation core live, in this order."""
    files = [importlib.import_module(f"mechsym.{name}").__file__ for name in ("derivations", "generated", "derive")]
    return tuple(Path(str(f)).parent for f in files)  # type: ignore[return-value]


def scripts() -> list[str]:
    """Names of the derivation scripts. Returns names: sorted file stems."""
    return sorted(p.stem for p in folders()[0].glob("*.py") if p.stem != "__init__")


def declared(name: str) -> Declaration:
    """The declaration that a script makes.

    name: name of the script and of its function. Returns mechanism: a fresh declaration.

    Raises
    ------
    BadInput
        No such script
    """
    if name not in scripts():
        raise BadInput(f"no derivation is called {name!r}; there are {', '.join(scripts())}")
    return getattr(importlib.import_module(f"mechsym.derivations.{name}"), name)()


def source_digest(name: str) -> str:
    """Hash of a script and of the derivation core in 16 hex digits: equal ones mean a file that is not stale."""
    derivations, _, core = folders()
    return digest(
        "\0".join(p.read_text(encoding="utf-8") for p in [derivations / f"{name}.py", *sorted(core.glob("*.py"))])
    )


def build(name: str) -> dict[str, str]:
    """The generated files of one script, after the textbook check.

    Returns files: path below `generated/` to text.

    Raises
    ------
    ArithmeticError
        The geometric form and the textbook Lagrangian disagree
    """
    equations = derive(declared(name))
    if equations.kinetic_energy is not None and (wrong := disagreements(equations)):
        raise ArithmeticError(f"{name}: the geometric form differs from Lagrange's equation of {', '.join(wrong)}")
    text = module_text(equations, f"derivations/{name}.py", source_digest(name))
    return {
        f"{name}.py": text,
        f"equations/{name}.json": json.dumps(listing(equations), indent=1, ensure_ascii=False) + "\n",
    }


def write(names: Iterable[str] | None = None) -> list[str]:
    """Regenerate files that differ; with no names, all of them, and remove files without a script.

    names: scripts to run. Returns written: files written or removed, below `generated/`.
    """
    generated, written = folders()[1], []
    for name in names or scripts():
        for file, text in build(name).items():
            if _stored(file) != text:
                write_text(generated / file, text)
                written.append(file)
    if not names:
        for file in orphans():
            (generated / file).unlink()
            written.append(file)
    return written


def orphans() -> list[str]:
    """Generated files that no script makes. Returns files: paths below `generated/`."""
    generated, known = folders()[1], set(scripts())
    files = [*generated.glob("*.py"), *generated.glob("equations/*.json")]
    return sorted(str(p.relative_to(generated)) for p in files if p.stem not in known and p.name != "__init__.py")


def differences(names: Iterable[str] | None = None) -> dict[str, str]:
    """What `write` would change of the scripts `names`: path below `generated/` to a unified diff."""
    diffs = {}
    for name in names or scripts():
        for file, text in build(name).items():
            if (stored := _stored(file)) != text:
                lines = difflib.unified_diff(
                    stored.splitlines(), text.splitlines(), f"generated/{file}", "derived", lineterm=""
                )
                diffs[file] = "\n".join(lines)
    if not names:
        diffs |= {file: f"generated/{file} has no derivation" for file in orphans()}
    return diffs


def _stored(file: str) -> str:
    path = folders()[1] / file
    return path.read_text(encoding="utf-8") if path.exists() else ""
