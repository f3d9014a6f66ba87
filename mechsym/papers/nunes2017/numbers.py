"""Published numbers of the thesis that lie on curves over the speed, as data: text as printed, and where it lies."""

from collections.abc import Mapping
from typing import Any, NamedTuple

from mechsym.papers.nunes2017 import SOURCE
from mechsym.papers.rows import NOT_REPRODUCED, REPRODUCED, SLIP, last_digit


class Item(NamedTuple):
    """One published number.

    `at` is a speed in rpm, or max, min (value) or max_rpm, min_rpm (speed); `slip` is the source's slip that the
    computation follows, `meant` what a misprinted number should say, `about` the relative tolerance where the text
    itself says "about".
    """

    item: str
    published: str
    engine: str
    quantity: str
    at: float | str
    slip: str = ""
    meant: str = ""
    about: float = 0.0


def verdict(item: Item, computed: float) -> tuple[str, str]:
    """Verdict on one number by its printed digits.

    Parameters
    ----------
    item : Item
        The number as printed, and the source's slip if there is one
    computed : float
        The number as computed in the unit of the print [-]

    Returns
    -------
    verdict : str
        `reproduced`, `reproduced with the source's slip` or `not reproduced`
    note : str
        The slip, or how far off; empty when rounding gives the print
    """
    target = item.meant or item.published
    wanted, unit = float(target), max(last_digit(target), 2 * item.about * abs(float(target)))
    off = abs(computed - wanted) / unit
    # 0.55 for 0.5: T(5400) = 245.03252 is printed 245.032
    rounded = off <= 0.55
    truncated = not item.about and 0 <= abs(computed) - abs(wanted) < unit
    if not (rounded or truncated):
        return NOT_REPRODUCED, "; ".join(filter(None, [item.slip, f"{off:.2f} of the last digit off"]))
    edge = f"{off:.2f} of the last digit off" if 0.5 < off <= 0.55 else ""
    notes = [item.slip, "" if rounded else "truncated in print", edge, "the text says about" if item.about else ""]
    return SLIP if item.slip else REPRODUCED, "; ".join(filter(None, notes))


def item_row(item: Item, values: Mapping[str, float | None]) -> dict[str, Any]:
    """A row for one number.

    Parameters
    ----------
    values : mapping of str to float
        What the `printed`, the `converged` and the `corrected` model give, in the unit of the print [-]

    Returns
    -------
    row : dict
        Keys source, item, published, computed, rel_error, verdict, note, converged, corrected
    """
    computed, published = values["printed"], float(item.published)
    assert computed is not None
    judged, note = verdict(item, computed)
    return {
        "source": SOURCE.stem,
        "item": item.item,
        "published": item.published,
        "computed": computed,
        "rel_error": computed / published - 1 if published else None,
        "verdict": judged,
        "note": note,
        "converged": values.get("converged"),
        "corrected": values.get("corrected"),
    }


_SC, _SC74, _HY = "slider_crank", "slider_crank_74", "hypocycloid"
_ROD = "computed with a rod of 74 mm; table 3.2 says 90 mm"
_WORK_COPIED = "the hypocycloid's value, copied"


def _series(item: str, engine: str, quantity: str, texts: str, at: tuple[float, ...], slip: str = "") -> list[Item]:
    return [
        Item(f"{item} at {speed:g} rpm", text, engine, quantity, speed, slip)
        for text, speed in zip(texts.split(), at, strict=True)
    ]


OVER_SPEEDS: list[Item] = [
    # section 3.4.2, opposed-piston slider crank
    Item("OPSCE largest peak pressure [MPa]", "9.188", _SC, "p_max_mpa", "max"),
    Item("OPSCE speed of the largest peak pressure [rpm]", "370", _SC, "p_max_mpa", "max_rpm"),
    *_series("OPSCE peak pressure [MPa]", _SC, "p_max_mpa", "8.707 6.690", (2000, 8000)),
    Item("OPSCE largest force on the piston [N]", "25967", _SC, "force_max", "max"),
    Item("OPSCE speed of the largest force [rpm]", "360", _SC, "force_max", "max_rpm"),
    *_series("OPSCE largest force [N]", _SC, "force_max", "24273 13690", (2000, 8000)),
    Item("OPSCE largest instantaneous torque [N*m]", "276.255", _SC, "torque_max", "max"),
    Item("OPSCE speed of the largest instantaneous torque [rpm]", "1550", _SC, "torque_max", "max_rpm"),
    *_series("OPSCE instantaneous torque [N*m]", _SC, "torque_max", "275.731 245.032 195.075", (2000, 5400, 8000)),
    Item("OPSCE average torque at 1550 rpm [N*m]", "35.904", _SC, "torque_avg", 1570, "belongs to 1570 rpm"),
    *_series("OPSCE average torque [N*m]", _SC, "torque_avg", "36.284 36.908", (2000, 8000)),
    Item("OPSCE largest average torque [N*m]", "37.138", _SC, "torque_avg", "max"),
    Item("OPSCE speed of the largest average torque [rpm]", "5400", _SC, "torque_avg", "max_rpm"),
    # section 3.4.3, opposed-piston geared hypocycloid
    Item("OPGHE largest peak pressure [MPa]", "9.604", _HY, "p_max_mpa", "max"),
    Item("OPGHE speed of the largest peak pressure [rpm]", "450", _HY, "p_max_mpa", "max_rpm"),
    *_series("OPGHE peak pressure [MPa]", _HY, "p_max_mpa", "9.196 7.263", (2000, 8000)),
    Item("OPGHE largest force on the piston [N]", "27140", _HY, "force_max", "max"),
    Item("OPGHE speed of the largest force [rpm]", "440", _HY, "force_max", "max_rpm"),
    *_series("OPGHE largest force [N]", _HY, "force_max", "25730 16337", (2000, 8000)),
    Item("OPGHE largest instantaneous torque [N*m]", "243.6", _HY, "torque_max", "max"),
    Item("OPGHE speed of the largest instantaneous torque [rpm]", "2560", _HY, "torque_max", "max_rpm",
         "2560 printed for 2360, the speed of the tooth load", "2360"),
    Item("OPGHE average torque at 2560 rpm [N*m]", "36.2", _HY, "torque_avg", 2560),
    *_series("OPGHE instantaneous torque [N*m]", _HY, "torque_max", "243.5 212.0 193.2", (2000, 6700, 8000)),
    *_series("OPGHE average torque [N*m]", _HY, "torque_avg", "35.9 37.0", (2000, 8000)),
    Item("OPGHE largest average torque [N*m]", "37.1", _HY, "torque_avg", "max"),
    Item("OPGHE speed of the largest average torque [rpm]", "6700", _HY, "torque_avg", "max_rpm"),
    Item("OPGHE largest tooth load [N]", "9368.4", _HY, "tooth_force", "max"),
    Item("OPGHE speed of the largest tooth load [rpm]", "2360", _HY, "tooth_force", "max_rpm"),
    *_series("OPGHE tooth load [N]", _HY, "tooth_force", "9365.2 7432.2", (2000, 8000)),
    # section 5.1.1
    Item("OPSCE, ch. 5: average torque at 10 rpm, about [N*m]", "15", _SC74, "torque_avg", 10, _ROD, about=0.1),
    *_series("OPSCE, ch. 5: average torque [N*m]", _SC74, "torque_avg", "33.4 36.9", (500, 8000), _ROD),
    Item("OPSCE, ch. 5: power [kW]", "30.9", _SC74, "power_kw", "max", _ROD),
    Item("OPSCE, ch. 5: power [hp]", "41.4", _SC74, "power_hp", "max", _ROD),
    Item("OPSCE, ch. 5: consumption at 10 rpm, about [g/kWh]", "475", _SC74, "sfc_g_kwh", 10, _ROD, about=0.1),
    *_series("OPSCE, ch. 5: consumption [g/kWh]", _SC74, "sfc_g_kwh", "218.5 184.5 185.8", (250, 5400, 8000), _ROD),
    Item("OPSCE, ch. 5: mep at the lowest speed, about [kPa]", "600", _SC74, "mep_kpa", 10, _ROD,
         about=0.1),
    *_series("OPSCE, ch. 5: mep [kPa]", _SC74, "mep_kpa", "1428.8 1586.8 1575.3", (500, 5400, 8000), _ROD),
    *_series("OPSCE, ch. 5: heat share", _SC, "heat", ".278 .192 .158 .142 .130", (500, 2000, 4000, 6000, 8000)),
    *_series("OPSCE, ch. 5: work share", _SC, "work", ".403 .447 .449", (500, 4000, 6000)),
    Item("OPSCE, ch. 5: work share at 2000 rpm", ".434", _SC, "work", 2000, _WORK_COPIED, ".439"),
    Item("OPSCE, ch. 5: largest work share", ".449", _SC, "work", "max"),
    *_series("OPSCE, ch. 5: exhaust share", _SC, "exhaust", ".176 .228 .252 .268 .281", (500, 2000, 4000, 6000, 8000)),
    Item("OPSCE, ch. 5: largest unburnt share", ".144", _SC, "unburnt", "max"),
    Item("OPSCE, ch. 5: speed of the largest unburnt share [rpm]", "170", _SC, "unburnt", "max_rpm"),
    Item("OPSCE, ch. 5: smallest unburnt share", ".141", _SC, "unburnt", "min"),
    Item("OPSCE, ch. 5: speed of the smallest unburnt share [rpm]", "7570", _SC, "unburnt", "min_rpm"),
    *_series("OPSCE, ch. 5: efficiency [%]", _SC74, "efficiency_percent", "40.4 44.9 44.5", (500, 5400, 8000), _ROD),
    # section 5.1.2
    Item("OPGHE, ch. 5: average torque at the lowest speed, about [N*m]", "12.5", _HY, "torque_avg", 10, about=0.1),
    *_series("OPGHE, ch. 5: average torque [N*m]", _HY, "torque_avg", "32.6", (500,)),
    Item("OPGHE, ch. 5: power [kW]", "31.0", _HY, "power_kw", "max"),
    Item("OPGHE, ch. 5: power [hp]", "41.6", _HY, "power_hp", "max"),
    Item("OPGHE, ch. 5: consumption at 10 rpm, about [g/kWh]", "525", _HY, "sfc_g_kwh", 10, about=0.1),
    *_series("OPGHE, ch. 5: consumption [g/kWh]", _HY, "sfc_g_kwh", "226.6 184.7 185.2", (250, 6700, 8000)),
    Item("OPGHE, ch. 5: mep at the lowest speed, about [kPa]", "550", _HY, "mep_kpa", 10, about=0.1),
    *_series("OPGHE, ch. 5: mep [kPa]", _HY, "mep_kpa", "1390.3 1585.3 1581.0", (500, 6700, 8000)),
    *_series("OPGHE, ch. 5: heat share", _HY, "heat", ".292 .202 .166 .148 .135", (500, 2000, 4000, 6000, 8000)),
    *_series("OPGHE, ch. 5: work share", _HY, "work", ".394 .434 .444 .448", (500, 2000, 4000, 6000)),
    Item("OPGHE, ch. 5: largest work share", ".449", _HY, "work", "max"),
    *_series("OPGHE, ch. 5: exhaust share", _HY, "exhaust", ".172 .224 .247 .263 .274", (500, 2000, 4000, 6000, 8000)),
    *_series("OPGHE, ch. 5: efficiency [%]", _HY, "efficiency_percent", "39.31 44.82 44.70", (500, 6700, 8000)),
    Item("OPGHE, ch. 5: power to weight [kW/kg]", "2.313", _HY, "power_to_weight", "max"),
]  # fmt: skip

# section 5.2: where the torque curves cross, and figures there
CROSSOVER: list[Item] = [
    Item("crossover speed [rpm]", "6436", _SC74, "speed_rpm", "crossover", _ROD),
    Item("average torque at the crossover [N*m]", "37.1", _SC74, "torque_avg", "crossover", _ROD),
    Item("power at the crossover [kW]", "25.0", _SC74, "power_kw", "crossover", _ROD),
    Item("consumption at the crossover [g/kWh]", "184.8", _SC74, "sfc_g_kwh", "crossover", _ROD),
    Item("mean effective pressure at the crossover [kPa]", "1583.9", _SC74, "mep_kpa", "crossover", _ROD),
    Item("thermal efficiency at the crossover [%]", "44.78", _SC74, "efficiency_percent", "crossover", _ROD),
    Item("speed of equal work (fig. 5.18) [rpm]", "6500", _SC, "speed_rpm", "crossover", about=0.005),
]

# section 5.2, fig. 5.18: magnitude of (hypocycloid/slider crank - 1) in percent, rod of 90 mm
DIFFERENCES: list[Item] = [
    Item("difference in heat at the lowest speed [%]", "2.03", _SC, "heat", 10, "2.03 printed for 2.74", "2.74"),
    Item("largest difference in heat [%]", "4.79", _SC, "heat", "max"),
    Item("speed of the largest difference in heat [rpm]", "1040", _SC, "heat", "max_rpm"),
    Item("difference in heat at 8000 rpm [%]", "4.04", _SC, "heat", 8000),
    Item("difference in work at the lowest speed [%]", "8.61", _SC, "work", 10),
    Item("difference in work at 8000 rpm [%]", "2.9", _SC, "work", 8000, "2.9 printed for 0.29", "0.29"),
    Item("difference in exhaust at the lowest speed [%]", "8.78", _SC, "exhaust", 10),
    Item("smallest difference in exhaust [%]", "1.84", _SC, "exhaust", "min"),
    Item("speed of the smallest difference in exhaust [rpm]", "2730", _SC, "exhaust", "min_rpm"),
    Item("difference in exhaust at 8000 rpm [%]", "2.33", _SC, "exhaust", 8000),
]
