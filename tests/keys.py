"""Keys that a reader would see: words with `_` in them, or dotted names, outside what is there to be typed."""

import html
import re

_UNSEEN = re.compile(r"<(script|style|code|math|desc|title)\b.*?</\1>|<!--.*?-->|srcdoc=\"[^\"]*\"", re.DOTALL)
_FILE = "(?:csv|json|toml|py|svg|html|md|dxf|fmu)"
_KEY = re.compile(
    rf"(?<![\w./\\-])[A-Za-z]\w*_\w+(?![\w(/]|\.{_FILE})"
    rf"|(?<![\w./\\-])[a-z_]{{3,}}\.(?!{_FILE}\b)[A-Za-z]\w*(?![\w(/-]|\.\w)"
)


def shown_keys(page):
    """Keys in the text of a page that is seen, pictures among it."""
    text = html.unescape(re.sub(r"<[^>]*>", " ", _UNSEEN.sub(" ", page)))
    return sorted({found for found in _KEY.findall(text)})
