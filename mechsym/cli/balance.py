"""`mechsym balance`: counterweights and balancer shafts, forces and couples before and after."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from mechsym.cases import Case
from mechsym.cli.common import case_command, emit, listed, out_option, refuse_idle, table
from mechsym.errors import BadInput
from mechsym.files import Json
from mechsym.quantities.display import figure, quantity_text

if TYPE_CHECKING:
    from mechsym.jobs.forces import BalanceOfEngine, WeightNumbers

_SEEN = 1e-6  # of the largest order: a lower one is not listed
_NOTHING = 1e-6  # of the largest load of a main bearing: a force that is not larger shakes nothing [-]


@case_command("Counterweights and balancer shafts.", out_option)
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
def balance(
    case: Case, weights: str, shafts: str, least: str, largest: str | None, apart: str, out: Path | None
) -> None:
    """What shakes the frame of CASE, and the weights that leave the least of it at its speed of operation.

    Weights come on top of what the case has.

    \b
    Examples: mechsym balance opposed-pistons --shafts 1
              mechsym balance zotov-89 --weights none --shafts 1,2 --out balance
    """
    from mechsym.cases.outcomes import of_shafts
    from mechsym.jobs.forces import balance as run
    from mechsym.jobs.forces import numbers, write_balance
    from mechsym.mechanisms import listing
    from mechsym.quantities import parse

    most = None if largest is None else parse(largest, "kg*m", "--largest")
    if most is not None and most <= 0:
        raise BadInput(f"--largest = {largest}: give more than 0 kg*m, or leave it away")
    orders = listed(shafts, "--shafts") if shafts else []
    if any(one not in ("1", "2", "3", "4") for one in orders):
        raise BadInput(f"--shafts = {shafts}: balancer shafts turn 1 to 4 times as fast as the crank; write 1,2")
    if weights == "none":
        refuse_idle("beside --weights none", "largest", "least")
    distance = parse(apart, "m", "--apart")
    if not orders:
        refuse_idle("without --shafts", "apart")
    one = run(case, weights, tuple(map(int, orders)), least, most, distance)
    balanced = numbers(case, one)
    files = write_balance(one, balanced, out, case.about or listing(case.mechanism)["about"]) if out else []
    emit(balanced, lambda: _text(balanced), beside={"doubts": list(of_shafts(case, distance))}, files=files)


def _text(balanced: "BalanceOfEngine") -> str:
    before, after = balanced.before, balanced.after
    rows: list[Json] = []
    left = []
    for kind, unit in (("force", "N"), ("couple", "N*m"), ("roll", "N*m")):
        was, remains = getattr(before, kind), getattr(after, kind)
        if kind == "force" and max(was.values(), default=0.0) <= _NOTHING * (before.main_bearing_max or 0.0):
            continue
        for order, value in was.items():
            rest = remains.get(order, 0.0)
            if max(value, rest) > _SEEN * max(was.values()):
                texts = [quantity_text(size, unit, 4) for size in (value, rest)]
                rows.append({"on the frame": kind, "order": order, "before": texts[0], "after": texts[1]})
        worst = max(remains, key=remains.__getitem__, default=None)
        if kind != "roll" and worst is not None and remains[worst]:
            left.append(f"{kind} of order {worst}, {quantity_text(remains[worst], unit, 4)}")
    words = f"largest left: {'; '.join(left)}" if left else "no force and no couple is left that shakes the frame"
    lines = [f"{balanced.case}: balance at {balanced.speed_rpm:.6g} rpm", words, ""]
    if rows:
        lines += [table(rows, ["on the frame", "order", "before", "after"]), ""]
    lines += [_weight("counterweight", one) for one in balanced.counterweights]
    lines += [_weight("balancer shaft", one) for one in balanced.shafts]
    if before.main_bearing_max is not None and after.main_bearing_max is not None:
        loads = (quantity_text(value, "N", 4) for value in (before.main_bearing_max, after.main_bearing_max))
        lines.append(f"largest load of a main bearing {' -> '.join(loads)}")
    return "\n".join(lines)


def _weight(name: str, one: "WeightNumbers") -> str:
    way = "" if name == "counterweight" else f" at {one.order:+d} times the crank's speed"
    return (
        f"{name}{way}: {quantity_text(one.unbalance, 'kg*m', 4)} at {figure(round(one.angle_deg, 9), 4)} deg, "
        f"z = {quantity_text(one.z, 'm', 4)}" + (f", x = {quantity_text(one.x, 'm', 4)}" if one.x else "")
    )
