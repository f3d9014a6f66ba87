"""The start-up of Chmielewski et al. enclosed by another method: the paper's equations by hand, in time steps of which
each is first enclosed by Picard's iteration in intervals, then by a Taylor polynomial with its remainder over that box.

Nothing of the package is used: a second checker that shares the data alone.
"""

from flint import arb, arb_series, ctx

BITS, ORDER, PARTS = 230, 22, 16  # of a step
with ctx.workprec(BITS):
    I0, I2, R, L, M0, K = arb(13) / 50, arb(29) / 50, arb(3) / 50, arb(13) / 50, arb(11) / 10, arb(6500)


def rates(q0, q2, u0, u2, torque):
    """(I0 + m0 x'^2) q0'' = M - k (q0 - q2) - m0 x' x'' q0'^2, I2 q2'' = k (q0 - q2), x the piston's travel."""
    lam, s, c = R / L, q0.sin(), q0.cos()
    square = 1 - lam * lam * s * s
    root = square.sqrt()
    slope = R * s + R * lam * s * c / root
    bend = R * c + R * lam * (c * c - s * s + lam * lam * s * s * s * s) / (square * root)
    twist = K * (q0 - q2)
    return u0, u2, (torque - twist - M0 * slope * bend * u0 * u0) / (I0 + M0 * slope * slope), twist / I2


def coefficients(start, torque, order):
    """Taylor coefficients in time of the states, each list one longer than the order."""
    x = [arb_series([b]) for b in start]
    for k in range(order):
        ctx.cap = k + 2
        x = [arb_series([b]) + f.integral() for b, f in zip(start, rates(*x, torque), strict=True)]
    return [[series[k] for k in range(order + 1)] for series in x]


def box_over(start, torque, h):
    """Intervals that no state leaves in the time h: Picard's operator maps them into themselves."""
    whole = h * arb(0.5, 0.5)
    box = [b + whole * f for b, f in zip(start, rates(*start, torque), strict=True)]
    for _ in range(60):
        box = [b + arb(0, 0.05 * float(b.rad()) + 1e-40) for b in box]
        image = [b + whole * f for b, f in zip(start, rates(*box, torque), strict=True)]
        if all(b.contains(i) for b, i in zip(box, image, strict=True)):
            return image
        box = [b.union(i) for b, i in zip(box, image, strict=True)]
    raise AssertionError("Picard's iteration does not come to rest")


def after(start, torque, h):
    """The states after a time h [s], in balls."""
    cap = ctx.cap
    try:
        with ctx.workprec(BITS):
            part, states = arb(h) / PARTS, [arb(b) for b in start]
            for _ in range(PARTS):
                there = coefficients(states, torque, ORDER - 1)
                rest = coefficients(box_over(states, torque, part), torque, ORDER)
                states = [
                    sum((c * part**k for k, c in enumerate(series)), remainder[ORDER] * part**ORDER)
                    for series, remainder in zip(there, rest, strict=True)
                ]
            return states
    finally:
        ctx.cap = cap
