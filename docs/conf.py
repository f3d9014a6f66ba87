"""The docs site: `make docs` writes it to docs/_build/html, offline; pages that follow from the program come first."""

import logging
import re
import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))

project = "mechsym"
author = "The mechsym team"
extensions = ["myst_parser"]
html_theme = "furo"
html_title = "mechsym"
exclude_patterns = ["_build", "gallery"]
myst_heading_anchors = 3
myst_enable_extensions = ["colon_fence"]
html_copy_source = False
html_show_copyright = False
_OUTSIDE = re.compile(r"\[([^\]]+)\]\(\.\./[^)]*\)")
_FENCE = re.compile(r"^```(\w+) [^\n]*$", re.MULTILINE)


def _read(app, name, source):
    """Links to code beside the docs become code; what the tests read behind a block's language goes."""
    import findings

    source[0] = _FENCE.sub(r"```\1", _OUTSIDE.sub(r"`\1`", source[0]))
    if name == "start":
        import pages

        source[0] = pages.with_results(source[0], HERE / "made" / "printed")
    if name == "errata":
        source[0] = findings.typeset(source[0])


def _make(app):
    import findings
    import gallery
    import pages

    logging.getLogger().setLevel(logging.WARNING)  # the theme's colours ask for the talk of every library
    pages.make(HERE / "made")
    findings.make(HERE)
    gallery.make(HERE / "made" / "gallery")


def setup(app):
    app.connect("builder-inited", _make)
    app.connect("source-read", _read)
