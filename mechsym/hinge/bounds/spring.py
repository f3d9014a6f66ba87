"""What the spring of a guide may be asked: pressure of its gas, and how far it closes."""

from mechsym.hinge.bounds.face import GuideLimit, Station

SPRING_PRESSURE = GuideLimit(
    name="spring_pressure", words="spring pressure", shown="MPa",
    unit="Pa", about="excess pressure in the air spring", allowed={"above": 0},
    value=lambda at, setting: at.pressure, holds=lambda spring, count: spring.gas, by_closing=True,
)  # fmt: skip

CLOSING = GuideLimit(
    name="closing", words="closing z/H", shown="",
    unit="-", about="closing over free height, z / H", allowed={"above": 0, "high": 1},
    value=lambda at, setting: at.z / at.spring.H, by_closing=True,
)  # fmt: skip


def _room(radius: float, room: float, setting: object, at: Station) -> str:
    rho0, H = at.rho0, at.spring.H
    if room > 0:
        return f"roller radius beside the gas column {1e3 * radius:.4g} of at most {1e3 * room:.4g} mm"
    return (
        f"between the rollers is no room for the gas column: 2 rho0 = {2 * rho0:.4g} m, it is H = {H:.4g} m "
        f"long; with rollers of {radius:.4g} m radius rho0 must be at least {H / 2 + radius:.4g} m"
    )


# between the roller centres lie 2 rho = H - z + (2 rho0 - H); the rest beside the gas must hold both rollers
ROOM = GuideLimit(
    name="room", words="roller radius beside the gas column", shown="mm", text=_room,
    value=lambda at, setting: at.rollers.radius, most=lambda at, setting: at.rho0 - at.spring.H / 2,
    holds=lambda spring, count: spring.gas and count == 2, by_closing=True,
)  # fmt: skip
