"""The meaning of a record's fields, read off the comments beside them."""

import ast
import functools
import inspect
import textwrap
from collections.abc import Mapping


@functools.lru_cache(maxsize=256)
def comments(cls: type) -> Mapping[str, str]:
    """What a `#:` comment says of each field of a record, beside it or above it."""
    try:
        source = textwrap.dedent(inspect.getsource(cls))
    except (OSError, TypeError):  # a record that was made at run time
        return {}
    lines, said, above, beside = source.splitlines(), {}, "", False
    fields = {node.lineno: node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.AnnAssign)}
    for number, line in enumerate(lines, 1):
        text = line.partition("#:")[2].strip()
        if number in fields:
            name = fields[number].target
            said[getattr(name, "id", "")] = text or above
            above = above if not text and above else ""
            beside = False
        elif line.strip().startswith("#:"):
            above, beside = f"{above} {text}" if beside else text, True
    return {name: text for name, text in said.items() if text}
