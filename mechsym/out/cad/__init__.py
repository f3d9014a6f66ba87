"""Drawings and bodies for the workshop.

curve.py    path and walls as cubic curves with exact tangents    dxf.py         layers, in millimetres
check.py    a DXF read again and measured against the path        sheet.py       dimensioned sheet, SVG or PDF
solids.py   turned bodies and plates with their volumes           step.py        disc, rollers and bodies as STEP
"""

from mechsym.out.cad.curve import Groove, track

__all__ = ["Groove", "track"]
