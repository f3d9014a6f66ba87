"""Cylinder pressure and the engine cycle. Knows a mechanism only through its volume function."""
