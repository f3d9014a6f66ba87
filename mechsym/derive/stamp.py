"""The stamp of a generated file: two hashes, of what it came from and of what it holds."""

import hashlib

import sympy


def header(script: str, source_hash: str, body_hash: str) -> str:
    """The stamp of a generated file: what it came from and that it is not to be edited.

    Parameters
    ----------
    script : str
        Path of the derivation
    source_hash, body_hash : str
        16 hex digits each

    Returns
    -------
    text : str
        Comment lines
    """
    return (
        f"# Generated from {script} by mechsym.derive. Do NOT edit: run `make derive`.\n"
        f"# source sha256: {source_hash}   ({script} + mechsym/derive/*.py, newlines normalised)\n"
        f"# body   sha256: {body_hash}   (everything below this header)\n"
        f"# sympy {sympy.__version__}\n"
    )


def digest(text: str) -> str:
    """First 16 hex digits of the SHA-256 of a text with newlines normalised.

    Parameters
    ----------
    text : str
        Any text

    Returns
    -------
    digits : str
        16 hex digits
    """
    return hashlib.sha256(text.replace("\r\n", "\n").encode()).hexdigest()[:16]
