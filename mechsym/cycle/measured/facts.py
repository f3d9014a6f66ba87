"""What a measured diagram tells of the engine, cycle by cycle, and of itself: work, weak cycles, facts and doubts."""

import math

import numpy as np

from mechsym.cycle.chamber import Chamber, travel
from mechsym.cycle.measured.compression_line import free_exponent, polytropic_exponent
from mechsym.cycle.measured.diagram import Diagram, window
from mechsym.cycle.measured.measure import MeasuredCycles, around_compression
from mechsym.cycle.measured.smoothing import noise

_WEAK = 0.7


def cycle_work(measured: MeasuredCycles, cylinder: Chamber) -> np.ndarray:
    r"""Mean indicated pressure of every cycle, net over the period.

    .. math:: p_{mi,k} = \frac{1}{s} \sum_i p_{k,i}\,x'(\varphi_i)\,\Delta\varphi

    Returns
    -------
    p_mi : ndarray, shape (k,)
        Mean indicated pressure [Pa]
    """
    step = measured.period / measured.phi.size
    return measured.cycles @ travel(cylinder.motion, measured.phi)[1] * step / cylinder.stroke


def work_per_angle(measured: MeasuredCycles, cylinder: Chamber) -> float:
    r"""How much the mean cycle's work changes when the dead centre moves.

    .. math:: \frac{1}{p_{mi}} \frac{d p_{mi}}{d \varphi_{tdc}}

    Returns
    -------
    slope : float
        Relative change by angle, the pegging held; negative as a later dead centre means less work [1/rad]
    """
    by = math.radians(0.5)
    mean = measured.cycles.mean(axis=0)
    later, here, earlier = (float(mean @ travel(cylinder.motion, measured.phi + s)[1]) for s in (-by, 0.0, by))
    return (later - earlier) / (2 * by) / here


def weak_cycles(p_mi: np.ndarray) -> tuple[int, ...]:
    """Cycles that do less than 0.7 times the median work: misfires, near-misfires and late burns.

    Parameters
    ----------
    p_mi : ndarray, shape (k,)
        Mean indicated pressure of every cycle [Pa]
    """
    return tuple(int(k) for k in np.flatnonzero(p_mi < _WEAK * np.median(p_mi)))


def diagram_facts(diagram: Diagram, cylinder: Chamber, measured: MeasuredCycles, residual: float) -> tuple[str, ...]:
    """What was assumed on the way from the file to the mean cycle, and what came out.

    Parameters
    ----------
    residual : float
        Root mean square of what the smoothing left out [Pa]
    """
    p_mi = cycle_work(measured, cylinder) / 1e5
    scatter = float(measured.cycles.std(axis=0).max())
    return (
        *(f"the file says: {comment}" for comment in measured.comments),
        f"{measured.file}: {len(p_mi)} cycles; net mean indicated pressure {p_mi.min():.2f} to {p_mi.max():.2f} bar, "
        f"peaks {measured.cycles.max(axis=1).min() / 1e5:.1f} to {measured.cycles.max() / 1e5:.1f} bar absolute",
        _alignment_fact(diagram, measured, work_per_angle(measured, cylinder) * math.radians(1.0)),
        _pegging_fact(diagram, measured),
        _scale_fact(diagram, measured),
        _exponent_fact(diagram, cylinder, measured),
        f"smoothing ({diagram.smoothing}) leaves {residual / 1e5:.4f} bar rms of the mean cycle; its noise is "
        f"{noise(measured.cycles.mean(axis=0)) / 1e5:.4f} bar, the cycles scatter by up to {scatter / 1e5:.2f} bar",
        _weak_fact(p_mi),
        f"under the piston: {diagram.p_back / 1e5:.4g} bar absolute",
    )


def _alignment_fact(diagram: Diagram, measured: MeasuredCycles, per_degree: float) -> str:
    how = {
        "given": "given",
        "motored_peak": f"peak of a motored diagram plus a loss angle of {math.degrees(diagram.loss_angle):.2f} deg "
        "(assumed)",
        "compression_line": f"where the compression line from {math.degrees(diagram.fit_from):.0f} to "
        f"{math.degrees(diagram.fit_to):.0f} deg is straightest for the exponent {diagram.n_c:g} (assumed)",
    }[diagram.alignment]
    spread = measured.tdc_uncertainty
    known = "not estimated" if spread is None else f"+- {math.degrees(spread):.1f} deg"
    return (
        f"firing dead centre at {math.degrees(measured.tdc):.2f} deg of the file, {known}: {how}; "
        f"one degree changes the work by {100 * per_degree:+.1f} %"
    )


def _pegging_fact(diagram: Diagram, measured: MeasuredCycles) -> str:
    how = {
        "none": "none, the file is taken as absolute",
        "gauge": f"the file is taken as gauge, over {diagram.p_back / 1e5:.4g} bar absolute",
        "inlet": f"{diagram.inlet_pressure / 1e5:.3g} bar absolute at the dead centre before compression (assumed)",
        "polytropic": f"every cycle's compression line follows the exponent {diagram.n_c:g} (assumed)",
    }[diagram.pegging]
    low, high = measured.offsets.min() / 1e5, measured.offsets.max() / 1e5
    return f"pegging: {how}; {low:.3f} to {high:.3f} bar were taken off the cycles"


def _scale_fact(diagram: Diagram, measured: MeasuredCycles) -> str:
    start = f"the compression line of the file as it is starts from {measured.line.p_bdc / 1e5:.3g} bar absolute at BDC"
    if diagram.scale == "as_given":
        return f"scale as given; {start}"
    assumed = {
        "trapped": f"{diagram.inlet_pressure / 1e5:.3g} bar there",
        "exhaust": f"{diagram.exhaust_pressure / 1e5:.3g} bar in the middle of the exhaust stroke",
    }[diagram.scale]
    return (
        f"scaled by {measured.scale:.4f}: {start}; assumed are {assumed}, with which the line starts from "
        f"{measured.scale * measured.line.p_bdc / 1e5:.3g} bar; all pressures and the work are as uncertain"
    )


def _drift(measured: MeasuredCycles) -> float:
    # signal at the dead centre before compression against the compression line drawn on to there
    phi, mean = around_compression(measured.phi, measured.cycles.mean(axis=0), measured.period)
    return float(mean[np.abs(phi + math.pi) < 0.1].mean() / (measured.scale * measured.line.p_bdc))


def _exponent_fact(diagram: Diagram, cylinder: Chamber, measured: MeasuredCycles) -> str:
    line = window(diagram)
    found = polytropic_exponent(measured.phi, measured.cycles.mean(axis=0), cylinder, line)
    free = free_exponent(measured.phi, measured.raw_mean, cylinder, line)
    return f"compression exponent of the pegged diagram {found:.3f}; with a free offset the data prefer {free:.3f}"


def _weak_fact(p_mi: np.ndarray) -> str:
    weak = weak_cycles(p_mi)
    if not weak:
        return f"no cycle does less than {_WEAK:g} of the median work"
    named = ", ".join(f"{k + 1} ({p_mi[k]:.2f} bar)" for k in weak)
    return f"nearly misfired (less than {_WEAK:g} of the median work), kept in the mean: cycle {named}"


def diagram_doubts(diagram: Diagram, cylinder: Chamber, measured: MeasuredCycles, phi_p_max: float) -> tuple[str, ...]:
    """What looks physically implausible in a measured diagram.

    Parameters
    ----------
    phi_p_max : float
        Crank angle of the highest pressure, from firing TDC [rad]

    Returns
    -------
    doubts : tuple of str
        One sentence each; empty if nothing does
    """
    found = []
    ratio = measured.scale * measured.line.p_bdc / diagram.inlet_pressure
    exponent = polytropic_exponent(measured.phi, measured.cycles.mean(axis=0), cylinder, window(diagram))
    drift = _drift(measured)
    if not 0.7 < ratio < 1.4:
        found.append(
            f"compression starts from {ratio:.2f} times the inlet pressure {diagram.inlet_pressure / 1e5:.3g} bar: "
            "the sensor's scale or the inlet pressure is wrong; scale = 'exhaust' or 'trapped' corrects the first"
        )
    if not 0.7 < drift < 1.4:
        found.append(
            f"the signal at BDC is {drift:.2f} of what the compression line drawn on to there says: the sensor drifts "
            "within the cycle, and pressures of the gas exchange are as wrong"
        )
    if not 1.2 < exponent < 1.42:
        found.append(f"compression exponent {exponent:.2f} is outside 1.2 to 1.42: dead centre or pegging is wrong")
    if not math.radians(-3) < phi_p_max < math.radians(60):
        found.append(f"the pressure peaks {math.degrees(phi_p_max):.1f} deg after TDC: the dead centre is wrong")
    if measured.tdc_uncertainty is not None and measured.tdc_uncertainty > math.radians(5):
        found.append("the dead centre is uncertain by more than 5 deg: it depends on the window and the exponent")
    return tuple(found)
