"""Records as loggers, spreadsheets and people leave them: a shaft or a pressure, what is done to it, how it is written.

`write(rng, file, kind)` makes one of a KIND: `speed` of a shaft that starts, `pressure` of a cylinder over its turns,
`torque` of a crank over one turn.
"""

import functools
import random
from pathlib import Path

import numpy as np

from mechsym import cases
from mechsym.jobs.run import run

HEADS = {
    "speed": (
        "t [s],phi0d [rad/s]", "t [s],phi0d [rad/s]", "t [ms],phi0d [rpm]", "t_s,speed_rpm", "time,speed", "", "t,t",
        "t [s],phi0d [m]", "t [],phi0d []", "t [s],phi0d [rad/s],M [N*m]", "t [s],phi2d [rad/s]", "phi0d [rad/s],t [s]",
        "t [s],phid [rad/s]", "t [h],phi0d [deg/s]", "t [s],phi0 [rad]", "Zeit [s],Drehzahl [1/min]", "t [s],ω [rad/s]",
        "t [µs],phi0d [rad/s]", "t [s],phi0d [°/s]", "t [s],phi0d [rad/s],phi0d [rad/s]", "t [s,phi0d rad/s]",
    ),
    "pressure": (
        "crank_angle_deg,pressure_bar", "crank_angle_deg,pressure_bar", "crank_angle_deg,time_s,pressure_bar", "p,phi",
        "deg,bar", "crank_angle_deg,pressure_pa", "", "phi [°],p [bar]", "time_s,pressure_bar", "phi [deg],p [kPa]",
        "pressure_bar,crank_angle_deg", "phi [rad],p [psi]", "crank_angle_deg,pressure_bar,pressure_bar",
    ),
    "torque": ("phi [deg],torque [N*m]", "crank_angle_deg,torque_nm", "phi,M", "", "M [N*m],phi [deg]",
               "phi [rad],M [kN*m]"),
}  # fmt: skip
ROWS = (0, 1, 5, 60, 400, 400, 1500, 1500, 1500, 6000)
MANY, SELDOM = 1_200_000, 0.02  # rows of a logger that nobody stopped, and how often


def clean(rng: random.Random, kind: str, count: int) -> np.ndarray:
    """Columns of the machine that is asked of, or of another one."""
    if kind != "torque" and rng.random() < 0.5:
        return _own(kind)[:count].copy()
    noise = np.random.default_rng(rng.randrange(2**32))
    if kind == "speed":
        t = np.arange(count) * 10 ** rng.uniform(-4, -1)
        last, slow = rng.choice((5.0, 40.0, 150.0, 600.0)), rng.choice((0.3, 3.0, 30.0))
        speed = last * (1 - np.exp(-t / slow)) * (1 + rng.choice((0, 0.01, 0.2)) * np.sin(last * t))
        return np.column_stack([t, speed + noise.normal(0, rng.choice((0, 0.002, 0.3)), count), 60 * np.cos(t)])
    step, per_turn = rng.choice((0.1, 0.5, 1.0, 1.0)), rng.choice((360, 720))
    angle = np.arange(count) * step + rng.choice((0, 0, -180, -360))
    if kind == "torque":
        return np.column_stack([angle, 500 * np.sin(np.radians(angle)) + noise.normal(0, 2, count), 0 * angle])
    phi = np.radians((angle + per_turn / 2) % per_turn - per_turn / 2)
    volume = 0.12 + 0.5 * (1 - np.cos(phi))
    burnt = 25 * np.exp(-(((phi - 0.2) / 0.4) ** 2)) * rng.choice((0, 1, 1))
    p = 1.0 * (1.12 / volume) ** 1.33 + burnt + noise.normal(0, 0.05, count)
    return np.column_stack([angle, p, angle / (6 * rng.choice((90, 1500, 3000)))])


@functools.cache
def _own(kind: str) -> np.ndarray:
    """What the machine of the built-in case would give, as a run or its file has it."""
    if kind == "pressure":
        lines = Path(cases.__file__).with_name("generator-synthetic.csv").read_text().splitlines()
        rows = np.genfromtxt([line for line in lines if line[0] in "-0123456789"], delimiter=",")
        return rows[:, [0, 2, 1]]
    short = {"simulation.t_end": "3 s", "simulation.window": "1 s", "simulation.output_step": "2 ms"}
    start = run(cases.load("chmielewski", short), check="none").result
    speed = start.columns["phi0d"] + np.random.default_rng(1).normal(0, 0.002, len(start.t))
    return np.column_stack([start.t, speed, 0 * start.t])


def _stretch(rng: random.Random, rows: np.ndarray) -> slice:
    first = rng.randrange(len(rows))
    return slice(first, first + rng.choice((1, 5, max(1, len(rows) // 4))))


def _gap(rng: random.Random, rows: np.ndarray) -> np.ndarray:
    return np.delete(rows, _stretch(rng, rows), axis=0)


def _set(value: float, column: int = 1):
    def spoil(rng: random.Random, rows: np.ndarray) -> np.ndarray:
        rows[_stretch(rng, rows), column] = value
        return rows

    return spoil


def _times(column: int, *factors: float):
    def spoil(rng: random.Random, rows: np.ndarray) -> np.ndarray:
        rows[:, column] *= rng.choice(factors)
        return rows

    return spoil


def _plus(column: int, *shifts: float):
    def spoil(rng: random.Random, rows: np.ndarray) -> np.ndarray:
        rows[:, column] += rng.choice(shifts)
        return rows

    return spoil


def _shuffled(rng: random.Random, rows: np.ndarray) -> np.ndarray:
    return rows[rng.sample(range(len(rows)), len(rows))]


def _again(span: float):
    """Angles or times that begin again after a span, or after half the record where it is 0."""

    def spoil(rng: random.Random, rows: np.ndarray) -> np.ndarray:
        return np.column_stack([rows[:, 0] % (span or max(rows[-1, 0] / 2, 1e-9)), rows[:, 1:]])

    return spoil


def _noise(sizes: list[float]):
    return lambda rng, rows: rows + np.random.default_rng(1).normal(0, 1, rows.shape) * sizes


SPOILS = {
    "gap": _gap, "nan": _set(np.nan), "no time": _set(np.nan, 0), "inf": _set(np.inf), "zeros": _set(0.0),
    "stuck": _set(17.0), "huge": _set(1e308), "tiny": _set(1e-308), "one instant": _set(0.0, 0),
    "clock in ms": _times(0, 1e3, 1e6, 1 / 60, 1 / 3600, 1e-3), "sign": _times(1, -1), "backwards": _times(0, -1),
    "other unit": _times(1, 60 / (2 * np.pi), 2 * np.pi / 60, 180 / np.pi, 1e5, 14.5, 0.1),
    "date": _plus(0, 1.7e9, 1e6, -5.0), "offset": _plus(1, 5.0, -500.0), "shuffled": _shuffled,
    "swapped": lambda rng, rows: rows[:, [1, 0, 2]], "reversed": lambda rng, rows: rows[::-1],
    "twice": lambda rng, rows: np.repeat(rows, 2, axis=0), "again": lambda rng, rows: np.concatenate([rows, rows]),
    "dropped": lambda rng, rows: rows[:: rng.choice((2, 7, 50))], "flat": lambda rng, rows: rows * [1, 0, 1],
    "coarse": lambda rng, rows: np.round(rows, rng.choice((0, 1))), "reset": _again(0), "wrapped": _again(360),
    "clipped": lambda rng, rows: np.clip(rows, -1e9, 20.0), "noise": _noise([0, 20, 0]), "jitter": _noise([1e-3, 0, 0]),
}  # fmt: skip
LINES = (
    "units",
    "#DIV/0!;x",
    "nan,nan",
    "1,2,3,4,5,6,7",
    "",
    ",",
    "# comment",
    "1.5.2,3",
    "１,２",
    "end of record",
    '"1"",2',
)
ENCODINGS = ("utf-8-sig", "utf-16", "utf-32", "latin-1", "cp1252", "shift-jis")


def write(rng: random.Random, file: Path, kind: str, most: int = MANY) -> None:
    """One record into a file."""
    count = MANY if most >= MANY and rng.random() < SELDOM else rng.choice(ROWS)
    rows = clean(rng, kind, count)
    for _ in range(rng.choice((0, 1, 1, 2, 3))):
        if len(rows):
            with np.errstate(all="ignore"):
                rows = SPOILS[rng.choice(list(SPOILS))](rng, rows)
    head = HEADS[kind][0] if rng.random() < 0.6 else rng.choice(HEADS[kind])
    mark = "," if rng.random() < 0.85 else rng.choice((";", "\t", " ", "|"))
    columns = min(3, max(1, head.count(",") + 1)) if head else 2
    if "time_s,p" in head and columns == 3:
        rows = rows[:, [0, 2, 1]]
    digits = rng.choice((4, 7, 7, 7, 17))
    lines = [mark.join(f"{v:.{digits}g}" for v in row) for row in rows[:, :columns].tolist()]
    text = "\n".join([*([head.replace(",", mark)] if head else []), *lines]) + rng.choice(("\n", "\n", "", "\n\n\n"))
    file.write_bytes(_typed(rng, text, mark))


def _typed(rng: random.Random, text: str, mark: str) -> bytes:
    """The text as another program, another country or a broken disk leaves it."""
    if rng.random() < 0.12:
        lines = text.split("\n")
        for _ in range(rng.choice((1, 1, 3))):
            lines.insert(rng.choice((0, 1, rng.randrange(len(lines) + 1))), rng.choice(LINES))
        text = "\n".join(lines)
    changes = ("comma", "exponent", "trailing", "quoted", "crlf", "cr", "padded", "nul", "cut")
    change = rng.choice(changes) if rng.random() < 0.25 else ""
    match change:
        case "comma":
            text = text.replace(".", ",")
        case "exponent":
            text = text.replace("e", "D")
        case "trailing":
            text = text.replace("\n", f"{mark}\n")
        case "quoted":
            text = text.replace(mark, f'"{mark}"')
        case "crlf" | "cr":
            text = text.replace("\n", {"crlf": "\r\n", "cr": "\r"}[change])
        case "padded":
            text = text.replace(mark, f"  {mark}   ")
        case "nul":
            text = text.replace("\n", "\n\0", 3)
        case "cut":
            text = text[: rng.randrange(len(text) + 1)]
    data = text.encode(rng.choice(ENCODINGS) if rng.random() < 0.12 else "utf-8", "replace")
    return data if rng.random() < 0.97 else data + rng.randbytes(40)
