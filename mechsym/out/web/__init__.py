"""A page that simulates: the C of the FMU as WebAssembly inside one HTML file, without a server.

build.py   C to WebAssembly, the page, the page inside a report        page.c     what the page calls
page.html  sliders and curves
"""

from mechsym.out.web.build import LiveRun, page, with_live

__all__ = ["LiveRun", "page", "with_live"]
