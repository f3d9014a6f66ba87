"""The kinds of Stirling cycle: the turn of the engine, the gas that its two pistons share, its figures."""

import math
from collections.abc import Mapping
from functools import cached_property
from pathlib import Path

import casadi as ca
import numpy as np

from mechsym.cycle.chamber import Chamber, motion_over, piston_area
from mechsym.cycle.gas import Gas
from mechsym.cycle.kinds.stirling_second_order import SecondOrder, second_order
from mechsym.cycle.kinds.stirling_spaces import (
    FiveSpaces,
    StirlingCylinders,
    Volumes,
    areas,
    evaluated,
    exchanger_capacity,
    five_spaces,
    swept,
)
from mechsym.cycle.kinds.stirling_turn import StirlingTurn, turn
from mechsym.cycle.plots import stirling_picture
from mechsym.cycle.pressure import Pressure, periodic
from mechsym.cycle.source import EngineParts, FiguresPage, Progress, unseen
from mechsym.files import Json
from mechsym.periodic.pieces import PPoly
from mechsym.quantities import RPM, record
from mechsym.quantities.display import residual_text

_POINTS = 1440


@record
class Schmidt(StirlingCylinders):
    """Section `[cycle]`, `kind = "schmidt"`."""


def schmidt_turn(spaces: FiveSpaces) -> StirlingTurn:
    r"""A turn of the isothermal cycle of Schmidt (1871): the gas keeps the temperature of each space.

        [expansion space V_e, T_e]--[regenerator V_r, T_r]--[compression space V_c, T_c]     one pressure everywhere

    .. math:: p(\varphi) = \frac{C}{V_e/T_e + V_r/T_r + V_c/T_c}, \qquad T_r = \frac{T_e - T_c}{\ln(T_e/T_c)}

    C follows from the wanted mean pressure over a turn; the heats are the works of the two spaces. Losses of real
    machines are left out: the work is an upper bound.
    """
    phi = np.arange(_POINTS + 1) * 2 * math.pi / _POINTS
    volume, slope = evaluated(spaces.volumes, phi)
    T, capacity = (float(spaces.T_h), float(spaces.T_k)), float(exchanger_capacity(spaces))
    inverse = 1 / (volume[0] / T[0] + volume[1] / T[1] + capacity)
    scale = float(spaces.mean_pressure) / inverse[:-1].mean()  # a smooth periodic mean: exact to round-off
    p = scale * inverse
    dp = -p * inverse * (slope[0] / T[0] + slope[1] / T[1])
    flows = [(dp * v + p * s) / (spaces.R * t) for v, s, t in zip(volume, slope, T, strict=True)]
    works = [float((p * s)[:-1].mean() * 2 * math.pi) for s in slope]
    heats = {"Q_h": works[0], "Q_r": 0.0, "Q_k": works[1], "Q_e": 0.0, "Q_c": 0.0}
    return StirlingTurn(
        phi=phi, p=p, dp_dphi=dp, V_e=volume[0], V_c=volume[1], T_e=np.full_like(phi, T[0]),
        T_c=np.full_like(phi, T[1]), flow_e=flows[0], flow_c=flows[1], stored=_stored(spaces, flows, dp, phi),
        mass=float(scale / spaces.R), cuts=np.empty(0), closure=0.0,
        sums=heats | {"W_e": works[0], "W_c": works[1], "p_mean": float(spaces.mean_pressure)},
    )  # fmt: skip


def _stored(spaces: FiveSpaces, flows: list[np.ndarray], dp: np.ndarray, phi: np.ndarray) -> np.ndarray:
    # heat from the matrix: its own gas changes pressure, and what passes is warmed from the cold to the hot side
    cp = spaces.gamma * spaces.R / (spaces.gamma - 1)
    hot = flows[0] + spaces.V_h * dp / (spaces.R * spaces.T_h)
    cold = flows[1] + spaces.V_k * dp / (spaces.R * spaces.T_k)
    rate = spaces.V_r * dp / (spaces.gamma - 1) + cp * (spaces.T_h * hot + spaces.T_k * cold)
    return np.concatenate([[0.0], np.cumsum((rate[1:] + rate[:-1]) / 2 * np.diff(phi))])


_STEPS = 64  # between two cuts, for a pressure that is read at any angle


@record
class StirlingAdiabatic(StirlingCylinders):
    """Section `[cycle]`, `kind = "stirling-adiabatic"`."""


@record
class StirlingSecondOrder(StirlingCylinders):
    """Section `[cycle]`, `kind = "stirling-second-order"`; `[stirling]` has the exchangers and the seal."""


@record
class StirlingEngine:
    """A Stirling engine over one turn."""

    turn: StirlingTurn
    losses: SecondOrder | None = None  #: What it loses at its speed, where the kind knows it


def _columns(engine: StirlingEngine, omega: float) -> Json:
    """Figures of one turn under the names of `mechsym cycle`; `losses` is a mapping [W]."""
    whole, per_second = engine.turn, omega / (2 * math.pi)
    second = engine.losses
    power = whole.work * per_second if second is None else second.power
    heat_in = whole.heat_in * per_second if second is None else second.heat_in
    figures = {
        "torque_avg": power / omega, "power_kw": power / 1e3, "mep_kpa": whole.mean_indicated / 1e3,
        "sfc_g_kwh": math.nan, "efficiency": _share(power, heat_in), "p_max_mpa": float(whole.p.max()) / 1e6,
        "p_max_angle_deg": math.degrees(math.remainder(float(whole.phi[np.argmax(whole.p)]), 2 * math.pi)),
        "energy_residual": whole.residual, "work_j": whole.work, "work_hot_j": whole.sums["W_e"],
        "work_cold_j": whole.sums["W_c"], "heat_in_j": whole.heat_in,
        "heat_out_j": -whole.sums["Q_k"] - whole.sums["Q_c"],
        "heat_regenerator_j": float(np.ptp(whole.stored)),
        "indicated_efficiency": _share(whole.work, whole.heat_in), "heat_in_kw": heat_in / 1e3, "gas_kg": whole.mass,
    }  # fmt: skip
    temperatures = {
        f"T_{side}_{name}_k": float(getattr(curve, name)())
        for side, curve in (("e", whole.T_e), ("c", whole.T_c))
        for name in ("min", "max")
    }
    if second is not None:
        temperatures |= {"T_h_k": second.T_h, "T_k_k": second.T_k, "regenerator_effectiveness": second.effectiveness}
        flow = sum(lost for name, lost in second.work_losses.items() if name.startswith("flow_"))
        figures |= {"flow_share": _share(flow, whole.work * per_second), "screen_reynolds": second.screen_reynolds,
                    "seal_reynolds": second.seal_reynolds}  # fmt: skip
    losses = {} if second is None else second.work_losses | {f"{k}_heat": v for k, v in second.heat_losses.items()}
    return figures | temperatures | {"losses": losses}


def _share(part: float, whole: float) -> float:
    """nan where there is nothing to take a share of: a machine that is driven takes no heat from its hot side."""
    return part / whole if whole > 0 else math.nan


def _closing(figures: Json) -> str:
    worst = float(abs(figures["energy_residual"]).max())
    return f"first law closed to {residual_text(worst, 1)} of the heat from the hot side"


class StirlingGas:
    """The gas that two pistons share, hot one or displacer first; a kind says `_engine`, and what it assumes."""

    kind, fact = "", ""
    page = FiguresPage(
        tables=(
            ("", ("speed_rpm", "torque_avg", "torque_max", "power_kw", "efficiency", "p_max_mpa")),
            ("a turn", ("work_j", "work_hot_j", "work_cold_j", "heat_in_j", "heat_out_j", "heat_regenerator_j",
                        "indicated_efficiency")),
        ),
        closing=_closing,
        words={"torque_avg": "mean torque", "power_kw": "power", "efficiency": "efficiency"},
    )  # fmt: skip

    def __init__(self, cycle: StirlingCylinders, parts: EngineParts) -> None:
        self.cycle, self.parts = cycle, parts
        self._engines: dict[float, StirlingEngine] = {}

    def _engine(self, volumes: Volumes, omega: float) -> StirlingEngine:
        raise NotImplementedError

    def engine(self, omega: float) -> StirlingEngine:
        """The engine over one turn at a shaft speed [rad/s]."""
        if omega not in self._engines:
            first, second = (lambda phi, f=f: f(phi)[0] for f in self._pair)
            self._engines[omega] = self._engine(swept(self.cycle, (first, second)), omega)
        return self._engines[omega]

    def at(self, omega: float) -> Gas:
        """The gas at a shaft speed [rad/s]; its chamber is the hot one."""
        cycle, phi, area = self.cycle, ca.SX.sym("phi"), piston_area(self.cycle.bore)
        hot = ca.Function("hot", [phi], self._pair[0].call([phi])[:2], ["phi"], ["x", "dx_dphi"])
        stroke = float(np.ptp(np.asarray(hot(np.linspace(0, 2 * math.pi, 721)[None, :])[0])))
        room = Chamber(
            motion=motion_over(hot), pistons=1, bore=cycle.bore, area=area, stroke=stroke, clearance=cycle.dead_hot,
            displacement=area * stroke, back_pressure=cycle.p_back,
            compression_ratio=1 + area * stroke / cycle.dead_hot if cycle.dead_hot else math.inf,
        )  # fmt: skip
        pistons = tuple(areas(cycle).sum(axis=0).tolist())
        return Gas(pressure=self._pressure(omega), chamber=room, pistons=pistons)

    def figures(self, omega: np.ndarray, progress: Progress = unseen) -> Json:
        """Figures of the engine over shaft speeds [rad/s], without fuel; what is lost stands under `losses`."""
        rows = [_columns(self.engine(speed), speed) for speed in map(float, omega)]
        columns = {key: np.array([row[key] for row in rows]) for key in rows[0] if key != "losses"}
        shares = {"heat": 1 - columns["efficiency"], "work": columns["efficiency"]}
        none = dict.fromkeys(("exhaust", "unburnt"), np.full(len(rows), np.nan))
        losses = {name: np.array([row["losses"][name] for row in rows]) for name in rows[0]["losses"]}
        return {"speed_rpm": omega / RPM} | columns | {"fractions": shares | none, "loads": {}, "losses": losses}

    def curves(self, omega: np.ndarray, operating: float) -> dict[str, np.ndarray]:
        """One turn at the first of the speeds [rad/s], from the first dead centre on."""
        speed = float(omega[0])
        whole = self.engine(speed).turn
        order = np.argsort(np.remainder(whole.phi, 2 * np.pi), kind="stable")
        curves = {
            "phi_deg": np.degrees(np.remainder(whole.phi, 2 * np.pi)), "p_pa": whole.p, "v_e_m3": whole.V_e,
            "v_c_m3": whole.V_c, "t_e_k": whole.T_e, "t_c_k": whole.T_c, "flow_e_kg_s": whole.flow_e * speed,
            "flow_c_kg_s": whole.flow_c * speed,
        }  # fmt: skip
        return {name: values[order] for name, values in curves.items()}

    def picture(self, path: Path, curves: Mapping[str, np.ndarray]) -> Path:
        """Draw the turn."""
        return stirling_picture(path, curves)

    @property
    def bound(self) -> float | None:
        r"""Efficiency of Carnot [-].

        .. math:: \eta = 1 - T_c/T_e
        """
        return 1 - self.cycle.T_c / self.cycle.T_e if self.cycle.T_e > self.cycle.T_c else None

    @cached_property
    def _pair(self) -> tuple[ca.Function, ca.Function]:
        return self.parts.pair

    def _pressure(self, omega: float) -> Pressure:
        """Pressure over the shaft angle, by cubics with the exact slopes."""
        whole = self.engine(omega).turn
        once = np.append(True, np.diff(whole.phi) > 0)  # a cut stands twice among the nodes
        curve = PPoly.hermite(whole.phi[once], whole.p[once], whole.dp_dphi[once])
        best = int(np.argmax(whole.p))
        return Pressure(
            kind=self.kind,
            period=2 * math.pi,
            kinks=tuple(sorted(whole.cuts.tolist())),
            absolute=periodic(curve, 2 * math.pi, float(whole.phi[0])),
            p_max=float(whole.p[best]),
            phi_p_max=float(math.remainder(whole.phi[best], 2 * math.pi)),
            mean_indicated=whole.mean_indicated,
            facts=(self.fact,),
        )


class SchmidtGas(StirlingGas):
    """Gas that keeps the temperature of each space."""

    kind = "schmidt"
    fact = "the gas is isothermal in each space (Schmidt); losses are left out, the work is an upper bound"

    def _engine(self, volumes: Volumes, omega: float) -> StirlingEngine:
        return StirlingEngine(turn=schmidt_turn(five_spaces(self.cycle, volumes)))


class AdiabaticGas(StirlingGas):
    """Gas with adiabatic working spaces."""

    kind = "stirling-adiabatic"
    fact = "the working spaces are adiabatic, the exchangers ideal: losses are left out"

    def _engine(self, volumes: Volumes, omega: float) -> StirlingEngine:
        return StirlingEngine(turn=turn(five_spaces(self.cycle, volumes), _STEPS))


class SecondOrderGas(StirlingGas):
    """Gas at the temperatures that the films leave, with what is lost at its speed."""

    kind = "stirling-second-order"
    fact = (
        "adiabatic working spaces at the gas temperatures that the films leave at this speed; the losses are no part "
        "of the pressure"
    )

    def _engine(self, volumes: Volumes, omega: float) -> StirlingEngine:
        order = second_order(self.cycle, self.parts.section("stirling"), volumes, omega)
        return StirlingEngine(turn=order.turn, losses=order)
