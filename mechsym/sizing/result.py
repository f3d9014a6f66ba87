"""What sizing an engine gave."""

import functools
from typing import Any

from mechsym.files import Json
from mechsym.page import Shown
from mechsym.quantities import record
from mechsym.quantities.results import tell
from mechsym.sizing.checks import Check
from mechsym.sizing.hypocycloid.engine import Stock
from mechsym.sizing.rows import SizeRow


@record
class Sizing(Shown):
    """What sizing an engine gave."""

    told: list[SizeRow]
    failing: list[Check]
    converged: bool
    rounds: int
    parts: Any
    forces: Any
    stock: Stock | None  #: None where no stock part belongs to it

    @functools.cached_property
    def rows(self) -> list[Json]:
        """The rows as JSON shows them."""
        return [tell(row) for row in self.told]
