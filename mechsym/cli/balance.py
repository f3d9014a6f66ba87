"""`mechsym balance`: counterweights and balancer shafts, forces and couples before and after."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import click

from mechsym.cli.common import case_of, emit, json_option, out_option, pairs, set_option, table
from mechsym.errors import BadInput
from mechsym.files import Json
from mechsym.quantities.display import figure, quantity_text

if TYPE_CHECKING:
    from mechsym.jobs.balance import BalanceOfEngine, WeightNumbers


_SEEN = 1e-6  # of the largest order: a lower one is not listed


@click.command(short_help="Counterweights and balancer shafts.")
@click.argument("case")
@click.option(
    "--weights", type=click.Choice(["ends", "webs", "none"]), default="ends", show_default=True,
    help="Counterweights at the first and last throw, at every throw, or none besides those of the case.",
)  # fmt: skip
@click.option("--shafts", metavar="ORDERS", default="", help="Balancer shafts, a pair for each order, e.g. 1,2.")
@click.option(
    "--least", type=click.Choice(["frame", "mains"]), default="frame", show_default=True,
    help="Of the counterweights that shake the frame least, those with the least peak of a main bearing: mains.",
)  # fmt: skip
@click.option("--largest", metavar="UNBALANCE", help='Largest mass times radius of one weight, e.g. "0.02 kg*m".')
@click.option(
    "--apart", metavar="LENGTH", default="0 m", show_default=True,
    help="Distance of both shafts of a pair along the cylinders: they take roll too.",
)  # fmt: skip
@json_option
@out_option
@set_option
def balance(
    case: str,
    weights: str,
    shafts: str,
    least: str,
    largest: str | None,
    apart: str,
    as_json: bool,
    out: Path | None,
    overrides: tuple[str, ...],
) -> None:
    """What shakes the frame of CASE, and the weights that leave the least of it at its speed of operation.

    Weights come on top of what the case has.

    \b
    Examples: mechsym balance opposed-pistons --shafts 1
              mechsym balance zotov-89 --weights none --shafts 1,2 --out balance
    """
    from mechsym.jobs.balance import balance as run
    from mechsym.jobs.balance import numbers, write
    from mechsym.mechanisms import listing
    from mechsym.quantities import parse

    most = None if largest is None else parse(largest, "kg*m", "--largest")
    if most is not None and most <= 0:
        raise BadInput(f"--largest = {largest}: give more than 0 kg*m, or leave it away")
    loaded = case_of(case, pairs(overrides))
    one = run(loaded, weights, _orders(shafts), least, most, parse(apart, "m", "--apart"))
    told = numbers(loaded, one)
    files = write(one, told, out, loaded.about or listing(loaded.mechanism)["about"]) if out else []
    emit(told, as_json, lambda: _text(told), files=files)


def _orders(text: str) -> tuple[int, ...]:
    orders = [one.strip() for one in text.split(",") if one.strip()]
    if any(one not in ("1", "2", "3", "4") for one in orders):
        raise BadInput(f"--shafts = {text}: balancer shafts turn 1 to 4 times as fast as the crank; write 1,2")
    return tuple(dict.fromkeys(map(int, orders)))


def _text(told: "BalanceOfEngine") -> str:
    before, after = told.before, told.after
    rows = [
        row
        for kind, unit in (("force", "N"), ("couple", "N*m"), ("roll", "N*m"))
        for row in _rows(kind, unit, getattr(before, kind), getattr(after, kind))
    ]
    lines = [f"{told.case}: balance at {told.speed_rpm:.6g} rpm", _left(told), ""]
    if rows:
        lines += [table(rows, ["on the frame", "order", "before", "after"]), ""]
    lines += [_weight("counterweight", one) for one in told.counterweights]
    lines += [_weight("balancer shaft", one) for one in told.shafts]
    if before.main_bearing_max is not None and after.main_bearing_max is not None:
        loads = (quantity_text(value, "N", 4) for value in (before.main_bearing_max, after.main_bearing_max))
        lines.append(f"largest load of a main bearing {' -> '.join(loads)}")
    return "\n".join(lines)


def _left(told: "BalanceOfEngine") -> str:
    words = []
    for name, orders, unit in (("force", told.after.force, "N"), ("couple", told.after.couple, "N*m")):
        order, largest = max(orders.items(), key=lambda one: one[1])
        if largest:
            words.append(f"{name} of order {order}, {quantity_text(largest, unit, 4)}")
    return f"largest left: {'; '.join(words)}" if words else "nothing is left that shakes the frame"


def _rows(kind: str, unit: str, before: Mapping[int, float], after: Mapping[int, float]) -> list[Json]:
    return [
        {
            "on the frame": kind,
            "order": order,
            "before": quantity_text(value, unit, 4),
            "after": quantity_text(after[order], unit, 4),
        }
        for order, value in before.items()
        if max(value, after[order]) > _SEEN * max(before.values())
    ]


def _weight(name: str, one: "WeightNumbers") -> str:
    way = "" if name == "counterweight" else f" at {one.order:+d} times the crank's speed"
    return (
        f"{name}{way}: {quantity_text(one.unbalance, 'kg*m', 4)} at {figure(one.angle_deg, 4)} deg, "
        f"z = {quantity_text(one.z, 'm', 4)}" + (f", x = {quantity_text(one.x, 'm', 4)}" if one.x else "")
    )
