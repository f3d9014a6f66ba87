"""What is compiled here is compiled as users have it, with all optimisation."""

import pytest


@pytest.fixture(autouse=True)
def optimised(monkeypatch):
    monkeypatch.delenv("CC", raising=False)
