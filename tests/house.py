"""The state of the house in figures, each with the way it is counted and what it is to come to: `make house`."""

import ast
import collections
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / "mechsym"
SWITCH = re.compile(
    r"\bis_own\b|\bby_roles\b|\bis_train\b|\bwith_hinge\b|\.given\s*[=!]=|isinstance\([^)]*\b(?:Air\w+|Coil\w*)\b"
)
LONGEST_FILE, LONGEST_BODY = 400, 60


def sources():
    """Files of the package, without what is generated."""
    return {p: p.read_text() for p in sorted(PACKAGE.rglob("*.py")) if "generated" not in p.parts}


def code_lines(text):
    """Lines that are neither blank, comment nor docstring."""
    tree = ast.parse(text)
    documented = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
    docs = [n.body[0] for n in ast.walk(tree) if isinstance(n, documented) and ast.get_docstring(n) is not None]
    inside = {line for d in docs for line in range(d.lineno, d.end_lineno + 1)}
    lines = enumerate(text.splitlines(), 1)
    return sum(bool(line.strip()) and not line.strip().startswith("#") and i not in inside for i, line in lines)


def floors(texts, room):
    """Files of a room, and the longest way from one to another by imports among them."""
    names = {".".join(p.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__"): p for p in texts}
    own = {name: path for name, path in names.items() if name.startswith(f"mechsym.{room}.")}
    below = {}
    for name, path in own.items():
        wanted = set()
        for node in ast.walk(ast.parse(texts[path])):
            if isinstance(node, ast.ImportFrom) and node.module:
                wanted |= {node.module, *(f"{node.module}.{a.name}" for a in node.names)}
            elif isinstance(node, ast.Import):
                wanted |= {a.name for a in node.names}
        below[name] = wanted & own.keys() - {name}
    depth = {}

    def height(name, seen=()):
        if name not in depth:
            depth[name] = 1 + max((height(n, (*seen, name)) for n in below[name] if n not in seen), default=0)
        return depth[name]

    return len(own), max(map(height, own), default=0)


def used_once(texts):
    """Private functions, and how many of them stand in one other place of their file only."""
    private = once = 0
    for text in texts.values():
        counts = collections.Counter(re.findall(r"\b_[a-z]\w*\b", text))
        names = [node.name for node in ast.walk(ast.parse(text)) if isinstance(node, ast.FunctionDef)]
        own = [name for name in names if re.match(r"_[a-z]", name)]
        private += len(own)
        once += sum(counts[name] == 2 for name in own)
    return private, once


def arrows(texts):
    """Imports from one room of another."""
    pattern = re.compile(r"(?:from|import) mechsym\.(\w+)")
    own = {p: p.relative_to(PACKAGE).parts[0].removesuffix(".py") for p in texts}
    return sum(room != own[p] for p, text in texts.items() for room in pattern.findall(text))


def strict_errors():
    """Errors of `mypy --strict`."""
    command = [sys.executable, "-m", "mypy", "--strict", "--no-error-summary", "mechsym"]
    told = subprocess.run(command, cwd=ROOT, capture_output=True, text=True).stdout
    return sum(": error:" in line for line in told.splitlines())


def long_places(texts):
    """Files and bodies that are longer than the house allows."""
    files = sum(text.count("\n") > LONGEST_FILE for text in texts.values())
    bodies = 0
    for text in texts.values():
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.FunctionDef):
                body = node.body[1:] if ast.get_docstring(node) else node.body
                bodies += bool(body) and body[-1].end_lineno - body[0].lineno >= LONGEST_BODY
    return files, bodies


def table():
    """Rows: figure, its value, what it is to come to, how it is counted."""
    texts = sources()
    whole = "\n".join(texts.values())
    switches = [(p, i) for p, t in texts.items() for i, line in enumerate(t.splitlines(), 1) if SWITCH.search(line)]
    jobs, levels = floors(texts, "jobs")
    private, once = used_once(texts)
    files, bodies = long_places(texts)
    rooms = {p.relative_to(PACKAGE).parts[0] for p in texts if len(p.relative_to(PACKAGE).parts) > 1}
    rows = [
        ("lines", sum(t.count("\n") for t in texts.values()), "68,000", "of mechsym/**/*.py"),
        ("code lines", sum(map(code_lines, texts.values())), "39,000", "without blank lines, comments, docstrings"),
        ("files", len(texts), "450", "of mechsym/**/*.py"),
        ("rooms", len(rooms), "", "folders of mechsym/"),
        ("arrows", arrows(texts), "", "imports of one room from another"),
        ("files over 400 lines", files, "0", ""),
        ("bodies over 60 lines", bodies, "0", "without the docstring"),
        ("files in jobs", jobs, "16", ""),
        ("floors in jobs", levels, "5", "longest chain of imports inside the room"),
        (
            "switches over kinds",
            len(switches),
            "0",
            "is_own, by_roles, is_train, with_hinge, .given ==, isinstance over springs",
        ),
        ("Any", len(re.findall(r"\bAny\b", whole)), "600", "the word, imports included"),
        ("errors of mypy --strict", strict_errors(), "0", ""),
        ("private functions", private, "", ""),
        ("of them used once", f"{100 * once / private:.0f} %", "45 %", "named in one other place of their file"),
        ("fmt: skip", whole.count("fmt: skip"), "100", ""),
    ]
    return rows, switches


def main():
    rows, switches = table()
    print(f"{'figure':26}{'now':>10}{'wanted':>10}  counted")
    for name, value, wanted, how in rows:
        print(f"{name:26}{value if isinstance(value, str) else format(value, ','):>10}{wanted:>10}  {how}".rstrip())
    print("\nswitches over kinds")
    for path, count in collections.Counter(p for p, _ in switches).most_common():
        lines = ", ".join(str(i) for p, i in switches if p == path)
        print(f"  {path.relative_to(ROOT)} ({count}): {lines}")


if __name__ == "__main__":
    main()
