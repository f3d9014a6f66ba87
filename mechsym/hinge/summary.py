"""What `mechsym hinge` tells of a design, and its tables for files."""

import dataclasses
from collections.abc import Mapping

import numpy as np

from mechsym.hinge.limits import Contact, Verdict, at_angles
from mechsym.hinge.result import AtLoad, Design, JudgedHinge, Offer, Target
from mechsym.hinge.rollers import HingeLosses, LossTorques, parallel
from mechsym.hinge.steady import RIPPLE
from mechsym.hinge.trials import Trial
from mechsym.quantities import RPM
from mechsym.quantities.results import Columns, computed, part, quantity, result, seen

#: Numbers that need no run besides what all guides of one engine share: a hundredth of the time of all
QUICK = (
    "speed_rpm", "p_max_bar", "mep_bar", "load_torque", "hinge_torque_max", "hinge_torque_min", "hinge_torque_mean",
    "hinge_work_max", "hinge_work_min", "guide", "flywheel_inertia_saved", "flywheel_inertia_to_turn", "ripple_wanted",
)  # fmt: skip


@result
class HingeCheck:
    """The run that proves a design; all None without a guide."""

    speed_ripple: float | None = quantity("-", default=None)  #: (max - min) / mean of the speed over the last period
    energy_residual: float | None = quantity("-", default=None)  #: What the balance of energy leaves open
    tolerance_difference: float | None = quantity("-", default=None)  #: Of a speed to the run at a finer tolerance
    losses: Mapping[str, float] | None = quantity("N*m", default=None)  #: Mean torques; None of an ideal hinge


@result
class AssumedLosses(HingeLosses):
    """Friction and heat as they were taken."""

    tau: float | None = quantity(  # type: ignore[assignment]
        "s", about="time of the gas to take the wall's temperature; None without gas"
    )


@result
class HingeLossNumbers:
    """What the ideal hinge leaves out."""

    torques: LossTorques = part(inline=True)
    total: float = quantity("N*m")  #: All of them
    shares: Mapping[str, float | None] = quantity("-")  #: Each of them by the load torque
    share: float | None = quantity("-")  #: All of them by the load torque; None where there is no load
    speed_ripple: float | None = quantity("-")  #: Steady ripple with them; None where there is no steady motion
    fill: float = quantity("-")  #: Fill of the spring with which it has that ripple, by that of the design
    gas_index: float | None = quantity("-")  #: Index that the gas shows; None without gas
    assumed: AssumedLosses = part()


@result
class NotRetuned:
    """The other speed of a case that has none, or no guide."""

    speed_rpm: float | None = quantity("rpm", default=None)  #: Other speed of the case
    p0: float | None = quantity("@unit", default=None)  #: Setting of the spring with the least ripple there
    speed_ripple: float | None = quantity("-", default=None)  #: Ripple that remains
    unit: str = ""  # of the setting


@result
class RetunedNumbers:
    """The same guide at the other speed of the case."""

    speed_rpm: float = quantity("rpm")  #: Other speed of the case
    p0: float = quantity("@unit")  #: Setting of the spring with the least ripple there
    p0_ratio: float = quantity("-")  #: That setting by that of the design
    speed_ripple: float | None = quantity("-")  #: Ripple that remains
    speed_ripple_paper_factor: float | None = quantity("-")  #: Ripple with the paper's factor 1.9 on the setting
    torque_ratio_max: float = quantity("-")  #: Highest torque wanted there by that of the design
    torque_ratio_min: float = quantity("-")  #: Lowest torque wanted there by that of the design
    torque_ratio_peak: float = quantity("-")  #: Largest torque wanted there, by magnitude, by that of the design
    unit: str  # of the setting


@result
class HingeNumbers:
    """The numbers of a design, each computed when it is asked for, in SI unless its name says otherwise."""

    judged: JudgedHinge  # a Design, where more than `QUICK` is asked for

    @property
    def design(self) -> Design:
        """The design with its guide."""
        assert isinstance(self.judged, Design)
        return self.judged

    @computed("rpm")
    def speed_rpm(self) -> float:
        """Speed of operation."""
        return self.judged.machine.omega / RPM

    @computed("bar")
    def p_max_bar(self) -> float | None:
        """Largest pressure in the cylinder, absolute."""
        gas = self.judged.machine.gas
        return gas.pressure.p_max / 1e5 if gas else None

    @computed("bar")
    def mep_bar(self) -> float | None:
        """Mean indicated pressure."""
        gas = self.judged.machine.gas
        return gas.pressure.mean_indicated / 1e5 if gas else None

    load_torque: float = seen("judged.hinge.load_torque", "N*m")  #: Torque that the engine can drive in the mean
    hinge_torque_max: float = seen("judged.hinge.torque_max", "N*m")  #: Highest torque of the hinge, with its sign
    hinge_torque_min: float = seen("judged.hinge.torque_min", "N*m")  #: Lowest torque of the hinge, with its sign
    #: Mean torque of the hinge, 0 of one that a spring can give
    hinge_torque_mean: float = seen("judged.hinge.mean_torque", "N*m")
    hinge_work_max: float = seen("judged.hinge.work_max", "J")  #: Highest work of the hinge since dead centre
    hinge_work_min: float = seen("judged.hinge.work_min", "J")  #: Lowest work of the hinge since dead centre
    guide: Verdict = seen("judged.verdict")  #: The guide and its limits

    @computed()
    def check(self) -> HingeCheck:
        """The run that proves the design."""
        run = self.design.check
        if run is None:
            return HingeCheck()
        energy = run.result.energy
        return HingeCheck(
            speed_ripple=run.speed_ripple,
            energy_residual=energy.residual,
            tolerance_difference=run.result.tolerance_difference,
            losses=run.losses or None,
        )

    @computed()
    def offers(self) -> tuple[Offer, ...]:
        """The ways to balance the torque, with the ripple that each leaves; two for a four-stroke engine."""
        design = self.design
        return (Offer(taken=design.balance, track=design.guide, verdict=design.verdict), *design.instead)

    @computed()
    def runs(self) -> Mapping[str, Trial]:
        """The runs in time by name."""
        return {trial.name: trial for trial in self.design.trials}

    @computed()
    def retune(self) -> RetunedNumbers | NotRetuned:
        """The same guide at the other speed of the case."""
        again, hinge, unit = self.design.retuned, self.design.hinge, self.design.guide.spring.setting[1]
        if again is None:
            return NotRetuned(unit=unit)
        wanted = again.wanted
        peaks = [max(abs(h.torque_max), abs(h.torque_min)) for h in (wanted, hinge)]
        return RetunedNumbers(
            speed_rpm=again.other.omega / RPM,
            p0=again.setting,
            p0_ratio=again.ratio,
            speed_ripple=again.steady.speed_ripple,
            speed_ripple_paper_factor=again.paper.speed_ripple,
            torque_ratio_max=wanted.torque_max / hinge.torque_max,
            torque_ratio_min=wanted.torque_min / hinge.torque_min,
            torque_ratio_peak=peaks[0] / peaks[1],
            unit=unit,
        )

    @computed("-")
    def sensitivity(self) -> Mapping[str, tuple[float | None, ...]]:
        """Speed ripple with a number of the spring 1 per cent low and high."""
        return {s.name: (s.low.speed_ripple, s.high.speed_ripple) for s in self.design.sensitivities}

    loads: tuple[AtLoad, ...] = seen("design.loads")  #: The same guide at the loads that were asked for
    #: Inertia to add for a ripple of 1/50 without hinge, on top of the flywheel that the case keeps
    flywheel_inertia_saved: float | None = seen("judged.flywheels.steady.inertia", "kg*m^2", card="flywheel saved")

    @computed()
    def losses(self) -> HingeLossNumbers | None:
        """What the ideal hinge leaves out; None without a guide."""
        price = self.design.price
        if price is None:
            return None
        torques = price.losses
        load = abs(self.design.hinge.load_torque) or None  # no share of a load where there is none
        kinds = [field.name for field in dataclasses.fields(torques)]
        assumed = {field.name: getattr(price.assumed, field.name) for field in dataclasses.fields(price.assumed)}
        radius = price.assumed.bearing_at(self.design.rollers.radius)
        return HingeLossNumbers(
            torques=torques,
            total=torques.total,
            shares={kind: getattr(torques, kind) / load if load else None for kind in kinds},
            share=torques.total / load if load else None,
            speed_ripple=price.speed_ripple,
            fill=price.fill,
            gas_index=price.gas_index,
            assumed=AssumedLosses(**assumed | {"bearing_radius": radius, "tau": price.tau}),
        )

    @computed("-")
    def misfire_speed_share(self) -> float | None:
        """Lowest speed after one turn without combustion by the mean before; 0 for a stop, None where not known."""
        return None if self.design.price is None else self.design.price.misfire_speed_share

    #: Smallest inertia to add with which the engine completes turns without hinge
    flywheel_inertia_to_turn: float | None = seen("judged.flywheels.turns.inertia", "kg*m^2")

    @computed("kg*m^2")
    def flywheel_inertia_beside_faulty(self) -> float | None:
        """Inertia for a ripple of 1/50 beside a hinge whose setting is 2 per cent high; None without a guide."""
        return None if self.design.beside_faulty is None else self.design.beside_faulty.inertia

    @computed("-")
    def ripple_wanted(self) -> float:
        """Ripple that is asked for."""
        return RIPPLE

    target: Target = seen("design.target")  #: Whether that ripple is kept with losses
    verdict: str = seen("design.answer")  #: The answer in a sentence


def guide_turn(design: Design, points: int = 721) -> Contact:
    """The guide over a whole turn of its shaft, at so many angles, both ends included."""
    return at_angles(design.guide, design.rollers, np.linspace(0, 2 * np.pi, points))


#: Of the columns of both tables
_UNITS = {
    "phi": "rad", "pressure": "Pa", "piston_force": "N", "hinge_torque": "N*m", "inertia_part": "N*m",
    "gas_part": "N*m", "gravity_part": "N*m", "hinge_work": "J", "inertia": "kg*m^2",
    "theta": "rad", "rho": "m", "drho_dtheta": "m/rad", "profile_x": "m", "profile_y": "m", "z": "m",
    "spring_force": "N", "pressure_angle": "rad", "curvature": "1/m", "roller_reaction_1": "N",
    "roller_reaction_2": "N", "hertz_stress": "Pa", "torque": "N*m", "spring_excess_pressure": "Pa",
}  # fmt: skip


def hinge_columns(design: Design, points: int = 721) -> Columns:
    """Table of the hinge over a period of the crank, at so many angles, both ends included."""
    hinge, gas = design.hinge, design.machine.gas
    phi = np.linspace(0, hinge.period, points)
    pressed = {"pressure": gas.pressure.absolute(phi), "piston_force": gas.force(phi)} if gas else {}
    columns = {
        "phi": phi,
        **pressed,
        "hinge_torque": hinge.torque(phi),
        "inertia_part": hinge.inertia_part(phi),
        "gas_part": hinge.gas_part(phi),
        "gravity_part": hinge.gravity_part(phi),
        "hinge_work": hinge.work(phi),
        "inertia": hinge.inertia(phi),
    }
    return Columns(columns, _UNITS)


def guide_columns(design: Design, contact: Contact) -> Columns:
    """Table of the guide over a turn of its shaft: path, cut profile in the frame of the track, contact."""
    x, y = parallel(contact.rho, contact.drho, contact.theta, design.rollers.radius)
    columns = {
        "theta": contact.theta,
        "phi": contact.phi,
        "rho": contact.rho,
        "drho_dtheta": contact.drho,
        "profile_x": x,
        "profile_y": y,
        "z": contact.z,
        "spring_force": contact.force,
        "pressure_angle": contact.pressure_angle,
        "curvature": contact.curvature,
        "roller_reaction_1": contact.reaction_1,
        "roller_reaction_2": contact.reaction_2,
        "hertz_stress": contact.hertz_stress,
        "torque": contact.torque,
    }
    if contact.pressure is not None:
        columns["spring_excess_pressure"] = contact.pressure
    return Columns(columns, _UNITS)
