"""What decides the claims of source 000, and what its misprints cost in hinge torque."""

import numpy as np

from mechsym.audit.hosts.sources import Turn
from mechsym.audit.judge.question import Question, turn, value
from mechsym.audit.read.reader import read
from mechsym.audit.theory.catalogue import theory
from mechsym.audit.theory.record import known
from mechsym.audit.verdict import Decision
from mechsym.hinge.guide import Guide, crank_torque, refit, with_setting
from mechsym.hinge.springs.air import AirAbsolute
from mechsym.hinge.springs.face import Spring
from mechsym.hinge.steady import retune
from mechsym.machine.record import gas_of
from mechsym.papers.sources import Weighed, weighed
from mechsym.papers.zotov2024 import rows as computed

_TURN = np.linspace(0, 2 * np.pi, 721)


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
        f"{100 * shares[1]:.1f} % of its peak (with the cycle of the built-in cases), {100 * inertia[0]:.0f} % of its "
        "inertia part"
    )


def _inertia_peak(omega: float) -> float:
    hinge = next(h for h in computed.engines().hinges if h.omega == omega)
    return float(np.max(np.abs(hinge.inertia_part(_TURN))))


def integral_vanishes() -> Weighed:
    """The mean of M_h over a turn."""
    share = max(abs(h.mean_torque) / computed.peak(h) for h in computed.engines().hinges)
    # what is rounding only differs from machine to machine
    return weighed(share < 1e-9, share, mean="below 1e-09" if share < 1e-9 else f"{share:.2g}")


def about_twice() -> Weighed:
    """The ratio of the largest torques."""
    slow, fast = computed.engines().hinges
    ratio = computed.peak(fast) / computed.peak(slow)
    return weighed(1.5 <= ratio < 2.5, ratio / 2 - 1, ratio=ratio)


def proportional_to_square() -> Weighed:
    """The share of the torque that grows with the square of the speed."""
    slow = computed.engines().hinges[0]
    return weighed(False, share=100 * _inertia_peak(slow.omega) / computed.peak(slow))


def proportional_to_pressure() -> Weighed:
    """The torque of one guide at two pressures."""
    cut = computed.engines().cut
    real = AirAbsolute(A=cut.spring.A, H=cut.spring.H, p0=cut.spring.p0, n=cut.spring.n, pa=101325.0)  # type: ignore[attr-defined]
    error, away = (_off_at_twice(cut, spring) for spring in (cut.spring, real))
    return weighed(error < 1e-9, error, away=100 * away)


def _off_at_twice(cut: Guide, spring: Spring) -> float:
    """How far the torque of a guide is from twice at twice the pressure, by the largest [-]."""
    once, doubled = (crank_torque(refit(cut, with_setting(spring, k * computed.PRESSURES[0])), _TURN) for k in (1, 2))
    return float(np.max(np.abs(doubled - 2 * once)) / np.max(np.abs(once)))


def pressure_ratio() -> Weighed:
    """What 9.5 MPa leave of the torque needed at 142 rpm."""
    paper, best = computed.retuned(computed.PRESSURES[1]), computed.best_pressure()
    return weighed(
        paper.torque_error < 0.1,
        best.setting / computed.PRESSURES[1] - 1,
        paper=100 * paper.torque_error,
        best=best.setting / 1e6,
        ratio=best.setting / computed.PRESSURES[0],
        least=100 * best.torque_error,
    )


def almost_constant() -> Weighed:
    """The ripple of the speed with the guide of 89 rpm at 142 rpm."""
    engines = computed.engines()
    best = retune(engines.cut, engines.hinges[1], "least_ripple_propeller_load")
    ripple = best.ripple_propeller_load
    stops = computed.retuned(computed.PRESSURES[1]).ripple_propeller_load is None
    fate = "the engine stalls" if stops else "it runs"
    holds = ripple is not None and ripple < 0.02
    return weighed(holds, fate=fate, best=best.setting / 1e6, ripple=100 * (ripple or 1))


def spring_compressed() -> Weighed:
    """Whether the springs of Fig. 5 are ever longer than their free height."""
    stretches = [1e3 * computed.longest_stretch(m.guide) for m in computed.guides() if m.start == "as_printed"]
    return weighed(max(stretches) <= 0, least=min(stretches), most=max(stretches))
