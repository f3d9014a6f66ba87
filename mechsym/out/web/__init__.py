"""A page that simulates: the C of the FMU as WebAssembly inside one HTML file, without a server.

build.py   C to WebAssembly, and the page        page.c     what the page calls
page.html  sliders and curves    live.py    the page inside a report
"""

from mechsym.out.web.build import LiveRun, page, with_live

__all__ = ["LiveRun", "page", "with_live"]
