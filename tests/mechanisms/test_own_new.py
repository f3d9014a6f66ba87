"""`mechsym new mechanism` writes what runs and what its own test holds for."""

import subprocess
import sys

import pytest


def run(folder, *command):
    return subprocess.run([sys.executable, "-m", *command], cwd=folder, capture_output=True, text=True, check=False)


@pytest.mark.slow
def test_what_is_written_passes_its_own_test_and_is_not_overwritten(tmp_path):
    assert run(tmp_path, "mechsym", "new", "mechanism", "toggle").returncode == 0
    tested = run(tmp_path, "pytest", "-q", "-p", "no:cacheprovider", "test_toggle.py")
    assert tested.returncode == 0, tested.stdout
    again = run(tmp_path, "mechsym", "new", "mechanism", "toggle")
    assert again.returncode == 2 and "exists" in again.stderr
    assert run(tmp_path, "mechsym", "new", "mechanism", "2x").returncode == 2
