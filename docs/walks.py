"""Pages that are walked through: their blocks run one after the other in an empty folder, as a reader types them.

```sh              commands; what each printed stands below it, from docs/printed
```python file=x   is written into the folder as x; so are toml, tex and csv
```python          runs; what it printed stands below
```python picture=NAME   draws `figure` while the site is built, and when the tests run it
```text            is not run

`python docs/walks.py [PAGE..]` runs them and writes docs/printed, `quoted-PAGE` what the prose of a page quotes;
tests/test_docs_runs.py holds that it stays true.
"""

import contextlib
import hashlib
import io
import json
import os
import re
import shlex
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).parent
PRINTED = HERE / "printed"
PAGES = [HERE / "start.md", HERE / "engine.md", *sorted((HERE / "tutorials").glob("*.md"))]
#: Commands whose answers a page has in its prose and in its tables, beside the blocks that it shows
QUOTED = {
    "engine": (
        "cycle {examples}/gpu-3.toml",
        'cycle {examples}/gpu-3.toml --set "cycle.mean_pressure=6.9 MPa" --set "cycle.p_back=6.9 MPa"',
    ),
    "codesign": (
        "codesign zotov-89 --ripple 2% --peers",
        "codesign zotov-89 --ripple 5% --peers",
        "codesign zotov-89 --ripple 2% --free spring.A,spring.H,guide.rho0",
        "codesign zotov-89 --ripple 0.2% --springs 2 --speeds 60,89,105,142",
        "codesign zotov-89 --ripple 2% --cylinders 12",
    ),
}
SHOWN = 26  # lines of what a block printed
_BLOCK = re.compile(
    r"^```(?P<kind>sh|python|toml|tex|csv)(?: (?P<how>file|picture)=(?P<name>[\w.-]+))?\n(?P<text>.*?)^```$",
    re.S | re.M,
)


def blocks(text: str) -> list[re.Match[str]]:
    """What a page asks its reader to type, in its order."""
    return [one for one in _BLOCK.finditer(text) if one["kind"] in ("sh", "python") or one["how"] == "file"]


def walked(page: Path, folder: Path):
    """Run a page in a folder; what is typed and what it prints, one after the other."""
    with contextlib.chdir(folder):
        names = {"__name__": "block"}
        for one in blocks(page.read_text(encoding="utf-8")):
            if one["how"] == "file":
                Path(one["name"]).write_text(one["text"], encoding="utf-8")
            elif one["kind"] == "sh":
                for line in one["text"].splitlines():
                    yield line, typed(line, folder)
            else:
                said = io.StringIO()
                with contextlib.redirect_stdout(said):
                    exec(compile(one["text"], page.name, "exec"), names)
                yield one["text"], said.getvalue()


def typed(line: str, folder: Path, statuses: tuple[int, ...] = (0,)) -> str:
    """What a command prints; only those that the page expects end with a status other than 0: `# exit 1`."""
    from click.testing import CliRunner

    from mechsym.cli import mechsym

    line, _, mark = line.partition("  # exit ")
    program, *words = shlex.split(line)
    done = CliRunner().invoke(mechsym, words, prog_name="mechsym", catch_exceptions=False)
    wanted = {int(mark)} if mark else {*statuses}
    if program != "mechsym" or done.exit_code not in wanted:
        raise RuntimeError(f"{line} ended with {done.exit_code}: {done.output}")
    return done.stdout.replace(f"{folder}/", "").replace(str(Path.home()), "~")


def kept(page: Path) -> dict[str, str]:
    """What docs/printed has of a page, by what is typed."""
    file = PRINTED / f"{page.stem}.json"
    return json.loads(file.read_text(encoding="utf-8")) if file.exists() else {}


def with_results(page: Path, text: str, pictures: Path) -> str:
    """A page with what its blocks printed, and its pictures."""
    said = kept(page)

    def shown(one: re.Match[str]) -> str:
        if one["how"] == "file":
            return f"`{one['name']}`:\n\n```{one['kind']}\n{one['text']}```"
        if one["how"] == "picture":
            above = os.path.relpath(pictures, page.parent)
            return f"```python\n{one['text']}```\n\n![{one['name']}]({above}/{page.stem}-{one['name']}.svg)"
        lines = one["text"].splitlines() if one["kind"] == "sh" else [one["text"]]
        out = "\n".join(
            f"{f'$ {line}{chr(10)}' if len(lines) > 1 else ''}{_short(said.get(line, ''))}" for line in lines
        )
        body = f"```{one['kind']}\n{one['text'].replace('  # exit 1', '')}```"
        return f"{body}\n\n````text\n{out}\n````" if out.strip() else body

    return _BLOCK.sub(shown, text)


def _short(text: str) -> str:
    lines = [line for line in text.rstrip().splitlines() if not line.startswith("accepted: ")]
    return "\n".join(lines[:SHOWN] + ["..."] * (len(lines) > SHOWN))


def make(folder: Path) -> None:
    """Draw the pictures of all pages, and the notebook of each tutorial; what has not changed stays."""
    import gallery

    folder.mkdir(parents=True, exist_ok=True)
    package = gallery.digest_of_package()
    for page in PAGES:
        text = page.read_text(encoding="utf-8")
        (folder / f"{page.stem}.ipynb").write_text(notebook(text), encoding="utf-8")
        for one in _BLOCK.finditer(text):
            if one["how"] == "picture":
                key, file = hashlib.sha256((package + text).encode()).hexdigest(), folder / f"{page.stem}-{one['name']}"
                if not file.with_suffix(".key").exists() or file.with_suffix(".key").read_text() != key:
                    file.with_suffix(".svg").write_text(picture(text, one), encoding="utf-8")
                    file.with_suffix(".key").write_text(key)


def live(folder: Path) -> None:
    """The page that simulates in the browser, which the tutorial of the teacher opens."""
    from gallery import digest_of_package

    folder.mkdir(parents=True, exist_ok=True)
    file, key, package = folder / "start-up.html", folder.parent / "start-up.key", digest_of_package()
    if not file.exists() or not key.exists() or key.read_text() != package:
        with tempfile.TemporaryDirectory() as home, contextlib.chdir(home):
            typed("mechsym page chmielewski --out start-up.html", Path(home))
            file.write_text(Path("start-up.html").read_text(encoding="utf-8"), encoding="utf-8")
        key.write_text(package)


def picture(text: str, one: re.Match[str]) -> str:
    """The figure of a block as SVG; files of the page are there."""
    from mechsym.style import svg

    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        for other in blocks(text):
            if other["how"] == "file":
                Path(other["name"]).write_text(other["text"], encoding="utf-8")
        names = {"__name__": "block"}
        with contextlib.redirect_stdout(io.StringIO()):
            exec(compile(one["text"], one["name"], "exec"), names)
        return names["figure"] if isinstance(names["figure"], str) else svg(names["figure"], one["name"])


def notebook(text: str) -> str:
    """A page as a notebook that has not been run."""
    from gallery import as_notebook

    cells, end = [], 0
    for one in blocks(text):
        cells += [("markdown", text[end : one.start()].strip())] if text[end : one.start()].strip() else []
        end = one.end()
        if one["how"] == "file":
            cells.append(("code", f"%%writefile {one['name']}\n{one['text']}"))
        elif one["kind"] == "sh":
            cells.append(("code", "".join(f"!{line.partition('  # exit')[0]}\n" for line in one["text"].splitlines())))
        else:
            cells.append(("code", one["text"] + ("figure" if one["how"] == "picture" else "")))
    cells += [("markdown", text[end:].strip())] if text[end:].strip() else []
    return as_notebook(cells)


def examples() -> dict[str, tuple[str, ...]]:
    """Lines whose answers the page of a command shows, with what has to run before."""
    import pages

    own = {name: line for name, line in pages.EXAMPLES.items() if shlex.split(line)[0] == name}
    return {
        line: tuple(filter(None, (pages.BEFORE.get(name), line)))
        for name, line in own.items()
        if name not in pages.MACHINE
    }


def answered(lines: tuple[str, ...]) -> str:
    """What the last of some commands prints, in an empty folder."""
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        placed = [line.replace("{examples}", str(HERE.parent / "examples")) for line in lines]
        return [typed(f"mechsym {line}", Path(folder), (0, 1)) for line in placed][-1]


def quoted(page: str) -> dict[str, str]:
    """What docs/printed has of the commands that a page quotes."""
    files = [PRINTED / f"quoted-{page}-{k}.txt" for k in range(len(QUOTED[page]))]
    return {line: file.read_text(encoding="utf-8") for line, file in zip(QUOTED[page], files, strict=True)}


def main(names: list[str]) -> None:
    """Write docs/printed anew."""
    import pages

    PRINTED.mkdir(exist_ok=True)
    for page in PAGES:
        if not names or page.stem in names:
            with tempfile.TemporaryDirectory() as folder:
                said = dict(walked(page, Path(folder).resolve()))
            (PRINTED / f"{page.stem}.json").write_text(
                json.dumps(said, indent=1, ensure_ascii=False) + "\n", encoding="utf-8"
            )
    for page in QUOTED:
        if f"quoted-{page}" in names:
            for k, line in enumerate(QUOTED[page]):
                (PRINTED / f"quoted-{page}-{k}.txt").write_text(answered((line,)), encoding="utf-8")
    for line, lines in examples().items():
        if not names or shlex.split(line)[0] in names:
            (PRINTED / f"{pages.slug(line)}.txt").write_text(answered(lines), encoding="utf-8")


if __name__ == "__main__":
    sys.path.insert(0, str(HERE))
    main(sys.argv[1:])
