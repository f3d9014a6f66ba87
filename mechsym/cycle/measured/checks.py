"""Cross-checks of a measured diagram: what each must give, and the doubt where it does not."""

import dataclasses
import math
from collections.abc import Iterator, Sequence

import numpy as np

from mechsym.cycle.chamber import Chamber, volume
from mechsym.cycle.measured.alignment import ENCODER, between, from_compression, from_motored
from mechsym.cycle.measured.diagram import Diagram, line_prior
from mechsym.cycle.measured.heat_release import burnt_fraction, heat_release, polytropic_fit
from mechsym.cycle.measured.joint_fit import (
    REFERENCE,
    JointFit,
    Prior,
    clearance_asked,
    joint_fit,
    log_pressure,
    mean_exponent,
)
from mechsym.cycle.measured.measure import USUAL_SCALE, MeasuredCycles, around_compression
from mechsym.cycle.measured.signal import noise
from mechsym.plausible import Doubt
from mechsym.quantities.units import NORMAL_95, NewtonMetre, Pascal, Pure, Radian, RadPerSecond, Volume

_DEG = math.radians(1.0)
_WIDEST, _DRIFT = 3.5 * _DEG, 0.25
_EXPONENT, _EXPANSION = (1.2, 1.42), (1.15, 1.40)
# up to the valve: 1.3 of burnt gas and what the walls take, in the built-in engine of 60 mm bore 0.08 at 8000 rpm and
# 0.20 at 300
_EXPANSION_TOLD = (1.15, 1.5)
_PEAK = (-3 * _DEG, 50 * _DEG)
_LOSS_ANGLE = (0.0, 2.5 * _DEG)
# heat of a stoichiometric mixture with air, by its mass: 2.75 MJ/kg for petrol and diesel, 2.7 for methane [J/kg]
_MIXTURE_HEAT = 3.0e6
_EARLY = (-0.12, 0.06)  # heat before ignition by the heat of the cycle: walls take some, nothing gives any
_GAMMA, _R, _T_CLOSED = 1.35, 287.0, 330.0
_SPEED = (0.75, 1.25)  # a record of the same operation; a run-down falls below
_FLOOR = 75 * _DEG  # inlet valves close at most 70 degrees behind the dead centre, then the pressure rises
_BURNT, _OPENS = 0.97, 110 * _DEG
_FREE = (0.2, 2.5)  # an engine that breathes freely, or with a small charger [bar]
_BENT, _SHEET = 2.25, 0.03  # standard deviations; of the clearance: what data sheets leave, 0.2 of a ratio of 8.5


def diagram_doubts(
    diagram: Diagram, cylinder: Chamber, measured: MeasuredCycles, phi_p_max: Radian
) -> tuple[Doubt, ...]:
    """What is unusual in a measured diagram. phi_p_max: angle of the highest pressure, from firing TDC."""
    doubts = [_scale(diagram, measured), *_of_sensor(diagram, cylinder, measured), _agreement(measured)]
    doubts += [_free(diagram, cylinder, measured), *_of_angles(measured), _geometry(diagram, cylinder, measured)]
    if not measured.alignment.motored:
        usual = (_PEAK[0] / _DEG, _PEAK[1] / _DEG)
        why = "no combustion peaks there: the dead centre is wrong, or most cycles misfire"
        doubts.append(_doubt("peak_angle", "crank angle of the highest pressure [deg]", phi_p_max / _DEG, usual, why))
        doubts += _combustion(diagram, cylinder, measured)
    return tuple(doubt for doubt in doubts if doubt is not None)


def _doubt(code: str, quantity: str, value: float, usual: tuple[float, float], why: str) -> Doubt | None:
    if usual[0] <= value <= usual[1]:
        return None
    return Doubt(code=code, quantity=quantity, value=value, usual=f"{usual[0]:.4g} to {usual[1]:.4g}", why=why)


def _scale(diagram: Diagram, measured: MeasuredCycles) -> Doubt | None:
    if diagram.scale in ("exhaust", "trapped"):
        why = "all pressures and the work hang on the pressure assumed for it; calibrate the sensor"
        return _doubt(
            "scale", f"factor on the pressure by scale = {diagram.scale!r} [-]", measured.scale, USUAL_SCALE, why
        )
    if diagram.inlet_pressure is None:
        why = "sensor or unit is wrong; scale = 'exhaust' corrects it; of a charged engine give its inlet_pressure"
        return _doubt("scale", "compression line at BDC [bar]", measured.bottom / 1e5, _FREE, why)
    ratio = measured.bottom / diagram.inlet_pressure
    why = "the sensor's scale, its unit or inlet_pressure is wrong; scale = 'exhaust' or 'trapped' corrects the first"
    return _doubt("scale", "compression line at BDC by inlet_pressure [-]", ratio, USUAL_SCALE, why)


def _of_sensor(diagram: Diagram, cylinder: Chamber, measured: MeasuredCycles) -> Iterator[Doubt | None]:
    # a sensor that is saturated below shows one value until compression has come up to it
    phi, mean = around_compression(measured.phi, measured.raw_mean, measured.period)
    rising = mean[(phi > -math.pi) & (phi < -math.pi / 3)]
    flat = np.count_nonzero(rising <= rising.min() + 1e-4 * np.ptp(mean)) * float(phi[1] - phi[0])
    why = "compression raises the pressure there: the sensor is saturated below, and the work is as wrong"
    yield _doubt("floor", "crank angle without any rise in compression [deg]", flat / _DEG, (0, _FLOOR / _DEG), why)
    # signal at the dead centre before compression against the charge line drawn on to there
    phi, mean = around_compression(measured.phi, measured.cycles.mean(axis=0), measured.period)
    off = float(mean[np.abs(phi + math.pi) < 0.1].mean() - measured.bottom) / measured.bottom
    limit = 0.04 * float(np.ptp(mean)) / measured.bottom + _DRIFT
    why = "the sensor drifts within the cycle: pressures of the gas exchange and the net work are as wrong"
    yield _doubt("drift", "signal at BDC less the charge line there, by the latter [-]", off, (-limit, limit), why)
    exponent = mean_exponent(cylinder, measured.alignment.fit.shape, *between(diagram))
    why = "dead centre, offset or compression ratio is wrong"
    yield _doubt("compression_exponent", "exponent of the compression line [-]", exponent, _EXPONENT, why)
    half = (measured.tdc_uncertainty or 0.0) / _DEG
    why = "the record says little of its dead centre; a motored record of the same encoder (--motored) says more"
    quantity = "half the 95 % interval of the dead centre [deg]"
    yield _doubt("dead_centre_width", quantity, half, (0.0, _WIDEST / _DEG), why)


def _of_angles(measured: MeasuredCycles) -> Iterator[Doubt | None]:
    off = (measured.alignment.spread or 0.0) / _DEG
    why = "the angles were spread evenly over each turn, the shaft does not turn evenly; take the angles by teeth"
    yield _doubt("even_angles", "how far the angles of the file may be off [deg]", off, (0.0, 0.5), why)
    loss = measured.alignment.dead_centre.loss_angle
    if loss is not None:
        why = "heat and blow-by let a motored engine peak 0.2 to 2 deg before its dead centre, never behind it"
        usual = (_LOSS_ANGLE[0] / _DEG, _LOSS_ANGLE[1] / _DEG)
        yield _doubt("loss_angle", "from the motored peak to the dead centre [deg]", loss / _DEG, usual, why)


def _agreement(measured: MeasuredCycles) -> Doubt | None:
    own, centre = measured.alignment.own, measured.alignment.dead_centre
    if own is None:
        return None
    apart = own.angle - centre.angle
    apart -= 2 * math.pi * round(apart / (2 * math.pi))
    limit = math.hypot((own.high - own.low) / 2, (centre.high - centre.low) / 2) / _DEG
    why = f"the record's own compression line has it elsewhere than {centre.method}: another encoder zero or engine?"
    return _doubt(
        "dead_centre", "compression line's dead centre less the one used [deg]", apart / _DEG, (-limit, limit), why
    )


def _free(diagram: Diagram, cylinder: Chamber, measured: MeasuredCycles) -> Doubt | None:
    """Dead centre with hardly any prior on the exponent."""
    if measured.alignment.own is not None or measured.alignment.motored:
        return None
    phi, mean = around_compression(measured.phi, measured.raw_mean, measured.period)
    free = Prior(n0=(line_prior(diagram).n0[0], 0.3))
    # up to where the line ends that is compared: it may burn before the end that the case names
    fit = joint_fit(phi, mean, cylinder, measured.alignment.fit.between, noise(mean), free, [0.0])
    spread = math.sqrt(float(fit.covariance[0, 0] + measured.alignment.fit.covariance[0, 0]))
    limit = NORMAL_95 * spread / _DEG
    why = "with the exponent free the dead centre is elsewhere: drift, early burning, or another compression ratio"
    quantity = "dead centre with a free exponent less the one used [deg]"
    return _doubt("free_exponent", quantity, fit.tdc / _DEG, (-limit, limit), why)


def _geometry(diagram: Diagram, cylinder: Chamber, measured: MeasuredCycles) -> Doubt | None:
    """The compression ratio with which the line fits best, all that is not known of it free.

    A wrong clearance bends the line by V_c/V, which dead centre, exponents, losses and offset follow in part only. A
    wrong rod bends it in the same way, so that one number tells of both.
    """
    alignment, prior, half = measured.alignment, line_prior(diagram), measured.tdc_uncertainty
    if alignment.own is not None:
        prior = dataclasses.replace(prior, tdc=(0.0, ENCODER if half is None else half / NORMAL_95))
    phi, mean = around_compression(measured.phi, measured.raw_mean, measured.period)
    if alignment.motored:
        _, fit = from_motored(phi, mean, cylinder, prior, "")
    else:
        _, fit = from_compression(phi, mean, cylinder, between(diagram), prior)
    asked, spread = clearance_asked(fit, phi, mean, cylinder, prior)
    less = cylinder.compression_ratio - 1
    low, high = (1 + less * math.exp(side * _BENT * math.hypot(spread, _SHEET)) for side in (-1, 1))
    why = "the line is bent as by another compression ratio, rod or stroke: one of them is wrong, or the sensor drifts"
    quantity = "compression ratio that the line asks for [-]"
    return _doubt("geometry", quantity, 1 + less * math.exp(-asked), (low, high), why)


def _combustion(diagram: Diagram, cylinder: Chamber, measured: MeasuredCycles) -> list[Doubt | None]:
    """Heat before ignition, heat against the fuel that the charge could burn, exponent behind burning."""
    # by the offset of the joint fit: one from a fixed exponent would condemn the true dead centre; no scale is needed
    line = measured.alignment.fit
    phi, p = around_compression(measured.phi, measured.raw_mean - line.offset, measured.period)
    first, last = between(diagram)
    inside = (phi >= first) & (phi <= _OPENS)
    at, p = phi[inside], p[inside]
    q = heat_release(at, p, cylinder, _GAMMA)
    heat = float(q.max())
    bottom = line.level * math.exp(float(log_pressure(cylinder, np.array([-math.pi]), line.shape)[0][0]))
    mass = bottom * cylinder.clearance * cylinder.compression_ratio / (_R * _T_CLOSED)
    early = float(np.interp(last, at, q)) / heat if heat > 0 else 0.0
    whose = "more than air in the cylinder can burn: scale, bore or compression_ratio is wrong"
    when = (
        "heat before ignition, or more lost than walls take: dead centre or offset is wrong, or it burns before fit_to"
    )
    return [
        _doubt("heat", "heat released by mass of charge [MJ/kg]", heat / mass / 1e6, (0.0, _MIXTURE_HEAT / 1e6), whose),
        _doubt("early_heat", "heat until fit_to by the heat of the cycle [-]", early, _EARLY, when),
        _expansion(at, p, q, cylinder, line),
    ]


def _expansion(phi: np.ndarray, p: np.ndarray, q: np.ndarray, cylinder: Chamber, line: JointFit) -> Doubt | None:
    behind = phi[int(np.argmax(burnt_fraction(phi, q) > _BURNT))]
    first = max(float(behind), 50 * _DEG)
    if phi[-1] - first < 25 * _DEG or not np.all(p[phi >= first] > 0):
        return None
    n = polytropic_fit(phi, p, cylinder, first, float(phi[-1]))
    why = "behind burning the gas expands with 1.2 to 1.35: dead centre, offset or scale is wrong, or the sensor drifts"
    by = NORMAL_95 * _by_sensor(line, cylinder, np.array([first, phi[-1]]), np.interp([first, phi[-1]], phi, p))
    usual = (_EXPANSION[0] - by, _EXPANSION[1] + by)
    return _doubt("expansion_exponent", "exponent of the expansion behind burning [-]", n, usual, why)


def _by_sensor(line: JointFit, cylinder: Chamber, ends: np.ndarray, p: np.ndarray) -> float:
    """Standard deviation of the exponent between two angles by what is not known of offset and drift of the sensor."""
    by_offset, by_drift = 1 / p, (ends - REFERENCE) / p
    slope = np.diff([by_offset, by_drift])[:, 0] / float(np.diff(np.log(volume(cylinder, ends)))[0])
    return line.swing * math.sqrt(float(slope @ line.covariance[6:, 6:] @ slope))


def exponent_doubts(compression: Pure, expansion: Pure | None, doubts: Sequence[Doubt]) -> list[Doubt]:
    """The exponents that are told, as far as no other check has doubted the same line.

    A gas that only loses heat to its walls compresses with less than its gamma and expands with more. Air and mixture
    have a gamma of 1.3 to 1.4 and compress with 1.3 +- 0.05 (Heywood 1988, section 9.2.2), less where fuel evaporates
    or walls are cold. Burnt gas has 1.18 to 1.3, the least hot and rich: an expansion below that of the gas takes heat
    in all along, and one near 1 as much as its work; none does but a gas that still burns. Heat and mass that are lost
    raise it, in a small engine by up to 0.2. compression, expansion: no expansion of a motored record, which expands
    with more the more it has lost; doubts: doubts of the same record so far.
    """
    why = "dead centre, offset or compression ratio is wrong"
    burning = "it still burns there, or the dead centre, the offset or the scale is wrong, or the sensor drifts"
    raised = [_doubt("compression_exponent", "exponent of the compression as told [-]", compression, _EXPONENT, why)]
    if expansion is not None:
        raised.append(
            _doubt("expansion_exponent", "exponent of the expansion as told [-]", expansion, _EXPANSION_TOLD, burning)
        )
    known = {doubt.code for doubt in doubts}
    return [doubt for doubt in raised if doubt is not None and doubt.code not in known]


def speed_doubt(read: RadPerSecond, wanted: RadPerSecond) -> Doubt | None:
    """Whether a record has the speed of its engine. read, wanted: mean speed by `time_s`, and of operation."""
    why = "another unit of time_s, other angles than those of the crank, or a record of another engine"
    return _doubt("speed", "speed by time_s / operation.speed [-]", read / wanted, _SPEED, why)


def brake_doubt(torque: NewtonMetre, p_mi: Pascal, swept: Volume, period: Radian) -> Doubt | None:
    r"""Whether a measured brake torque and the indicated work belong together.

    .. math:: \eta_m = \frac{M\,T}{p_{mi} V_d}

    torque: mean brake torque of one cylinder. p_mi: mean indicated pressure. swept: swept volume of one cylinder.
    period: T: 2 pi or 4 pi.
    """
    why = "the brake gives more than the gas, or far less: dead centre, scale or torque is wrong"
    ratio = torque * period / (p_mi * swept)
    return _doubt("mechanical_efficiency", "brake work by indicated work [-]", ratio, (0.5, 0.98), why)
