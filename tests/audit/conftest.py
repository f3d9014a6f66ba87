"""Theories for the auditor's tests."""

import pytest

from mechsym.audit.judge.question import Question
from mechsym.audit.read.reader import read
from mechsym.audit.theory.catalogue import theory
from mechsym.audit.theory.record import known

LETTERS = {"L": "l1 + l2", "P2": "m2*g", "P3": "m3*g", "P4": "m4*g", "P5": "m5*g", "IC22": "IC2"}
INERTIA = (
    "I01 + P2/g*(r**2*(sin(phi) {sign} l1*lam/(2*L)*sin(2*phi))**2 + l2**2*cos(phi)**2*r**2/L**2)"
    " + IC22*lam**2*cos(phi)**2/(1 - 1/4*lam**2 + 1/4*lam**2*cos(2*phi))**2"
    " + (P3 + P4 + P5)/g*r**2*(sin(phi) + 1/2*lam*sin(2*phi))**2"
)


@pytest.fixture(scope="session")
def ask():
    """A question about the crosshead engine, or another theory."""

    def question(text, quantity, letters=LETTERS, **more):
        name, _, quantity = quantity.rpartition(".")
        found = theory(name or "crosshead")
        return Question(formula=read(text, known(found), letters), theory=found, quantity=quantity, **more)

    return question


@pytest.fixture(scope="session")
def inertia():
    """Equation (2) of source 000: as printed (-) and with the sign turned (+)."""
    return {sign: INERTIA.format(sign=sign) for sign in "+-"}
