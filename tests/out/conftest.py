import os
from pathlib import Path

import pytest

from mechsym import cases
from mechsym.jobs.export import ready
from mechsym.out.fmi import fmu, write
from mechsym.out.laws import block_of

DATA = os.environ.get("MECHSYM_TEST_DATA")


def settings(name):
    """What a built-in case needs besides its name: the start-up amplifies rounding after 10 s, the generator a file."""
    if name == "generator":
        if not DATA:
            pytest.skip("MECHSYM_TEST_DATA is not set: the measured diagrams are not here")
        return {"cycle.file": str(Path(DATA) / "generator-half-load.csv")}
    return {"t_end": "10 s"} if name == "chmielewski" else {}


@pytest.fixture(scope="session")
def exported():
    """(run, block) of a built-in case, made once."""
    made = {}

    def get(name):
        if name not in made:
            case = cases.load(name, settings(name))
            run = ready(case)
            made[name] = run, block_of(case.name, case.about, run)
        return made[name]

    return get


@pytest.fixture(scope="session")
def unit(exported, tmp_path_factory):
    """Path of the FMU of a built-in case, made once."""
    made = {}

    def get(name, version):
        if (name, version) not in made:
            path = tmp_path_factory.mktemp("fmu") / f"{name}.{version}.fmu"
            made[name, version] = write(fmu(exported(name)[1], version), path)
        return made[name, version]

    return get
