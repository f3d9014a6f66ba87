"""The docs site: `make docs` writes it to docs/_build/html, offline; pages that follow from the program come first."""

import logging
import re
import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))

import mechsym  # noqa: E402

project = "mechsym"
author = "The mechsym team"
version = release = mechsym.__version__
extensions = ["myst_parser", "directives"]
html_theme = "furo"
html_title = f"mechsym {mechsym.__version__}"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_math_renderer = "mathml"
LIVE = HERE / "made" / "extra"
LIVE.mkdir(parents=True, exist_ok=True)
html_extra_path = ["made/extra"]
exclude_patterns = ["_build", "gallery", "printed", "made/extra"]
myst_heading_anchors = 3
myst_enable_extensions = ["colon_fence", "attrs_inline"]
html_copy_source = False
html_show_copyright = False
_OUTSIDE = re.compile(r"\[([^\]]+)\]\(\.\./(?:mechsym|benchmarks|derivations|generated|examples|tests)/[^)]*\)")
_FENCE = re.compile(r"^```(\w+) [^\n]*$", re.MULTILINE)


def _read(app, name, source):
    """Links to code beside the docs become code; what the tests read behind a block's language goes."""
    import findings
    import walks

    if (HERE / f"{name}.md") in walks.PAGES:
        source[0] = walks.with_results(HERE / f"{name}.md", source[0], HERE / "made" / "walks")
    source[0] = _FENCE.sub(r"```\1", _OUTSIDE.sub(r"`\1`", source[0]))
    if name == "errata":
        source[0] = findings.typeset(source[0])


def _make(app):
    import findings
    import gallery
    import pages
    import python_pages
    import walks

    logging.getLogger().setLevel(logging.WARNING)  # the theme's colours ask for the talk of every library
    pages.make(HERE / "made")
    python_pages.make(HERE / "made")
    pages.clear(HERE / "made")
    findings.make(HERE)
    gallery.make(HERE / "made" / "gallery")
    walks.make(HERE / "made" / "walks")
    walks.live(LIVE)


def setup(app):
    app.connect("builder-inited", _make)
    app.connect("source-read", _read)
