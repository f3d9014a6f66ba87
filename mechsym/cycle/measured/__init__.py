"""Measured diagrams: read, aligned, taken apart."""
