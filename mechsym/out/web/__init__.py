"""A page that simulates: the C of the FMU as WebAssembly inside one HTML file, without a server.

build.py   C to WebAssembly, and the page        page.c     what the page calls
page.html  sliders, curves, the turning guide
"""

from mechsym.out.web.build import page

__all__ = ["page"]
