"""Letters as authors spell them and as mechsym knows them: `\\varphi_0`, `φ0` and `phi_0` are all `phi0`."""

import re
from collections.abc import Iterable

from mechsym.errors import BadInput

_GREEK = {
    "α": "alpha", "β": "beta", "γ": "gamma", "δ": "delta", "ε": "epsilon", "ζ": "zeta", "η": "eta", "θ": "theta",
    "κ": "kappa", "λ": "lam", "μ": "mu", "ν": "nu", "ξ": "xi", "π": "pi", "ρ": "rho", "σ": "sigma", "τ": "tau",
    "φ": "phi", "ϕ": "phi", "χ": "chi", "ψ": "psi", "ω": "omega", "Δ": "Delta", "Σ": "Sigma", "Φ": "Phi",
    "Ψ": "Psi", "Ω": "Omega", "Γ": "Gamma", "Θ": "Theta", "Λ": "Lambda", "²": "**2", "³": "**3", "·": "*",
    "×": "*", "−": "-", "√": "sqrt", "⁰": "**0", "¹": "**1", **{c: f"**{n}" for n, c in enumerate("⁴⁵⁶⁷⁸⁹", 4)},
    **{c: f"_{n}" for n, c in enumerate("₀₁₂₃₄₅₆₇₈₉")},
}  # fmt: skip
_ALIASES = {"lambda": "lam", "varphi": "phi", "vartheta": "theta", "varepsilon": "epsilon", "varrho": "rho"}
_LATEX = {
    "lam": r"\lambda", "phi": r"\varphi", "epsilon": r"\varepsilon", **{
        n: rf"\{n}" for n in (
            "alpha", "beta", "gamma", "delta", "zeta", "eta", "theta", "kappa", "mu", "nu", "xi", "pi", "rho", "sigma",
            "tau", "chi", "psi", "omega", "Delta", "Sigma", "Phi", "Psi", "Omega", "Gamma", "Theta", "Lambda",
        )
    },
}  # fmt: skip
_WORD = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_STEMS = "|".join([*sorted(_LATEX, key=len, reverse=True), "[A-Za-z]"])
_NAME = re.compile(rf"(?P<stem>{_STEMS})(?:(?P<digits>[A-Z]*[0-9]+)|_(?P<word>[A-Za-z0-9]+?))?(?P<dots>dd?)?")


_CALLS = "arcsin|arccos|arctan|asin|acos|atan|sqrt|sin|cos|tan|cot|tg|ctg|exp|log|ln"
_BARE = re.compile(rf"\b({_CALLS})\s+((?:\d+(?:\.\d+)?\s*\*?\s*)?[^\W\d]\w*)(?!\s*\()")
_POWERED = re.compile(rf"\b({_CALLS})\s*(?:(²|³|⁴)|(?:\^|\*\*)\s*\{{?\(?(-?\d)\)?\}}?)\s*(?=[^\W\d]|\()")


# operations element by element, Scilab's %pi, a root's sign in front of a bare letter
_PROGRAMS = (
    (re.compile(r"\.(?=[*/^])"), ""),
    (re.compile(r"%(?=pi\b)"), ""),
    (re.compile(r"√\s*([^\W_]\w*)"), r"√(\1)"),
)


def unprogrammed(text: str) -> str:
    """What only programs write, as a formula has it: `a.*b` is `a*b`."""
    for pattern, instead in _PROGRAMS:
        text = pattern.sub(instead, text)
    return text


def bracketed(text: str) -> str:
    """`sin²(φ)` as `sin(φ)**2`, `cos φ` as `cos(φ)`."""
    while match := _POWERED.search(text):
        power = {"²": "2", "³": "3", "⁴": "4"}.get(match[2] or "", match[3] or "")
        end = _argument_end(text, match.end())
        inside = text[match.end() : end]
        if power.startswith("-") or not inside:
            break
        inner = inside if inside.startswith("(") else f"({inside})"
        text = f"{text[: match.start()]}{match[1]}{inner}**{power}{text[end:]}"
    return _BARE.sub(lambda m: f"{m[1]}({_joined(m[2])})", text)


def _joined(argument: str) -> str:
    return re.sub(r"^(\d+(?:\.\d+)?)\s*\*?\s*", r"\1*", argument)


def _argument_end(text: str, start: int) -> int:
    if text[start : start + 1] != "(":
        found = re.compile(r"[^\W\d]\w*").match(text, start)
        return found.end() if found else start
    depth = 0
    for i in range(start, len(text)):
        depth += {"(": 1, ")": -1}.get(text[i], 0)
        if depth == 0:
            return i + 1
    return start


def from_greek(text: str) -> str:
    """Replace Greek letters and typographic signs by the names and signs that Python reads.

    Returns
    -------
    text : str
        The same with `phi` for φ, `lam` for λ and `lambda`
    """
    text = "".join(f"{_GREEK[c]}" if c in _GREEK else c for c in text)
    return _WORD.sub(lambda m: _ALIASES.get(m[0], m[0]), text)


def plain(base: str, subscript: str = "", dots: int = 0) -> str:
    """A letter's plain name from what LaTeX spells out."""
    return _ALIASES.get(base, base) + re.sub(r"[\W_]", "", subscript) + "d" * dots


def resolve(written: str, known: Iterable[str]) -> str | None:
    """The known letter that a written one means; underscores do not matter.

    Returns
    -------
    name : str or None
        None when there is no such letter
    """
    known = list(known)
    if written in known:
        return written
    found = [k for k in known if k.replace("_", "") == written.replace("_", "")]
    if len(found) > 1:
        raise BadInput(f"the letter {written!r} may mean {' or '.join(found)}; write the one you mean")
    return found[0] if found else None


def latex(name: str) -> str:
    r"""A plain name as LaTeX."""
    match = _NAME.fullmatch(name)
    if match is None:
        word = name.replace("_", r"\_")
        return rf"\mathrm{{{word}}}"
    stem, index, dots = match["stem"], match["digits"] or match["word"], match["dots"]
    base = _LATEX.get(stem, stem)
    if dots:
        base = rf"\{dots}ot{{{base}}}"
    return f"{base}_{{{index}}}" if index else base
