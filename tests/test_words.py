"""Docstrings and comments speak of what is there: names in backquotes exist, sections are the schema's."""

import ast
import functools
import re
from pathlib import Path

from test_docstrings import ROOT, each_room, parsed

from mechsym import cli
from mechsym.cases.schema import ENTRIES

TREE = ROOT.parent
QUOTED = re.compile(r"(?<!:math:)`([^`\n]+)`")
FORMULA = re.compile(r"[\\^]")  # the letters of a formula are no names of the code
WORD = re.compile(r"[A-Za-z_]\w*")
SECTION = re.compile(r'Section `\[(\w+)\]`(?:, `(\w+) = "([\w-]+)"`)?')
# letters of examples, what names are made of, another program's words
FOREIGN = {
    "phi_0", "bc", "x_dd", "x_mean", "x_cos2", "x_sin2", "V_d_", "sin_phi", "cos_phi", "sin_name", "cos_name", "I_",
    "q1d", "q1dd", "u_i", "value0", "R_x_", "R_y_", "section__key", "part_", "_printed", "rrggbb",
    "Intel", "Xeon", "Processor", "a2b3c4d", "abstract", "scotch",
}  # fmt: skip


def words_of(tree):
    """Every name that code defines, uses or spells out in a short text."""
    for node in ast.walk(tree):
        match node:
            case ast.Name(id=name) | ast.Attribute(attr=name) | ast.arg(arg=name) | ast.keyword(arg=str(name)):
                yield name
            case ast.FunctionDef(name=name) | ast.ClassDef(name=name):
                yield name
            case ast.alias(name=name):
                yield from name.split(".")
            case ast.Constant(value=str(text)) if len(text) < 60 and "\n" not in text:
                yield from WORD.findall(text)


@functools.cache
def vocabulary():
    words = set(dir(__builtins__)) | set(cli.COMMANDS) | set(ENTRIES)
    for path in (*ROOT.rglob("*.py"), *(TREE / "tests").glob("*.py")):
        words |= {path.stem, *path.parts[-3:-1]}
        if path != Path(__file__) and "tests" not in path.parts:
            words.update(words_of(parsed(path)))
    for path in (p for end in ("h", "c", "toml", "html") for p in ROOT.rglob(f"*.{end}")):
        words |= {path.stem, *WORD.findall(path.read_text(encoding="utf-8"))}
    return words | {without_numbers(w) for w in words} | FOREIGN


def without_numbers(word):
    """`crank_pin_3` as `crank_pin`: one of several parts that are counted."""
    return re.sub(r"_?\d+", "", word).rstrip("_")


def texts_of(path):
    """Docstrings and comments."""
    for node in ast.walk(parsed(path)):
        if isinstance(node, (ast.Module, ast.FunctionDef, ast.ClassDef)):
            yield ast.get_docstring(node) or ""
    for line in path.read_text(encoding="utf-8").splitlines():
        code, _, comment = line.partition("#")
        if code.count("`") % 2 == 0:  # else the sign stands in a quoted text
            yield comment


def unknown(quoted):
    """Names in a quoted text that nothing has; a path must be there."""
    if re.fullmatch(r"\w[\w./]*/[\w.]+\.\w+", quoted):
        return [] if any((base / quoted).exists() for base in (TREE, ROOT, ROOT / "native")) else [quoted]
    known = vocabulary()
    return [w for w in WORD.findall(quoted) if w not in known and without_numbers(w) not in known]


@each_room
def test_names_in_backquotes_exist(paths):
    wrong = [
        (path.relative_to(ROOT).as_posix(), quoted, words)
        for path in paths
        for text in texts_of(path)
        for quoted in QUOTED.findall(text)
        if not FORMULA.search(quoted) and (words := unknown(quoted))
    ]
    assert not wrong, f"no such name: {wrong}"


def test_a_name_that_is_gone_is_seen():
    assert unknown("speed_from_a_work_that_nobody_does(x)") == ["speed_from_a_work_that_nobody_does"]
    assert unknown("tests/native/test_that_is_not_there.py")


@each_room
def test_a_section_names_its_own_record(paths):
    for path in paths:
        for node in (n for n in parsed(path).body if isinstance(n, ast.ClassDef)):
            for section, key, value in SECTION.findall((ast.get_docstring(node) or "").partition("\n")[0]):
                entry = ENTRIES[section]
                here = f"{'.'.join(('mechsym', *path.relative_to(ROOT).with_suffix('').parts))}:{node.name}"
                if isinstance(entry, str) or not key:
                    records = {entry} if isinstance(entry, str) else set(entry[1].values())
                    assert here in records, f"{here}: section {section} is {records}"
                else:
                    assert (entry[0], entry[1].get(value)) == (key, here), f"{here}: {section} chooses by {entry[0]}"


def neighbours_with_one_text(path):
    """Fields side by side whose comments say the same in words, shape and unit aside: one of the two was copied."""
    lines = path.read_text(encoding="utf-8").splitlines()
    for above, below in zip(lines, lines[1:], strict=False):
        one, other = (line.partition("#:")[2].strip() for line in (above, below))
        if one == other and re.sub(r"\[[^]]*\]|shape \([^)]*\)", "", one).strip():
            yield below.strip()


@each_room
def test_no_comment_is_copied_onto_its_neighbour(paths):
    assert not (copied := [(p.name, line) for p in paths for line in neighbours_with_one_text(p)]), copied


def test_a_copied_comment_is_seen(tmp_path):
    path = tmp_path / "record.py"
    path.write_text("    a: float  #: Bore, throw [m]\n    b: float  #: Bore, throw [m]\n    c: float  #: [m]\n")
    assert [*neighbours_with_one_text(path)] == ["b: float  #: Bore, throw [m]"]
