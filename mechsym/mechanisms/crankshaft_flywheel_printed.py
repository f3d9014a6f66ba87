"""The model exactly as the source prints it: letters, numbers and drawing are those of the exact one."""

from mechsym.mechanisms.crankshaft_flywheel import TRAITS

__all__ = ["TRAITS"]
