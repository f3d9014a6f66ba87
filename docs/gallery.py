"""The gallery: scripts of docs/gallery run when the site is made, each as page, .py and notebook, with a thumbnail.

What neither script nor package has changed since stands as it was made.
"""

import ast
import contextlib
import hashlib
import io
import json
import runpy
from pathlib import Path

import mechsym
from mechsym import cases
from mechsym.style import svg

SCRIPTS = Path(__file__).parent / "gallery"
_KINDS = ("*.py", "*.toml", "*.csv", "*.json", "*.html", "*.css")


def make(folder: Path) -> None:
    """Write the pages of all scripts and the page that shows them."""
    folder.mkdir(parents=True, exist_ok=True)
    package = digest_of_package()
    drawings = sorted((folder.parent / "cases").glob("*.svg"))
    cards = [_card(f"../cases/{file.stem}.html", file.stem, "", "drawing") for file in drawings]
    for script in sorted(SCRIPTS.glob("*.py")):
        text = script.read_text(encoding="utf-8")
        title = told(text)[0]
        key = hashlib.sha256((package + text).encode()).hexdigest()
        kept = folder / f"{script.stem}.key"
        if not kept.exists() or kept.read_text() != key:
            _page(script, folder)
            kept.write_text(key)
        cards.append(_card(f"{script.stem}.html", script.stem, title))
    hidden = "```{toctree}\n:hidden:\n" + "\n".join(sorted(p.stem for p in SCRIPTS.glob("*.py"))) + "\n```\n"
    links = "\n".join(cards)
    about = "Each picture opens the case that made it: its numbers, its command, its script."
    _write(folder / "index.md", f"# Gallery\n\n{about}\n\n{hidden}\n"
           f"```{{raw}} html\n<style>{_STYLE}</style><div class='gallery'>\n{links}\n</div>\n```\n")  # fmt: skip


def _card(link: str, stem: str, title: str, kind: str = "curves") -> str:
    """A picture that opens its page; Sphinx puts it where it puts those of pages."""
    words = title or stem.replace("-", " ")
    image = f'<img class="{kind}" src="../../_images/{stem}.svg" alt="{words}" loading="lazy">'
    return f'<a class="card" href="{link}">{image}<b>{words}</b></a>'


_STYLE = (
    ".gallery{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(21rem,100%),1fr));gap:1rem}"
    ".gallery .card{display:block;border:1px solid #8884;border-radius:.4rem;padding:.6rem;text-decoration:none}"
    ".gallery img{width:100%;aspect-ratio:4/3;object-fit:contain}"
    ".gallery b{font-weight:500}"
)


def told(text: str) -> tuple[str, str, str]:
    """Title, sentence and command of a script."""
    title, _, rest = (ast.get_docstring(ast.parse(text)) or "").partition("\n\n")
    about, _, command = rest.partition("\nFrom the shell: ")
    return title, " ".join(about.split()), command.strip()


def code(text: str) -> str:
    """A script without its docstring."""
    return text.split('"""', 2)[2].strip() + "\n"


def run(script: Path) -> tuple[str, str]:
    """What a script prints, and its figure as SVG."""
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        names = runpy.run_path(str(script))
    return printed.getvalue(), svg(names["figure"], script.stem)


def notebook(text: str) -> str:
    """A script as a notebook that has not been run."""
    title, about, command = told(text)
    head = f"# {title}\n\n{about}\n\nFrom the shell: `{command}`"
    return as_notebook([("markdown", head), ("code", code(text) + "\nfigure")])


def as_notebook(cells: list[tuple[str, str]]) -> str:
    """Cells as a notebook, each `markdown` or `code`."""
    made = [
        {"cell_type": kind, "id": f"cell-{k}", "metadata": {}, "source": source.splitlines(keepends=True)}
        | ({"execution_count": None, "outputs": []} if kind == "code" else {})
        for k, (kind, source) in enumerate(cells)
    ]
    kernel = {"kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"}}
    return json.dumps({"cells": made, "metadata": kernel, "nbformat": 4, "nbformat_minor": 5}, indent=1) + "\n"


def _page(script: Path, folder: Path) -> None:
    text, (printed, figure) = script.read_text(encoding="utf-8"), run(script)
    title, about, command = told(text)
    _write(folder / f"{script.stem}.svg", figure)
    _write(folder / f"{script.stem}.py", text)
    _write(folder / f"{script.stem}.ipynb", notebook(text))
    known = [name for name in cases.names() if f'"{name}"' in text]
    opens = f"Its case: {', '.join(f'[{name}](../cases/{name}.md)' for name in known)}.\n\n" if known else ""
    output = f"It prints:\n\n```text\n{printed.rstrip()}\n```\n\n" if printed else ""
    _write(folder / f"{script.stem}.md",
           f"# {title}\n\n{about}\n\n![{title}]({script.stem}.svg)\n\n```python\n{code(text)}```\n\n{output}"
           f"{opens}From the shell: `{command}`\n\n"
           f"{{download}}`script <{script.stem}.py>`, {{download}}`notebook <{script.stem}.ipynb>`\n")  # fmt: skip


def digest_of_package() -> str:
    """What changes with every file that a result may follow from."""
    root = Path(mechsym.__file__).parent
    files = sorted({*(p for kind in _KINDS for p in root.rglob(kind)), *(root.parent / "generated").glob("*.py")})
    parts = (hashlib.sha256(path.read_bytes()).digest() for path in files)
    return hashlib.sha256(b"".join(parts)).hexdigest()


def _write(path: Path, text: str) -> None:
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")
