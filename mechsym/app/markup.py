"""Tables, bars and charts of the workbench as text for the browser; everything from outside is escaped."""

import html
from collections.abc import Sequence
from importlib import resources

from mechsym.app.answers import Answer, Plotted
from mechsym.app.commands import Run
from mechsym.app.told import grouped, pretty_words
from mechsym.files import Json
from mechsym.page import Finding
from mechsym.style import DARK, QUIET

_COLOURS = ("#3f7fca", "#c9503f", "#3f9d68")
_SENTENCE = 40  # letters
# what the tab says itself: head, answer, data
_ALONE = (
    "<style>h1, h1 + .findings, .turning, .whole { display: none } body { padding: 0; max-width: none }</style></head>"
)
_TALL = "this.style.height = this.contentDocument.body.offsetHeight + 16 + 'px'"
# no one grey has a contrast of 4.5 on both papers: the browser chooses
_GREY = f"document.body.classList.contains('body--dark') ? '{DARK[QUIET]}' : '{QUIET}'"
# in the picture: it tells its angle, and stands where it is told to
_LINK = (resources.files("mechsym.app") / "link.html").read_text(encoding="utf-8").removesuffix("\n")


def table(rows: Sequence[tuple[str, str]], pinned: Sequence[tuple[str, str]]) -> str:
    """Names and values, those of a pinned answer beside them."""
    other = dict(_counted(pinned))
    cells = (
        "".join(f"<td>{html.escape(text)}</td>" for text in (key[0], value, _beside(value, other.get(key, ""))))
        for key, value in _counted(rows)
    )
    head = "<tr><td></td><td></td><td>pinned</td></tr>" if pinned else ""
    body = "".join(f"<tr>{row}</tr>" for row in cells)
    return f"<table class='mechsym-table'>{head}{body}</table>"


def _beside(value: str, pinned: str) -> str:
    """A pinned value; a sentence that has not changed is not told twice."""
    return "the same" if value == pinned and len(value) > _SENTENCE else pinned


def _counted(rows: Sequence[tuple[str, str]]) -> list[tuple[tuple[str, int], str]]:
    """Rows with how often their name has stood before, since several sentences may have one name."""
    names = [name for name, _ in rows]
    return [((name, names[:i].count(name)), value) for i, (name, value) in enumerate(rows)]


def bars(answer: Answer) -> str:
    """Limits as bars, as long as the share of each that is used; one that is only kept or not has none."""
    parts = []
    for bar in answer.bars:
        used = 1.0 if bar.margin is None else max(0.0, min(1.0, 1.0 - bar.margin))
        colour = _COLOURS[2] if bar.kept else _COLOURS[1]
        drawn = f"<div style='background:{colour};height:.4rem;width:{100 * (used if bar.kept else 1):.0f}%'></div>"
        word = "" if bar.kept else "NOT kept: "
        parts.append(
            f"<div style='font-size:.85rem;margin-bottom:.2rem'>{word}{html.escape(bar.text)}"
            + (f"<div class='mechsym-bar'>{drawn}</div></div>" if bar.margin is not None else "</div>")
        )
    heading = "Limits: a bar is as long as what is used of its limit, full where it is reached."
    return f"<p class='mechsym-note'>{heading}</p>{''.join(parts)}" if parts else ""


def run_head(run: Run, pinned: Run | None = None) -> str:
    """What has to be known first of what a command said: findings, how it ended, the numbers that stand alone."""
    state = {0: "done", 1: "done: what is asked is not met", 2: "refused: see why", 3: "done, with doubts"}
    words = f"<p>{html.escape(run.words)}</p>" if run.words else ""
    said = f"<p class='mechsym-note'>{state.get(run.status, 'failed: it ended before it was done')}</p>"
    rows, beside = grouped(run.rows).get("", []), grouped(pinned.rows if pinned else ()).get("", [])
    return findings(run.findings) + said + words + table(rows, beside)


def run_groups(run: Run, pinned: Run | None = None) -> str:
    """The page that a command wrote, and its other numbers in groups with a heading each."""
    beside = grouped(pinned.rows if pinned else ())
    parts = [
        f"<section><h3>{html.escape(title)}</h3>{table(rows, beside.get(title, ()))}</section>"
        for title, rows in grouped(run.rows).items()
        if title
    ]
    text = f"<div class='mechsym-groups'>{''.join(parts)}</div>"
    if run.undrawn:
        all_of = len(run.curves) + run.undrawn
        text = f"<p class='mechsym-note'>{len(run.curves)} of {all_of} curves are drawn; --out writes all.</p>{text}"
    if not run.page:
        return text
    shown = run.page.replace("</head>", _ALONE)
    page = f'<iframe class="mechsym-page" title="page of the command" srcdoc="{html.escape(shown)}"'
    return f'{page} onload="{_TALL}"></iframe><details><summary>all numbers</summary>{text}</details>'


def findings(ranked: Sequence[Finding]) -> str:
    """What has to be known first, each in its colour."""
    colours = {"no": "text-red-7", "open": "text-orange-9"}
    return "".join(
        f"<p class='text-lg {colours.get(f.mark, '')}'>{html.escape(pretty_words(f.line))}</p>" for f in ranked
    )


def chart(curves: list[tuple[Plotted, str]]) -> Json:
    """Curves with their line styles as the options of a chart."""
    first = curves[0][0]
    series = [
        {"type": "line", "name": c.name + (" pinned" if style == "dashed" else ""), "showSymbol": False,
         "lineStyle": {"type": style, "width": 1.5}, "color": _COLOURS[i % 3],
         "data": [list(p) for p in zip(c.x, c.y, strict=True)]}
        for i, (c, style) in enumerate(curves)
    ]  # fmt: skip
    labels = {"axisLabel": {":color": _GREY}, "nameTextStyle": {":color": _GREY}}
    # 359.5 would touch the one before it
    last = {"axisLabel": {":color": _GREY, "showMaxLabel": first.x[-1] % 10 == 0}}
    lines = {"splitLine": {"lineStyle": {":color": _GREY, "opacity": 0.25}}}
    return {
        "animation": False, "tooltip": {"trigger": "axis"},
        "title": {"text": first.y_name, "textStyle": {"fontSize": 12, ":color": _GREY}},
        "grid": {"left": 70, "right": 15, "top": 30, "bottom": 40},
        "xAxis": {"type": "value", "name": first.x_name, "nameLocation": "middle", "nameGap": 25, "min": first.x[0],
                  "max": first.x[-1], **labels, **last, **lines},
        "yAxis": {"type": "value", "scale": True, **labels, **lines}, "series": series,
    }  # fmt: skip


def frame(page: str, title: str, turns: int = 0) -> str:
    """A whole page inside the page; one that shows so many turns has its angle linked with the charts."""
    linked = page.replace("</body>", _LINK.replace("DEGREES", str(360 * turns)))
    return (
        f'<iframe style="width:100%;height:min(27rem,90vw);border:0;border-radius:.4rem" onload="{_TALL}" '
        f'title="{html.escape(title)} turning" srcdoc="{html.escape(linked)}"></iframe>'
    )
