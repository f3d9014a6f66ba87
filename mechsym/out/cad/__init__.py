"""Drawings of the guide for the workshop.

curve.py   path and walls as cubic curves with exact tangents     dxf.py     layers, in millimetres
check.py   a file read again and measured against the path        sheet.py   dimensioned sheet, SVG or PDF
"""

from mechsym.out.cad.curve import Groove, track

__all__ = ["Groove", "track"]
