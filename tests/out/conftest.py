import pytest
from built_in import needed

from mechsym import cases
from mechsym.jobs.export import ready
from mechsym.out.block import block_of
from mechsym.out.fmi import fmu, write


@pytest.fixture(scope="session")
def exported():
    """(run, block) of a built-in case, made once."""
    made = {}

    def get(name):
        if name not in made:
            case = cases.load(name, needed(name))
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
