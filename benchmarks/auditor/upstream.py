"""What each line of docs/upstream.md costs, computed without the auditor: `python -m benchmarks.auditor.upstream`."""

import numpy as np
from scipy.integrate import solve_ivp


def newton(slope, target: float, share: float, start: float = 20.0) -> int:
    """Steps of Newton's iteration for tan(x) - x = tan(target) - target, in degrees; `share` of each is taken."""
    x, wanted = np.radians(start), np.radians(target)
    for step in range(100):
        left = np.tan(x) - x - (np.tan(wanted) - wanted)
        if abs(left) < 2e-10:
            return step
        x -= share * left / slope(x)
    return 100


def hertz() -> tuple[float, float]:
    """Larger relative radius of two bodies with radii 10 and 100, and 20 and 200, in the same planes [mm]."""
    first, second = 1 / 10 - 1 / 100, 1 / 20 - 1 / 200
    half = (1 / 10 + 1 / 100 + 1 / 20 + 1 / 200) / 2
    # the curvatures of the gap along the two planes are the sums of the bodies' own
    return 1 / (half - np.hypot(first, second) / 2), 1 / min(1 / 10 + 1 / 20, 1 / 100 + 1 / 200)


def volume(sign: float) -> np.ndarray:
    """Cylinder volume over half a turn in steps of a degree, bore 7.05, stroke bore/1.1, rod 3.5 cranks, r_c 10."""
    crank = 7.05 / 1.1 / 2
    rod, phi = 3.5 * crank, np.radians(np.arange(181))
    pin = crank * np.cos(phi) + np.sqrt(rod**2 + sign * (crank * np.sin(phi)) ** 2)
    return 1500 / 6 / 9 + (rod + crank - pin) * np.pi * 7.05**2 / 4


def mean_speed() -> tuple[float, float]:
    """Mean speed of a piston by its travel: stroke 2, one turn a second; and omega/2/pi*stroke."""
    phi = np.linspace(0, 2 * np.pi, 100_001)
    place = np.cos(phi) + np.sqrt(9 - np.sin(phi) ** 2)
    return float(np.sum(np.abs(np.diff(place)))), 2 * np.pi / 2 / np.pi * 2


def cam_radius(arm: float = 1.8, pivot: float = 2.0, start: float = np.pi / 6) -> tuple[float, float]:
    """Radius of curvature of the path of a roller's centre on an arm that swings by 0.1 sin a, by differences, at 0.7;
    and as written."""

    def centre(a: float) -> complex:
        b = start + 0.1 * np.sin(a)
        return (pivot - arm * np.cos(b) + 1j * arm * np.sin(b)) * np.exp(1j * a)

    a, h = 0.7, 1e-4
    before, here, after = (centre(a + k * h) for k in (-1, 0, 1))
    slope, bend = (after - before) / (2 * h), (after - 2 * here + before) / h**2
    radius = abs(slope) ** 3 / (slope.conjugate() * bend).imag
    b, rate, second = start + 0.1 * np.sin(a), 0.1 * np.cos(a), -0.1 * np.sin(a)
    u = np.arctan2(arm * np.sin(b) * (1 - rate), pivot - arm * np.cos(b) * (1 - rate))
    turned = arm * (1 - rate) * rate * np.cos(b + u) - arm * second * np.sin(b + u)
    uh = turned / (pivot * np.cos(u) - arm * (1 - rate) * np.cos(b + u))
    return radius, (arm * np.cos(b) * (1 - rate) + pivot) / ((1 + uh) * np.cos(u))


def cam_pressure_angle(base: float = 30.0, roller: float = 8.0, offset: float = 15.0) -> tuple[float, float]:
    """Largest pressure angle of an offset roller that rises by 5 (1 - cos a), by its centre's path, and as written."""
    a = np.radians(np.arange(0, 360, 0.1))
    s, rate = 5 * (1 - np.cos(a)), 5 * np.sin(a)

    def angle(foot: float) -> np.ndarray:
        centre = (offset + 1j * (foot + s)) * np.exp(-1j * a)  # in the cam's frame, the follower moves along 1j
        along = np.gradient(centre, a) * np.exp(1j * a)
        normal = 1j * along / abs(along)
        return np.arcsin(np.clip(abs(normal.real), 0, 1))[1:-1]

    foot = np.sqrt((base + roller) ** 2 - offset**2)
    written = abs(np.arctan((rate - offset) / (s + np.hypot(base + roller, offset))))
    return float(np.degrees(angle(foot).max())), float(np.degrees(written.max()))


def slider_acceleration(r: float = 0.05, rod: float = 0.15, omega: float = 100.0) -> tuple[float, float]:
    """Largest error of the slider's acceleration as written by its largest size, and at which angle [deg]."""

    def place(t: np.ndarray) -> np.ndarray:
        return r * np.cos(omega * t) + np.sqrt(rod**2 - (r * np.sin(omega * t)) ** 2)

    a, h = np.radians(np.arange(360.0)), 1e-6
    right = (place(a / omega + h) - 2 * place(a / omega) + place(a / omega - h)) / h**2
    sine, cosine, root = np.sin(a), np.cos(a), np.sqrt(rod**2 - (r * np.sin(a)) ** 2)
    written = -r * omega**2 * cosine - (r * omega * cosine) ** 2 / root + r**3 * omega**2 * sine**2 * cosine / root**3
    off = np.abs(written - right)
    return float(off.max() / np.abs(right).max()), float(np.degrees(a[np.argmax(off)]))


def volume_at_right_angle() -> tuple[float, float]:
    """Cylinder volume at 90 degrees as written and right [cm^3]: crank 27, rod 85, bore 68 mm, 5 cm^3 of clearance."""
    crank, rod, bore = 2.7, 8.5, 6.8
    pins = (np.sqrt(rod**2 + sign * crank**2) for sign in (1, -1))
    written, right = (5 + np.pi * bore**2 / 4 * (rod + crank - pin) for pin in pins)
    return float(written), float(right)


def diesel_efficiency() -> tuple[float, float, float]:
    """Efficiency of a Diesel cycle as written, by its heats and by its closed form; ratios 15 and 2, 1.4."""
    r, cut, k, cold = 15.0, 2.0, 1.4, 300.0
    warm = cold * r ** (k - 1)
    hot = warm * cut
    end = hot * (cut / r) ** (k - 1)
    written = 1 - (end - cold) / (hot - warm) / r ** (k - 1)
    by_heats = 1 - (end - cold) / (k * (hot - warm))
    return written, by_heats, 1 - (cut**k - 1) / (k * (cut - 1) * r ** (k - 1))


def screw() -> tuple[float, float]:
    """Bending stress of a screw as written, and by a second moment that is summed over strips [MPa]."""
    moment, core = 0.9 * 2 * 400 * 470, 42.0  # N mm: two workers of 400 N, nine tenths of them, at 400 + 70 mm
    width = core / 100_000
    y = np.arange(-core / 2 + width / 2, core / 2, width)
    area = float(np.sum(2 * np.sqrt((core / 2) ** 2 - y**2) * y**2) * width)
    return 32 * moment / (3.1416 * core * core), moment * core / 2 / area


def descriptions() -> None:
    """Print what descriptions give that are not those of their programs."""
    print(f"fluids: a loss {(1.56 / 1.156) ** 2:.2f} times as large")
    above, crest, wide, g = 0.3, 0.4, 2.0, 9.80665
    flow = 2 / 3 * np.sqrt(2 * g)
    rehbock = flow * (0.602 + 0.0832 * above / crest) * wide * (above + 0.00125) ** 1.5
    carter = flow * (0.602 + 0.075 * above / crest) * (wide - 0.001) * (above + 0.001) ** 1.5
    print(f"fluids: {rehbock:.3f} m^3/s by the description, {carter:.3f} by the program")
    share, low = 0.5 * (above / (above + crest)) ** 2, 0.615 + 0.000615 / (above + 0.0016)
    rule = flow * low * (1 + share) * wide * above**1.5
    written = flow * low * wide * above + share * wide * np.sqrt(g) * above**1.5
    print(f"fluids: {written:.3f} m^3/s as written, {rule:.3f} by the rule")
    ground, lapse, height, power = 288.15, -0.0065, 1000.0, 9.80665 * 0.0289644 / (8.31432 * -0.0065)
    pressures = [101325 * (ground / below) ** power for below in ((ground + lapse) * height, ground + lapse * height)]
    print("pysolar: {:.1e} Pa by the description, {:.2e} by the program".format(*pressures))
    amplitude, ratio = 40.0, 0.2
    means = amplitude * (1 + ratio) / 2, amplitude * (1 + ratio) / (1 - ratio)
    print("py_fatigue: {:.0f} MPa by the description, {:.0f} by the program".format(*means))


def paper_roll() -> tuple[float, float]:
    """Length of paper on a roll, and what eqn3 of the text gives with its own constant [m]."""
    least, most, length = 0.02, 0.055, 47.0
    k = (most**2 - least**2) / (2 * length)
    constant = least**2 / 2  # the radius where nothing is rolled up
    return length, (most**2 - constant) / (2 * k)


def yo_yo(g: float = 9.81) -> tuple[float, float]:
    """Acceleration of a cylinder on a thread as written, and by energy: m a t^2/2 = m v^2/2 + I omega^2/2 over g."""
    share = 0.5  # I/(m R^2)
    # as written a = share a + g; by energy g s = v^2/2 + share v^2/2 and v^2 = 2 a s
    return g / (1 - share), g / (1 + share)


def texts() -> None:
    """What errors of texts cost."""
    length, rolled = paper_roll()
    print("Mechanics: a yo-yo falls with {:.2f} m/s^2 as written, {:.2f} m/s^2".format(*yo_yo()))
    print(f"ModSimPy: {rolled:.1f} m of paper as written, {length:.1f} m")
    mass, stiffness = 4.0e7, 1.44e7
    swing = solve_ivp(
        lambda t, y: (y[1], -stiffness / mass * y[0]), (0, 40), (1, 0), rtol=1e-10, events=lambda t, y: y[1]
    )
    turning = 2 * np.pi / (swing.t_events[0][-1] - swing.t_events[0][-3])
    print(f"WEC-Sim: {np.sqrt(mass / stiffness):.3f} rad/s as written, {turning:.3f} rad/s by its motion")
    right, left, flat = (10 - 4) / 2 + 1, (10 - 4) / 2 - 1, 4
    print(f"OpenFAST: {right:.0f}, {left:.0f} and {flat} m of liquid, in all {right + left + flat:.0f} m")
    flow, volume_of_kg, low, high = 10, 1e-3, 1e5, 10e5
    pumped = flow * volume_of_kg * (high - low) / 1e3
    inertia = 2 * (12000 + np.pi**2) / 20.944**2
    print(f"dontCompete: {30 * inertia:.0f} kg m^2 as written, {inertia:.1f} kg m^2")
    print(f"CBE20255: a pump that takes {-pumped:.0f} kW as written, {pumped:.0f} kW")
    strength, turn = 5, np.linspace(0, 2 * np.pi, 3601)
    x, y = np.cos(turn), np.sin(turn)
    around = [
        -np.trapezoid(speed * (-y) * np.gradient(x, turn) + speed * x * np.gradient(y, turn), turn)
        for speed in (strength / (2 * np.pi), -strength / (2 * np.pi))
    ]
    print("AeroPython: a circulation of {:.2f} as written, {:.2f}".format(*around))
    before, after = (1 + 1.4 * mach**2 for mach in (0.2, 0.4))
    print(f"gas-dynamics-notes: {before / after:.3f} as written, {100 * before / after:.1f} kPa")


def gerber(
    amplitude: float = 10.0, mean: float = 20.0, endurance: float = 30.0, ultimate: float = 100.0
) -> tuple[float, ...]:
    """Safety after Gerber as written, and as the positive root of n s_a/S_e + (n s_m/S_u)^2 = 1."""
    inside = 2 * mean * endurance / (ultimate * amplitude)
    written = 0.5 * (ultimate / mean) ** 2 * amplitude / endurance * (-1 + np.sqrt(1 + inside))
    return written, float(max(np.roots([(mean / ultimate) ** 2, amplitude / endurance, -1.0])))


def shifted_pair(
    m: float = 3.0, z: tuple[int, int] = (12, 24), x: tuple[float, float] = (0.6, 0.36)
) -> dict[str, tuple[float, float]]:
    """Of a pair with profile shift, as written and as the teeth that a rack cuts have it [mm]."""
    alpha = np.radians(20)
    wanted = 2 * np.tan(alpha) * sum(x) / sum(z) + np.tan(alpha) - alpha
    low, high = 0.01, 1.2
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if np.tan(middle) - middle < wanted else (low, middle)
    y = sum(z) / 2 * (np.cos(alpha) / np.cos(low) - 1)
    # the rack's head cuts the root 1.25 modules below its own pitch line; the other root keeps a quarter of clearance
    root = m * (z[0] - 2.5 + 2 * x[0])
    centre = (sum(z) / 2 + y) * m
    tip = 2 * (centre - 0.25 * m) - m * (z[1] - 2.5 + 2 * x[1])
    pitch = 2 * np.pi * m * z[0] / 2 * np.cos(alpha) / z[0]
    addendum = (1 + y - x[0]) * m
    return {
        "tip": (m * z[0] + 2 * addendum, tip),
        "root": (m * z[0] - 2 * addendum, root),
        "base pitch": (m * np.pi * np.cos(low), pitch),
    }


def mean_crank_speed(r: float = 0.051, rod: float = 0.2, turns: float = 2000 / 60) -> tuple[float, float]:
    """Mean speed of a piston as written, and by its way in a turn [m/s]."""
    phi = np.linspace(0, 2 * np.pi, 100_001)
    place = r * np.cos(phi) + np.sqrt(rod**2 - (r * np.sin(phi)) ** 2)
    return 2 * r * turns, float(np.sum(np.abs(np.diff(place)))) * turns


def machine_design() -> None:
    """Print what lines of machine design cost."""
    print("ICE_thermodynamic: mean piston speed {:.2f} m/s as written, {:.2f} m/s".format(*mean_crank_speed()))
    print(
        f"Tribology: surface speed {70 * 0.1016 / 2 * np.pi:.1f} m/s as written, {2 * np.pi * 70 * 0.1016 / 2:.1f} m/s"
    )
    print(f"Marin_Equation: 3 to 6 ksi has the mean {(6 - 3) / 2} as written, {np.mean([3, 6])}")
    print("Homework: safety after Gerber {:.2f} as written, {:.2f}".format(*gerber()))
    for name, (written, right) in shifted_pair().items():
        print(f"formula: {name} {written:.3f} mm as written, {right:.3f} mm")
    print(f"Angle-Drill-Design-Project: bending stress {0.399**2:.2f} of what it is, with J = 0.399")
    factor = 0.7 * (1.5 - 1) + 1
    print(f"Assignment3: of pure torsion {np.sqrt(factor) / factor:.2f} of the stress as written")
    cosines = np.cos(180 * 180 / np.pi), np.cos(np.pi)
    print("EIM-Projekt: at 180 degrees a cosine of {:.3f} as written, {:.0f}".format(*cosines))


def main() -> None:
    """Print the numbers in the order of the page."""
    for target in (25, 35):
        steps = newton(lambda x: 1 / np.cos(x) - 1, target, 0.5), newton(lambda x: np.tan(x) ** 2, target, 1.0)
        print(f"freecad.gears: to {target} degrees {steps[0]} halved steps as written, {steps[1]} whole ones")
    print("tribology: larger relative radius {:.1f} mm as written, {:.1f} mm".format(*hertz()))
    print("ThermoCycle: mean piston speed {:.3f} by its travel, {:.3f} as written".format(*mean_speed()))
    written, right = volume(1), volume(-1)
    worst = int(np.argmax(np.abs(written / right - 1)))
    print(f"EMAE360: at {worst} degrees {written[worst]:.1f} cm^3 as written, {right[worst]:.1f} cm^3")
    print("Chrono: radius {:.4f} by differences, {:.3f} as written".format(*cam_radius()))
    print(
        "mechanism: largest pressure angle {:.2f} degrees by the path, {:.2f} as written".format(*cam_pressure_angle())
    )
    modulus = 1 / (2 * (1 - 0.33) / 200), 1 / (2 * (1 - 0.33**2) / 200)
    pressure = np.sqrt(modulus[0] / modulus[1]) - 1
    print(f"Gear-Calculators: {modulus[0]:.0f} GPa as written, {modulus[1]:.0f} GPa; pressure {pressure:.0%} too high")
    print(f"ModelingProject3: 1e-3 m^3 and 10 have {9 / 1e-3:.0f} as written, {1e-3 / 9:.2e} m^3")
    print(f"gearCalculator: 24 teeth of pitch 10, outside 2.6 in: {2.6 * 10 + 2:.0f} teeth as written")
    print(
        "slider-crank-mech-edu: acceleration off by {:.0%} of its largest, at {:.0f} degrees".format(
            *slider_acceleration()
        )
    )
    print("Combustion-Engine: at 90 degrees {:.1f} cm^3 as written, {:.1f} cm^3".format(*volume_at_right_angle()))
    print(
        "Python-Programs: efficiency {:.3f} as written, {:.3f} by its heats, {:.3f} in closed form".format(
            *diesel_efficiency()
        )
    )
    swept = np.pi * 0.04**2 * 0.02 / 2
    print(
        f"Projet-Bielle-DAM: at the dead centre {10 * swept / 2 + swept / 19:.2e} m^3 as written, {swept / 19:.2e} m^3"
    )
    print("Machine-Design-Code: {:.0f} MPa as written, {:.1f} MPa".format(*screw()))
    swinging = 60 + 40 * np.sin(np.linspace(0, 2 * np.pi, 4001))
    written, right = (swinging.max() + swinging.min()) / 2, np.ptp(swinging) / 2
    print(f"Machine-Design-Code: an amplitude of {written:.0f} MPa as written, {right:.0f} MPa")
    transverse = np.arctan(np.tan(np.radians(20)) / np.cos(np.radians(20)))
    written, right = np.tan(np.radians(transverse)), np.tan(transverse)
    print(f"MEtoolbox: radial force {written:.4f} of the tangential one as written, {right:.3f}")
    sines = np.sin(100), np.sin(np.radians(100))
    print("Slider-Crank-Analysis: at 100 degrees a sine of {:.3f} as written, {:.3f}".format(*sines))
    turn = np.radians(np.arange(360))
    rise = np.sqrt(1 - np.cos(turn) ** 2)
    rods = np.hypot(np.cos(turn), rise)
    still = np.mean(np.abs(np.sin(turn) + rise) < 1e-9)
    print(
        f"Coding_Project: a rod of {rods.min():.3f} to {rods.max():.3f} as written; at rest for {still:.0%} of a turn"
    )
    machine_design()
    texts()
    descriptions()


if __name__ == "__main__":
    main()
