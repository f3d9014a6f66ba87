"""Signatures say units, docstrings what signatures do not, never a repetition; and sizes stay readable.

Every float or array that a public function takes or gives has its unit in its annotation, or in brackets where words
must say more; every such field of a record has one too. What a letter is stands after the words, `N: contact force;
rho: radius of the path. Returns p: absolute.`, or in a section where it takes a page. An entry of a section without a
unit or shape and of five words or fewer repeats its name and is refused.
"""

import ast
import functools
import importlib
import re
import typing
from pathlib import Path

import pytest

import mechsym

ROOT = Path(mechsym.__file__).parent
FILES = sorted(p for p in ROOT.rglob("*.py") if "generated" not in p.parts and "derivations" not in p.parts)
UNIT = re.compile(r"\[[^\]]+\]")
NUMBER = re.compile(r"\b(float|ndarray|Array|Scalar)\b")
UNITS = {
    name: typing.get_args(v)[1]
    for name, v in vars(importlib.import_module("mechsym.quantities.units")).items()
    if typing.get_origin(v) is typing.Annotated
}
# a part of an annotation that carries a unit: `Metre`, `Metre[Array]`, `Annotated[float, "W/(m*K)"]`
CARRIED = re.compile(rf"\b(?:{'|'.join(UNITS)})\b(?:\[\w+(?:\.\w+)?\])?|Annotated\[[^\[\]]+, ['\"][^'\"]+['\"]\]")
ITEM = re.compile(r"(?:^|(?<=[.;] )|(?<=Returns ))((?:\*{0,2}\w+, )*\*{0,2}\w+): ")
OTHER = re.compile(r"(?:^|(?<=[.;] ))(?:Sources?: |Valid: |Print: |Raises |>>> )")  # what follows is no letter
NAMED = re.compile(r"Mapping|dict|Callable|Sequence\[tuple|Expr|Basic")  # the unit belongs to each name, or letter


def room(path):
    return path.relative_to(ROOT).parts[0].removesuffix(".py")


each_room = pytest.mark.parametrize(
    "paths", [[p for p in FILES if room(p) == r] for r in sorted({*map(room, FILES)})], ids=sorted({*map(room, FILES)})
)


@functools.cache
def parsed(path):
    return ast.parse(path.read_text())


def public_functions(tree):
    for node in tree.body:
        if isinstance(node, ast.FunctionDef) and not node.name.startswith("_"):
            yield node.name, node
        if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
            for inner in node.body:
                if isinstance(inner, ast.FunctionDef) and not inner.name.startswith("_"):
                    yield f"{node.name}.{inner.name}", inner


def is_command(node):
    return any("command" in ast.unparse(d) or "group" in ast.unparse(d) for d in node.decorator_list)


def section(doc, title):
    match = re.search(rf"^{title}\n-+\n(.*?)(?=^\S[^\n]*\n-+\n|\Z)", doc, re.S | re.M)
    return match[1] if match else ""


def arguments(node):
    a = node.args
    named = [*a.posonlyargs, *a.args, *a.kwonlyargs, *([a.vararg] if a.vararg else []), *([a.kwarg] if a.kwarg else [])]
    return {x.arg: ast.unparse(x.annotation) if x.annotation else "" for x in named if x.arg not in ("self", "cls")}


def entries(text):
    """Names, type and description of each entry of a section."""
    found = []
    for line in text.splitlines():
        if line and not line.startswith(" "):
            names, _, kind = line.partition(" : ")
            found.append([[n.strip().lstrip("*") for n in names.split(",")], kind, ""])
        elif found:
            found[-1][2] += line + "\n"
    return found


def without_unit(kind):
    """What an annotation says besides numbers that carry a unit."""
    return CARRIED.sub("", kind)


def is_bare_number(kind):
    rest = without_unit(kind)
    return bool(NUMBER.search(rest)) and not NAMED.search(rest)


def names_of(item):
    return [n.lstrip("*") for n in item[1].split(", ")]


def is_returned(text, item):
    return text[: item.start()].endswith("Returns ")


def letters(node, doc):
    """What is said of each letter, as (names, text, whether it is returned), and the words before."""
    told, rest = [], []
    for block in re.split(r"\n\s*\n", in_words(doc)):
        text = OTHER.split(" ".join(block.split()))[0]
        starts = list(ITEM.finditer(text))
        while starts and not (is_returned(text, starts[0]) or set(names_of(starts[0])) & set(arguments(node))):
            del starts[0]  # a colon in the words before the letters
        rest.append(text[: starts[0].start()] if starts else text)
        names, back = [names_of(m) for m in starts], False
        ends = [*(m.start() for m in starts), len(text)][1:]
        for match, own, end in zip(starts, names, ends, strict=True):
            back |= is_returned(text, match)
            told.append((own, text[match.end() : end], back))
    return told, " ".join(rest)


def is_noise(kind, about):
    return not UNIT.search(about) and "shape" not in kind and len(about.split()) <= 5


def in_words(doc):
    """What stands before the first section."""
    return re.split(r"^\S[^\n]*\n-{3,}\n", doc, flags=re.M)[0]


@each_room
def test_docstrings_say_what_signatures_do_not(paths):
    for path in paths:
        says_what_signatures_do_not(path)


def says_what_signatures_do_not(path):
    tree = parsed(path)
    assert path.name == "__main__.py" or ast.get_docstring(tree), f"{path.name} has no module docstring"
    for name, node in public_functions(tree):
        doc = ast.get_docstring(node)
        assert doc, f"{path}: {name} has no docstring"
        if is_command(node):
            continue
        taken, given = entries(section(doc, "Parameters")), entries(section(doc, "Returns"))
        listed = [names for names, _, _ in taken] + [names for names, _, back in letters(node, doc)[0] if not back]
        unknown = {n for names in listed for n in names} - set(arguments(node))
        assert not unknown, f"{path}: {name}: the docstring tells of {sorted(unknown)}, the signature does not"
        noise = [names for names, kind, about in taken + given if is_noise(kind, about)]
        assert not noise, f"{path}: {name}: {noise} repeat the signature; say what it does not, or nothing"


@each_room
def test_numbers_carry_a_unit(paths):
    for path in paths:
        carries_units(path)


def carries_units(path):
    for name, node in public_functions(parsed(path)):
        if is_command(node):
            continue
        doc = ast.get_docstring(node) or ""
        told, words = letters(node, doc)
        texts = [(names, about) for names, _, about in entries(section(doc, "Parameters"))]
        texts += [(names, about) for names, about, back in told if not back]
        with_unit = {n for names, about in texts if UNIT.search(about) for n in names}
        kinds = arguments(node)
        numbers = {n for n, kind in kinds.items() if is_bare_number(kind)}
        silent = set() if UNIT.search(words) else numbers - with_unit
        assert not silent, f"{path}: {name}: {sorted(silent)} without unit"
        twice = [n for names, about in texts for n in names for u in units_in(kinds.get(n, "")) if f"[{u}]" in about]
        assert not twice, f"{path}: {name}: {twice} have their unit in the signature and in the docstring"
        gives_units(path, name, node, doc, told, words)


def units_in(kind):
    """Units that an annotation carries."""
    return [UNITS.get(m[0].partition("[")[0]) or re.split(r"['\"]", m[0])[1] for m in CARRIED.finditer(kind)]


def gives_units(path, name, node, doc, told, words):
    kind = ast.unparse(node.returns) if node.returns else ""
    returned = section(doc, "Returns") + " ".join(about for _, about, back in told if back) + words
    if is_bare_number(kind) and not is_told_by_mark(node):
        assert UNIT.search(returned), f"{path}: {name}: what it returns has no unit"
    for names, kind_, about in entries(section(doc, "Returns")):
        if kind_.startswith(("float", "ndarray")) and is_bare_number(kind):
            assert UNIT.search(about), f"{path}: {name}: {names} without unit in brackets"


def is_told_by_mark(node):
    """A property of a result: its unit stands in its mark."""
    return any(ast.unparse(mark).startswith("computed(") for mark in node.decorator_list)


def silent_fields(node, lines):
    """Fields of numbers with no unit in their `quantity`, beside them, or in the lines above their group."""
    group = ""
    for field in (f for f in node.body if isinstance(f, ast.AnnAssign)):
        above = lines[field.lineno - 2].strip()
        beside = lines[field.end_lineno - 1].partition("#:")[2]
        group = above if above.startswith("#:") else "" if beside else group
        # a limit of the guide brings its unit along
        own = field.value is not None and re.search(r"quantity\(|seen\(|\.setting\(", ast.unparse(field.value))
        kind = ast.unparse(field.annotation)
        if NUMBER.search(kind) and not NAMED.search(kind):
            block = group
            for line in reversed(lines[: field.lineno - 1]):
                if not line.strip().startswith("#:"):
                    break
                block += line
            if not own and not UNIT.search(block + beside):
                yield field.target.id


@each_room
def test_fields_carry_a_unit(paths):
    for path in paths:
        lines = path.read_text().splitlines()
        for node in ast.walk(parsed(path)):
            marks = [ast.unparse(d) for d in node.decorator_list] if isinstance(node, ast.ClassDef) else []
            if any(re.search("record|result", mark) for mark in marks):
                assert not (silent := list(silent_fields(node, lines))), f"{path}: {node.name}: {silent} without unit"


@each_room
def test_sizes_stay_readable(paths):
    for path in paths:
        assert path.read_text().count("\n") <= 400, f"{path} is too long; split it"
        for node in ast.walk(parsed(path)):
            if isinstance(node, ast.FunctionDef):
                body = node.body[1:] if ast.get_docstring(node) else node.body
                assert not body or body[-1].end_lineno - body[0].lineno < 60, f"{path}: {node.name} is too long"
