"""Shared fixtures: seeded random numbers, the built-in parameters; settings of hypothesis and of the compiler."""

import contextlib
import gc
import os
from pathlib import Path

import numpy as np
import pytest
from hypothesis import settings

from mechsym.mechanisms.crankshaft_flywheel import CrankshaftFlywheelParameters
from mechsym.mechanisms.crosshead import CrossheadParameters
from mechsym.native import compiler
from mechsym.quantities.display import choose

# Hundreds of files are compiled for the tests; these rooms look at what users get, the others do without the last
# optimisation
_AS_USERS = ("generated", "native", "proof")
_QUICK = "MECHSYM_TESTS_QUICK"  # told to workers, which see the CC that is set here
if "CC" not in os.environ:
    with contextlib.suppress(compiler.NoCompiler):
        os.environ["CC"] = f"{compiler.find().command[0]} -O1"
        os.environ[_QUICK] = "1"

# what a test process keeps is looked through less often, which took a twelfth of the time
gc.set_threshold(200_000, 50, 50)

settings.register_profile("mechsym", deadline=None, derandomize=True, max_examples=30)
settings.load_profile("mechsym")


def pytest_addoption(parser):
    parser.addoption("--update", action="store_true", help="rewrite the golden files instead of comparing with them")


def pytest_collection_modifyitems(items):
    """The longest come first, those of the site and the wheel: at the end one process would wait for them."""
    items.sort(key=lambda item: item.path.parent != Path(__file__).parent)


@pytest.fixture(autouse=True)
def _compiled_as_for_users(request, monkeypatch):
    as_users = request.path.parent.name in _AS_USERS or request.node.get_closest_marker("as_users")
    if _QUICK in os.environ and as_users:
        monkeypatch.delenv("CC", raising=False)


@pytest.fixture(autouse=True)
def _usual_units():
    """A command that is called within a process leaves the units that it was asked for."""
    yield
    choose(None)


@pytest.fixture
def rng():
    return np.random.default_rng(20240615)


@pytest.fixture
def zotov():
    """Data of Zotov et al. (2024), caption of Fig. 4."""
    return CrossheadParameters(
        r1=0.2, r2=0.3, l1=0.8, l2=0.75, m1=80, m2=150, m3=150, m4=200, m5=110, I01=30, IC2=50, g=9.81
    )


@pytest.fixture
def chmielewski():
    """Data of Chmielewski et al. (2015)."""
    return CrankshaftFlywheelParameters(I0=0.26, I2=0.58, r=0.06, l=0.26, m0=1.1, k1=6500)


@pytest.fixture(scope="session")
def measured_data():
    """Folder with measured diagrams, which are no part of the project."""
    folder = os.environ.get("MECHSYM_TEST_DATA")
    if not folder:
        pytest.skip("measured data: set MECHSYM_TEST_DATA to the folder that holds them")
    return Path(folder)
