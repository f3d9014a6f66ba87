"""What `[cycle]` says of a measured indicator diagram: the engine, the file, and a named method for each step.

    file --read--> recording --cut--> cycles --align--> phi = 0 at firing TDC --peg, scale--> absolute pressure --> mean

The steps stand in `file`, `cycles`, `alignment`, `measure` and `pressure`.
"""

import math

from mechsym.cycle.measured.joint_fit import Prior
from mechsym.cycle.pressure import ATMOSPHERE
from mechsym.errors import BadInput
from mechsym.quantities import choice, quantity, record, reference
from mechsym.quantities.units import Radian


@record
class Diagram:
    """Inputs: `[cycle]` with `kind = "diagram"`."""

    bore: float = quantity("m", low=1e-3, high=10, about="diameter of the piston")
    compression_ratio: float = quantity("-", above=1, about="geometric compression ratio")
    #: `two-stroke` (period 2 pi) or `four-stroke` (4 pi)
    working_cycle: str = choice("two-stroke", "four-stroke", about="period of the diagram")
    #: CSV file; a path in a case file may start from the folder of that file
    file: str = reference("file", "")
    #: Record without combustion on the same encoder, which tells the dead centre of both
    motored: str = reference("file", "")
    #: Headers to take where several columns carry such a unit
    angle_column: str = ""
    pressure_column: str = ""
    recorded_speed: float | None = quantity(
        "rad/s", default=None, above=0, about="speed of a file that has times and no angles"
    )
    #: Dead centre: `given` (tdc_offset), `motored_peak` (peak of a motored diagram plus loss_angle) or
    #: `compression_line` (a joint fit of that line, or of the file `motored`)
    alignment: str = choice("given", "motored_peak", "compression_line", default="compression_line")
    tdc_offset: float = quantity("rad", default=0.0, about="angle of the file at firing TDC")
    #: From the pressure peak of a motored engine to TDC, for `motored_peak` [rad]
    loss_angle: float = quantity(
        "rad",
        default=math.radians(0.7),
        low=0,
        high=0.1,
        about="motored peak to TDC",
        only=("alignment", "motored_peak"),
    )
    #: Offset: `none` (the file is absolute), `gauge` (it is above p_back), `inlet` (inlet_pressure at the bottom dead
    #: centre before compression) or `polytropic` (the compression line follows the exponent n_c) or `joint` (its joint
    #: fit with dead centre, exponent and losses). The last three take off first what the mean cycle drifts by: it ends
    #: where it began
    pegging: str = choice("none", "gauge", "inlet", "polytropic", "joint", default="joint")
    #: `checked` (as read, refused where the compression line starts outside 0.7 to 1.4 times inlet_pressure),
    #: `as_given` (as read, a doubt there), `trapped` (that line starts from inlet_pressure at bottom dead centre) or
    #: `exhaust` (the mean over the middle of the exhaust stroke is exhaust_pressure); the last two take the
    #: offset of the compression line, `joint` or `polytropic`. `swing`: as read, less the sensor's drift and the slow
    #: swing of its heated membrane, so that the exhaust stroke has exhaust_pressure beside the offset of `inlet`
    scale: str = choice("checked", "as_given", "trapped", "exhaust", "swing", default="checked")
    #: Absolute pressure at the bottom dead centre before compression, and while the exhaust is pushed out; without the
    #: first the scale is checked against 0.2 to 5 bar only [Pa]
    inlet_pressure: float | None = quantity("Pa", default=None, above=0, below=20e5, about="absolute, at BDC")
    exhaust_pressure: float = quantity(
        "Pa", default=1.05e5, above=0, below=20e5, about="absolute, exhaust stroke", only=("scale", "exhaust", "swing")
    )
    #: Where the compression line is read: after the inlet closes, before combustion starts [rad]
    fit_from: float = quantity("rad", default=math.radians(-90.0), low=-2.8, below=0, about="start of the line")
    fit_to: float = quantity("rad", default=math.radians(-15.0), low=-2.8, below=0, about="end of the line")
    n_c: float = quantity("-", default=1.30, low=1.1, high=1.5, about="exponent of compression to expect")
    #: `spline` (down to the noise of the mean cycle) or `interpolate` (through every point)
    smoothing: str = choice("spline", "interpolate", default="spline")
    p_back: float = quantity("Pa", default=ATMOSPHERE, low=0, about="absolute pressure under the piston")

    def __post_init__(self) -> None:
        if self.fit_to - self.fit_from < math.radians(30.0):
            raise BadInput(
                f"fit_to = {math.degrees(self.fit_to):g} deg must lie at least 30 deg behind "
                f"fit_from = {math.degrees(self.fit_from):g} deg"
            )
        wants = "scale = 'trapped'" if self.scale == "trapped" else "pegging = 'inlet'"
        if self.inlet_pressure is None and (self.scale == "trapped" or self.pegging == "inlet"):
            raise BadInput(f"{wants} needs inlet_pressure: the absolute pressure at BDC before compression, in Pa")
        if self.motored and self.alignment != "compression_line":
            raise BadInput(f"motored and alignment = {self.alignment!r} both give the dead centre; leave one out")
        if self.scale in ("trapped", "exhaust") and self.pegging not in ("polytropic", "joint"):
            raise BadInput(f"scale = {self.scale!r} needs pegging = 'joint' or 'polytropic', not {self.pegging!r}")
        if self.scale == "swing" and self.pegging != "inlet":
            raise BadInput("scale = 'swing' needs pegging = 'inlet': the pressure is known at two places of the cycle")
        if self.scale in ("exhaust", "swing") and self.working_cycle != "four-stroke":
            raise BadInput(
                f"scale = {self.scale!r} needs an exhaust stroke; a two-stroke cycle has none, use 'trapped'"
            )


@record
class BrakeMeasured:
    """Section `[measured]`: what was measured beside the pressure."""

    torque: float = quantity("N*m", above=0, about="mean brake torque of one cylinder while the diagram was recorded")


def line_prior(diagram: Diagram) -> Prior:
    """What is known of the charge line before it is fitted: the exponent to expect, and the share that losses take."""
    # without its losses the exponent at 45 degrees before TDC is about 0.03 above that of the whole line
    return Prior(n0=(diagram.n_c + 0.03, Prior().n0[1]))


def period_of(diagram: Diagram) -> Radian:
    """Period of the diagram. Returns period: 2 pi or 4 pi."""
    return 2 * math.pi if diagram.working_cycle == "two-stroke" else 4 * math.pi
