"""The errata as one table that a reader searches by typing; what it says is read from docs/errata.md."""

import html
import re
from pathlib import Path

from mechsym.audit.read.mathml import STYLE, corrected, formula

_STYLE = (
    f"{STYLE}.formulas{{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(20rem,100%),1fr))}}"
    ".formulas{gap:.5rem 1.5rem}.formulas>div{min-width:0}.formulas p{margin:.4rem 0 0}"
)

_ENTRY = re.compile(r"^### (?P<verdict>[^:\n]+): (?P<rest>[^\n]+)\n(?P<body>.*?)(?=^##|\Z)", re.S | re.M)
_SOURCE = re.compile(r"^## (?P<title>[^\n]+)\n+In commands: `(?P<name>[^`]+)`", re.M)
_FORMULAS = re.compile(r"As printed:\n\n    (?P<printed>[^\n]+)\n(?:\nCorrected:\n\n    (?P<corrected>[^\n]+)\n)?")
_ERROR = re.compile(r"Largest relative error ([\d.e+-]+)")
_SCRIPT = """<p><input id="find" type="search" placeholder="source, equation, word"
aria-label="search the errata" style="width:100%;font:inherit;padding:.4rem"> <span id="count"></span></p>
<script>
addEventListener("DOMContentLoaded", () => {
  const field = document.getElementById("find"), rows = [...document.querySelectorAll("#findings tbody tr")];
  const count = document.getElementById("count");
  function seek() {
    const words = field.value.toLowerCase().split(/\\s+/).filter(Boolean);
    let shown = 0;
    for (const row of rows) {
      const fits = words.every(word => row.textContent.toLowerCase().includes(word));
      row.hidden = !fits; shown += fits;
    }
    count.textContent = `${shown} of ${rows.length}`;
  }
  field.addEventListener("input", seek); seek();
});
</script>"""


def typeset(text: str) -> str:
    """Markdown of the errata with its formulas as a book sets them, printed and corrected side by side."""
    style = f"```{{raw}} html\n<style>{_STYLE}</style>\n```\n\n"
    return style + _FORMULAS.sub(lambda found: f"```{{raw}} html\n{_pair(found)}\n```\n", text)


def _pair(found: re.Match[str]) -> str:
    printed, correction = found["printed"], found["corrected"]
    both = corrected(printed, correction) if correction else (formula(printed),)
    cells = zip(("As printed", "Corrected"), both, strict=False)
    return f'<div class="formulas">{"".join(f"<div><p>{word}:</p>{shown}</div>" for word, shown in cells)}</div>'


def _paragraphs(text: str) -> str:
    """What was found, as HTML."""
    parts, end = [], 0
    for found in _FORMULAS.finditer(f"{text}\n"):
        parts += [*text[end : found.start()].split("\n\n"), _pair(found)]
        end = found.end()
    parts += text[end:].split("\n\n")
    return "".join(p if p.startswith("<div") else f"<p>{html.escape(p)}</p>" for p in parts if p.strip())


def entries(text: str) -> list[dict[str, str]]:
    """One row a finding: source, where, what, verdict, error, and what was said of it."""
    rows = []
    heads = [*_SOURCE.finditer(text)]
    for head, end in zip(heads, [*(h.start() for h in heads[1:]), len(text)], strict=True):
        for found in _ENTRY.finditer(text[head.end() : end]):
            where, _, what = found["rest"].replace(r"\*", "*").partition(", ")
            error, body = _ERROR.search(found["body"]), found["body"].strip().replace(r"\*", "*")
            rows.append({"source": head["name"], "where": where, "what": what, "verdict": found["verdict"].lower(),
                         "error": error[1].rstrip(".") if error else "", "text": body})  # fmt: skip
    return rows


def page(text: str) -> str:
    """The page with the table."""
    rows = entries(text)
    body = "".join(
        f"<tr><td>{html.escape(r['source'])}</td><td>{html.escape(r['where'])}</td><td>{html.escape(r['verdict'])}</td>"
        f"<td>{html.escape(r['error'])}</td><td>{html.escape(r['what'])}<details><summary>what was found</summary>"
        f"{_paragraphs(r['text'])}</details></td></tr>\n"
        for r in rows
    )
    names = "".join(f"<th>{name}</th>" for name in ("source", "equation", "verdict", "largest error", "what"))
    table = f"<table id='findings'><thead><tr>{names}</tr></thead><tbody>{body}</tbody></table>"
    about = "Every finding of {doc}`the errata </errata>` in one table; the error is relative to the right value."
    return f"# Errata, to search\n\n{about}\n\n```{{raw}} html\n<style>{_STYLE}</style>{_SCRIPT}\n{table}\n```\n"


def make(here: Path) -> None:
    """Write the page into docs/made."""
    text, path = page((here / "errata.md").read_text(encoding="utf-8")), here / "made" / "findings.md"
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")
