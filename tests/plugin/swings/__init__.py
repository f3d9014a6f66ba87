"""Mechanisms for mechsym."""
