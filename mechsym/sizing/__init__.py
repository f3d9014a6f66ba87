"""Component sizing: one rule per function, SI units, numbers and arrays in, numbers out.

Nothing here knows a mechanism or an engine cycle: loads arrive as arrays (`loads.py`). A rule refuses input outside
its validity with `BadInput`; an unsafe part is not an error but a `Check` whose factor is below the wanted one.
Values that a source chose or printed differently are functions of their own with the suffix `_printed`.
"""
