"""What decides the claims of source 000, and what its misprints cost in hinge torque."""

import numpy as np

from mechsym.audit.hosts.sources import Decided, Turn
from mechsym.audit.judge.question import Question, turn, value
from mechsym.audit.read.reader import read
from mechsym.audit.theory.catalogue import theory
from mechsym.audit.theory.record import known
from mechsym.audit.verdict import Decision
from mechsym.machine.record import gas_of
from mechsym.papers.zotov2024 import rows as computed

_TURN = np.linspace(0, 2 * np.pi, 721)
_CYCLE = "with the cycle of the built-in cases"


def gas_force() -> Turn:
    """The piston force over a turn, at 89 rpm."""
    return {"F": gas_of(computed.engines().machines[0]).force}


def loads() -> Turn:
    """Piston force and load torque over a turn, at 89 rpm. Returns turn: F and M_r of the crank angle, M_h = 0."""
    engines = computed.engines()
    load = engines.hinges[0].load_torque
    return {"F": gas_of(engines.machines[0]).force, "M_r": lambda phi: np.full_like(phi, load), "M_h": np.zeros_like}


def hinge_torque_effect(verdict: Decision) -> str:
    """What the sign in (2) costs in the peak of the hinge torque at 89 and at 142 rpm."""
    statement = (
        "phid**2*r**2*m2*(2*(cos(phi) - lam*l1/l*cos(2*phi))*(sin(phi) - lam*l1/(2*l)*sin(2*phi))"
        " - 2*(cos(phi) + lam*l1/l*cos(2*phi))*(sin(phi) + lam*l1/(2*l)*sin(2*phi)))/2"
    )
    engine = theory("crosshead")
    question = Question(formula=read(statement, known(engine)), theory=engine, quantity="hinge_torque", turn=loads())
    difference = float(np.max(np.abs(value(turn(question), question.formula.tree))))
    slow, fast = computed.engines().hinges
    shares = [difference * (h.omega / slow.omega) ** 2 / computed.peak(h) for h in (slow, fast)]
    inertia = [difference * (h.omega / slow.omega) ** 2 / _inertia_peak(h.omega) for h in (slow, fast)]
    return (
        f"the sign changes M_h by up to {difference / 1e3:.2f} kN m at 89 rpm and "
        f"{difference * (fast.omega / slow.omega) ** 2 / 1e3:.2f} kN m at 142 rpm: {100 * shares[0]:.1f} % and "
        f"{100 * shares[1]:.1f} % of its peak ({_CYCLE}), {100 * inertia[0]:.0f} % of its inertia part"
    )


def _inertia_peak(omega: float) -> float:
    hinge = next(h for h in computed.engines().hinges if h.omega == omega)
    return float(np.max(np.abs(hinge.inertia_part(_TURN))))


def integral_vanishes() -> Decided:
    """The mean of M_h over a turn."""
    shares = [abs(h.mean_torque) / computed.peak(h) for h in computed.engines().hinges]
    return Decided(
        supported=max(shares) < 1e-9,
        note=f"the mean of M_h is {_small(max(shares), 1e-9)} of its peak; (5) makes it so for every F",
        rel_error=max(shares),
    )


def _small(value: float, limit: float) -> str:
    # what is rounding only differs from machine to machine
    return f"below {limit:.0e}" if value < limit else f"{value:.2g}"


def about_twice() -> Decided:
    """The ratio of the largest torques."""
    slow, fast = computed.engines().hinges
    ratio = computed.peak(fast) / computed.peak(slow)
    return Decided(
        supported=1.5 <= ratio < 2.5,
        note=f"{ratio:.2f} times {_CYCLE}; the paper's F is not printed",
        rel_error=ratio / 2 - 1,
    )


def proportional_to_square() -> Decided:
    """The share of the torque that grows with the square of the speed."""
    slow = computed.engines().hinges[0]
    share = _inertia_peak(slow.omega) / computed.peak(slow)
    return Decided(
        supported=False,
        note=f"only the inertia part of (8) has phid^2, and its peak is {100 * share:.0f} % of that of M_h at 89 rpm "
        f"({_CYCLE}); the rest follows the gas force",
    )


def proportional_to_pressure() -> Decided:
    """The torque of one guide at two pressures."""
    from mechsym.hinge.guide import crank_torque, refit, with_setting
    from mechsym.hinge.springs.air import AirAbsolute

    cut = computed.engines().cut
    doubled = crank_torque(refit(cut, with_setting(cut.spring, 2 * computed.PRESSURES[0])), _TURN)
    once = crank_torque(cut, _TURN)
    error = float(np.max(np.abs(doubled - 2 * once)) / np.max(np.abs(once)))
    real = AirAbsolute(A=cut.spring.A, H=cut.spring.H, p0=cut.spring.p0, n=cut.spring.n, pa=101325.0)  # type: ignore[attr-defined]
    first, second = (crank_torque(refit(cut, with_setting(real, p)), _TURN) for p in (real.p0, 2 * real.p0))
    away = float(np.max(np.abs(second - 2 * first)) / np.max(np.abs(first)))
    return Decided(
        supported=error < 1e-9,
        note="exact for the printed law (9); a spring that obeys the absolute pressure is "
        f"{100 * away:.1f} % off at 2 p0",
        rel_error=error,
    )


def pressure_ratio() -> Decided:
    """What 9.5 MPa leave of the torque needed at 142 rpm."""
    paper, best = computed.retuned(computed.PRESSURES[1]), computed.best_pressure()
    return Decided(
        supported=paper.torque_error < 0.1,
        note=f"{100 * paper.torque_error:.0f} % of the rms of M_h are missing at 9.5 MPa {_CYCLE}; the best is "
        f"{best.setting / 1e6:.1f} MPa, {best.setting / computed.PRESSURES[0]:.2f} times, with "
        f"{100 * best.torque_error:.0f} % missing. The paper's F is not printed",
        rel_error=best.setting / computed.PRESSURES[1] - 1,
    )


def almost_constant() -> Decided:
    """The ripple of the speed with the guide of 89 rpm at 142 rpm."""
    from mechsym.hinge.steady import retune

    paper = computed.retuned(computed.PRESSURES[1])
    engines = computed.engines()
    best = retune(engines.cut, engines.hinges[1], "least_ripple_propeller_load")
    ripple = best.ripple_propeller_load
    stops = paper.ripple_propeller_load is None
    return Decided(
        supported=ripple is not None and ripple < 0.02,
        note=f"{'the engine stalls at 9.5 MPa' if stops else 'it runs at 9.5 MPa'} {_CYCLE}; the best pressure, "
        f"{best.setting / 1e6:.1f} MPa, leaves {100 * (ripple or 1):.0f} % ripple under a propeller load, for "
        "there is no flywheel",
    )


def spring_compressed() -> Decided:
    """Whether the springs of Fig. 5 are ever longer than their free height."""
    stretches = [computed.longest_stretch(m.guide) for m in computed.guides() if m.start == "as_printed"]
    return Decided(
        supported=max(stretches) <= 0,
        note=f"W is positive somewhere, so the spring is {1e3 * min(stretches):.1f} to {1e3 * max(stretches):.1f} mm "
        f"longer than H there in all twelve guides ({_CYCLE}); the constant of W is free and can be chosen to avoid it",
    )
