"""Loading shared objects: through ctypes, and as a Python module for fast scalar calls."""

import ctypes
import functools
import importlib.machinery
import importlib.util
from types import ModuleType

from mechsym.native import cache


@functools.lru_cache(maxsize=256)
def load(source: str, mode: str) -> ctypes.CDLL:
    """Compile a source when needed and load it.

    Returns
    -------
    library : ctypes.CDLL
        Its `_name` is the path of the file
    """
    return ctypes.CDLL(str(cache.shared_object(source, mode)))


@functools.lru_cache(maxsize=256)
def module(path: str) -> ModuleType | None:
    """The same file as a Python extension module.

    Parameters
    ----------
    path : str
        Path of a loaded shared object

    Returns
    -------
    module : module or None
        None when it was compiled without Python's headers
    """
    loader = importlib.machinery.ExtensionFileLoader("mechsym_native", path)
    spec = importlib.util.spec_from_file_location("mechsym_native", path, loader=loader)
    assert spec is not None
    try:
        found = importlib.util.module_from_spec(spec)
    except ImportError:
        return None
    loader.exec_module(found)
    return found
