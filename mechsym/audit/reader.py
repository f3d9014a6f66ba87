"""From the text of a formula to a tree. Text is never executed; what is not arithmetic is refused with a reason."""

import ast
import re
from collections.abc import Iterable, Mapping
from dataclasses import field

from mechsym.audit import limits
from mechsym.audit import tree as trees
from mechsym.audit.latex import read_latex
from mechsym.audit.printer import to_latex, to_python
from mechsym.audit.spelling import from_greek, resolve
from mechsym.audit.tree import Node
from mechsym.errors import BadInput
from mechsym.quantities import record

MAX_TEXT = 6000
CONSTANTS = ("pi",)
_ALIASES = {"arcsin": "asin", "arccos": "acos", "arctan": "atan", "tg": "tan", "ctg": "cot", "ln": "log", "Abs": "abs"}


@record
class Formula:
    """A formula as printed, in its author's letters."""

    tree: Node
    letters: Mapping[str, Node] = field(default_factory=dict)  #: Author's letter to its expression in known letters
    latex: bool = False  #: Whether it was written in LaTeX
    spelled: Mapping[str, str] = field(default_factory=dict)  #: Plain name to the author's LaTeX for it
    note: str = ""


def read(text: str, known: Iterable[str], letters: Mapping[str, str] | None = None) -> Formula:
    """Read a formula in Python syntax or LaTeX.

    Parameters
    ----------
    text : str
        An expression, or `name = expression`
    letters : mapping of str to str, optional
        Author's letter to its expression in known letters
    """
    known = [*known, *CONSTANTS]
    own = {key: read_expression(value, known)[0] for key, value in _author_letters(letters or {}).items()}
    body, note = _right_side(text)
    tree, spelled = read_expression(body, [*own, *(k for k in known if k not in own)])
    return Formula(tree=tree, letters=own, latex=is_latex(body), spelled=spelled, note=note)


def read_expression(text: str, known: Iterable[str]) -> tuple[Node, dict[str, str]]:
    """Read an expression without an equals sign.

    Returns
    -------
    spelled : dict of str to str
        Known letter to the LaTeX that was written for it; empty for Python syntax
    """
    known = list(known)
    if len(text) > MAX_TEXT:
        raise BadInput(f"the formula has {len(text)} characters; at most {MAX_TEXT} are read")
    if not text.strip():
        raise BadInput("the formula is empty; write an expression such as r*sin(phi)")
    tree, spelled = read_latex(text) if is_latex(text) else (_read_python(text), {})
    limits.check(tree)
    meant = {written: _known_letter(written, known) for written in trees.letters(tree)}
    tree = trees.substitute(tree, lambda n: trees.name(meant[n.id]) if isinstance(n, ast.Name) else None)
    return tree, {meant[plain]: latex for plain, latex in spelled.items() if plain in meant}


def write(formula: Formula, tree: Node | None = None) -> str:
    """A formula, or an edited tree of it, in its author's form.

    Parameters
    ----------
    tree : Node, optional
        Another tree in the same letters
    """
    tree = formula.tree if tree is None else tree
    return to_latex(tree, formula.spelled) if formula.latex else to_python(tree)


def is_latex(text: str) -> bool:
    """Whether a text is LaTeX rather than Python syntax.

    Returns
    -------
    answer : bool
        True when it has a backslash, a brace or a dollar sign
    """
    return any(mark in text for mark in "\\{}$")


def letter_pairs(text: str) -> dict[str, str]:
    """The value of `--letters`: `R=r1+r2, L=l1+l2`.

    Parameters
    ----------
    text : str
        Pairs separated by commas or semicolons
    """
    found = {}
    for part in filter(None, (p.strip() for p in re.split(r"[,;]", text))):
        key, sign, value = part.partition("=")
        if not sign or not key.strip() or not value.strip():
            raise BadInput(
                f"--letters {part!r} is not LETTER=EXPRESSION; write for example --letters 'R=r1+r2,L=l1+l2'"
            )
        found[key.strip()] = value.strip()
    return found


def _author_letters(letters: Mapping[str, str]) -> dict[str, str]:
    found = {}
    for written, value in letters.items():
        tree = read_latex(written)[0] if is_latex(written) else _read_python(written)
        if not isinstance(tree, ast.Name):
            raise BadInput(f"{written!r} is not a letter; write for example R=r1+r2")
        found[tree.id] = value
    return found


def _right_side(text: str) -> tuple[str, str]:
    parts = [p.strip() for p in re.split(r"(?<![=<>!])=(?!=)(?![^{]*\})", text)]
    note = ""
    if len(parts) == 3 and re.fullmatch(r"0\s*\.?", parts[2]):
        parts.pop()
        note = 'the trailing "= 0" was left out: with it the equation would say that the quantity vanishes'
    if len(parts) > 2:
        raise BadInput("more than one equals sign; check one equality at a time, as 'name = expression'")
    if len(parts) == 2 and (re.search(r"[-+*/:]|\\frac|\\sqrt", parts[0]) or not parts[0]):
        raise BadInput(f"the left side {parts[0][:40]!r} must be the quantity alone; solve the equation for it")
    if len(parts) == 2 and re.fullmatch(r"0\s*\.?", parts[1]):
        raise BadInput("the right side is 0; solve the equation for the quantity: 'name = expression'")
    return parts[-1].rstrip(".,;"), note


def _known_letter(written: str, known: list[str]) -> str:
    found = resolve(written, known)
    if found is None:
        raise BadInput(
            f"unknown letter {written[:40]!r}; letters are {', '.join(known)}; name others with --letters 'R=r1+r2'"
        )
    return found


def _read_python(text: str) -> Node:
    source = from_greek(text).replace("^", "**")
    try:
        tree = ast.parse(source.strip(), mode="eval").body
    except (SyntaxError, ValueError) as error:
        reason = getattr(error, "msg", None) or "not an expression"
        hint = "write products with *, as in 2*r" if re.search(r"\d[A-Za-z(]|\)\s*[A-Za-z0-9(]", source) else ""
        raise BadInput(f"the formula {text.strip()[:60]!r} cannot be read: {reason}. {hint}".rstrip(" .")) from None
    except (RecursionError, MemoryError):
        raise BadInput("the formula is nested too deep to be read; split it and check the parts") from None
    limits.check_size(tree)
    return trees.substitute(tree, _tidy)


def _tidy(node: Node) -> Node | None:
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.UAdd):
        return trees.substitute(node.operand, _tidy)
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and len(node.args) == 1:
        function = _ALIASES.get(node.func.id, node.func.id)
        if not node.keywords:
            return trees.call(function, trees.substitute(node.args[0], _tidy))
    return None
