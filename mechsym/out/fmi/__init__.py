"""Functional mock-up units, FMI 2.0 and 3.0, model exchange and co-simulation, sources inside.

describe.py   modelDescription.xml of a block      build.py   sources, binaries, the file
compare.py    an FMU against the simulation        fmi2.c, fmi3.c   the interface of c/core.h
"""

from mechsym.out.fmi.build import Unit, controller, fmu, write

__all__ = ["Unit", "controller", "fmu", "write"]
