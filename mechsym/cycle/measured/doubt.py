"""What is possible and not usual in a measured diagram: one record for each."""

from mechsym.quantities import record


@record
class Doubt:
    """A value that is possible and not usual."""

    code: str  #: One word by which a case can accept it
    quantity: str
    value: float  #: In the unit that `quantity` names [-]
    usual: str
    why: str
