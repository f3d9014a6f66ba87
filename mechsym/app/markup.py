"""Tables, bars and charts of the workbench as text for the browser; everything from outside is escaped."""

import html
from typing import Any

from mechsym.app.answers import Answer, Plotted
from mechsym.app.commands import Run

_COLOURS = ("#1f5fa8", "#b5342b", "#2f7d4f")


def table(answer: Answer, pinned: Answer | None) -> str:
    """Figures of an answer, those of a pinned one beside them."""
    other = dict(pinned.rows) if pinned else {}
    rows = (
        f"<tr><td>{html.escape(name)}</td><td style='padding-left:1em'>{html.escape(value)}</td>"
        f"<td style='padding-left:1em;color:#5b6570'>{html.escape(other.get(name, ''))}</td></tr>"
        for name, value in answer.rows
    )
    return f"<table>{''.join(rows)}</table>"


def bars(answer: Answer) -> str:
    """Limits as bars with what is left of them."""
    parts = []
    for bar in answer.bars:
        left = 1.0 if bar.margin is None else max(0.0, min(1.0, bar.margin))
        colour = "#2f7d4f" if bar.kept else "#b5342b"
        parts.append(
            f"<div style='font-size:.85rem;margin-bottom:.2rem'>{html.escape(bar.text)}"
            f"<div style='background:#e3e6ea;height:.4rem'><div style='background:{colour};height:.4rem;"
            f"width:{100 * (left if bar.kept else 1):.0f}%'></div></div></div>"
        )
    return "".join(parts)


def run_table(found: Run) -> str:
    """What a command said."""
    rows = "".join(f"<tr><td>{html.escape(k)}</td><td style='padding-left:1em'>{html.escape(v)}</td></tr>"
                   for k, v in found.rows)  # fmt: skip
    words = f"<p>{html.escape(found.words)}</p>" if found.words else ""
    return f"<p>exit status {found.status}</p>{words}<table>{rows}</table>"


def chart(curves: list[tuple[Plotted, str]]) -> dict[str, Any]:
    """Curves with their line styles as the options of a chart."""
    first = curves[0][0]
    series = [
        {"type": "line", "name": c.name + (" pinned" if style == "dashed" else ""), "showSymbol": False,
         "lineStyle": {"type": style, "width": 1.5}, "color": _COLOURS[i % 3],
         "data": [list(p) for p in zip(c.x, c.y, strict=True)]}
        for i, (c, style) in enumerate(curves)
    ]  # fmt: skip
    return {
        "animation": False, "tooltip": {"trigger": "axis"},
        "title": {"text": first.y_name, "textStyle": {"fontSize": 12}},
        "grid": {"left": 50, "right": 10, "top": 30, "bottom": 40},
        "xAxis": {"type": "value", "name": first.x_name, "nameLocation": "middle", "nameGap": 25, "max": first.x[-1]},
        "yAxis": {"type": "value", "scale": True}, "series": series,
    }  # fmt: skip


def frame(page: str, title: str) -> str:
    """A whole page inside the page."""
    return (
        f'<iframe style="width:100%;height:40rem;border:0" title="{html.escape(title)} turning" '
        f'srcdoc="{html.escape(page)}"></iframe>'
    )
