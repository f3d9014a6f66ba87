"""The wheel of a folder in a clean environment of every Python at hand: `python tests/everywhere.py dist`.

Each one designs a hinge, proves a formula, checks the derivations and writes an FMU that fmpy validates, from an empty
folder and from the folder that holds the clone, where a folder of the same name must not hide what is installed.
`python tests/everywhere.py dist tutorials` does the tutorials in the first Python by their text alone: what a page says
is installed into a clean environment, its blocks are typed in an empty folder, and print what the page shows.
"""

import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

VERSIONS = ("3.11", "3.12", "3.13", "3.14")
CLONE = Path(__file__).resolve().parents[1]
COMMANDS = (
    ("hinge", "zotov-89", "--out", "{home}/demo"),
    ("cite", "zotov-89"),
    ("audit", "--formula", "r*(1 - cos(phi))", "--against", "hypocycloid.x", "--letters", "r=2*e,phi=theta", "--json"),
    ("derive", "--check"),
    ("fmu", "zotov-89", "--out", "{home}/e.fmu", "--compare"),
    ("export", "crosshead", "--to", "c,julia", "--out", "{home}/text"),
    ("eval", "swing", "--set", "l=2", "--set", "mass=3", "--json"),  # of the package in tests/plugin
)


def interpreters():
    """One working interpreter for each version: of PATH, or of pyenv."""
    for version in VERSIONS:
        own = sorted(glob.glob(str(Path.home() / f".pyenv/versions/{version}.*/bin/python3")))
        places = [shutil.which(f"python{version}"), *own]
        for place in filter(None, places):
            if (
                subprocess.run([place, "-c", "import venv, ensurepip"], capture_output=True, check=False).returncode
                == 0
            ):
                yield version, place
                break


def tried(place, wheel, home):
    """Install the wheel with the extra fmu and run every command in both folders; the words of what failed."""
    subprocess.run([place, "-m", "venv", home], check=True)
    python = home / "bin" / "python"
    subprocess.run([python, "-m", "pip", "install", "--quiet", f"{wheel}[fmu]"], check=True)
    plugin = shutil.copytree(CLONE / "tests" / "plugin", home / "plugin")
    subprocess.run([python, "-m", "pip", "install", "--quiet", "--no-deps", plugin], check=True)
    failed = []
    for folder in (home / "empty", CLONE.parent):
        folder.mkdir(exist_ok=True)
        for name, *words in COMMANDS:
            words = [word.format(home=home) for word in words]
            command = [home / "bin" / "mechsym", name, *words]
            done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
            if done.returncode:
                failed.append(f"{name} in {folder}: {done.returncode} {done.stderr.strip()[-300:]}")
    check = "import sys; from fmpy.validation import validate_fmu as v; sys.exit(len(v(sys.argv[1])))"
    if subprocess.run([python, "-c", check, home / "e.fmu"], capture_output=True, check=False).returncode:
        failed.append("fmpy validate")
    light = "import sys, mechsym; from mechsym import cases; cases.load('zotov-89'); sys.exit('sympy' in sys.modules)"
    if subprocess.run([python, "-c", light], cwd=home / "empty", check=False).returncode:
        failed.append("import takes sympy with it")
    archive = next(Path(wheel).parent.glob("*.tar.gz"))
    quiet = ["-m", "pip", "install", "--quiet", "--no-deps", "--force-reinstall"]
    subprocess.run([python, *quiet, archive], check=True)
    state = [home / "bin" / "mechsym", "eval", "crosshead", "--case", "zotov-89", "--json"]
    if subprocess.run(state, cwd=home / "empty", capture_output=True, check=False).returncode:
        failed.append("what the archive installs does not run")
    return failed


def walked(page, wheel, place, home):
    """Do a tutorial in a new environment; what it printed otherwise than it says."""
    from test_docs_runs import agree

    sys.path.insert(0, str(CLONE / "docs"))
    import walks

    subprocess.run([place, "-m", "venv", home], check=True)
    text, python, folder = page.read_text(encoding="utf-8"), home / "bin" / "python", home / "empty"
    extras = re.search(r'`pip install "[^"[]*\.whl(.*?)"`', text)[1]
    subprocess.run([python, "-m", "pip", "install", "--quiet", f"{wheel}{extras}"], check=True)
    folder.mkdir()
    env = os.environ | {"PATH": f"{home / 'bin'}:{os.environ['PATH']}"}
    kept, before, wrong = walks.kept(page), "", []

    def typed(what, command, status=0, **how):
        done = subprocess.run(command, cwd=folder, env=env, capture_output=True, text=True, check=False, **how)
        same = agree(done.stdout.replace(f"{folder}/", "").replace(str(Path.home()), "~"), kept[what])
        wrong.extend([] if done.returncode == status and same else [f"{what}: {done.returncode} {done.stderr[-300:]}"])

    for one in walks.blocks(text):
        if one["how"] == "file":
            (folder / one["name"]).write_text(one["text"], encoding="utf-8")
        elif one["kind"] == "sh":
            for line in one["text"].splitlines():
                command, _, status = line.partition("  # exit ")
                typed(line, command, int(status or 0), shell=True)
        else:  # names of earlier blocks are there, what they printed is not printed again
            quiet = f"import contextlib, io\nwith contextlib.redirect_stdout(io.StringIO()): exec({before!r})\n"
            typed(one["text"], [python, "-c", quiet + one["text"]])
            before += one["text"]
    return wrong


def tutorials(wheel):
    """Do all of them; 1 when anything was otherwise."""
    _, place = next(interpreters())
    failures = 0
    for page in sorted((CLONE / "docs" / "tutorials").glob("*.md")):
        with tempfile.TemporaryDirectory() as home:
            wrong = walked(page, wheel, place, Path(home).resolve() / "venv")
        print(f"{page.stem}: {'; '.join(wrong) or 'every block prints what the page shows'}", flush=True)
        failures += len(wrong)
    return int(failures > 0)


def main(folder, what=""):
    """Try the wheel of a folder everywhere; 1 when anything failed."""
    (wheel,) = Path(folder).resolve().glob("*.whl")
    if what == "tutorials":
        return tutorials(wheel)
    failures = 0
    for version, place in interpreters():
        with tempfile.TemporaryDirectory() as home:
            failed = tried(place, wheel, Path(home) / "venv")
        print(f"Python {version}: {'; '.join(failed) or 'all commands run'}", flush=True)
        failures += len(failed)
    return int(failures > 0)


if __name__ == "__main__":
    os.environ.pop("PYTHONPATH", None)
    sys.exit(main(*sys.argv[1:]))
