import sys

from setuptools import find_packages, setup

# A clone is installed by its path, so that `import mechsym` means it from any folder; mechsym/__init__.py finds
# generated/ and derivations/ there. What is built takes them in.
NAMES = () if "editable_wheel" in sys.argv else ("generated", "derivations")
BESIDE = {f"mechsym.{name}": name for name in NAMES}

setup(packages=[*find_packages(include=["mechsym*"]), *BESIDE], package_dir={"": ".", **BESIDE})
