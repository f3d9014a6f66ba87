"""A folder with the cases and files that the commands of the matrix are asked about."""

import pytest
from matrix.entries import prepare


@pytest.fixture(scope="session")
def prepared(tmp_path_factory):
    folder = tmp_path_factory.mktemp("matrix")
    prepare(folder)
    return folder
