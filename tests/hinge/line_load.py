"""A limit of its own for the tests: force of the spring by the width of contact."""

from mechsym.hinge.choices import GuideLimit, Limits
from mechsym.quantities import record

LINE_LOAD = GuideLimit(
    name="line_load", words="spring force on a width of roller", shown="N/mm",
    unit="N/m", about="spring force by the width of contact", allowed={"above": 0},
    value=lambda at, setting: at.force / at.rollers.width,
)  # fmt: skip


@record
class WithLineLoad(Limits):
    """Its one row."""

    line_load: float | None = LINE_LOAD.setting(default=None)
