"""The point where a vehicle stays in a place, and the room that it needs: its circle, widened by wind."""

from __future__ import annotations

from adapters.mavlink.profiles import Profile
from adapters.mavlink.telemetry import Telemetry
from adapters.mavlink.vehicle_identities import Craft
from adapters.plugin import Follow, GoTo
from physical import Geometry, Surroundings, point, standing, waypoint, widest


def circle(craft: Craft, profile: Profile, known: Telemetry) -> float:
    """Return the radius in metres at which it circles: the mission's, else its own."""
    if craft.circle is not None:
        return craft.circle
    return abs(known.parameters.get(profile.dialect.circle, 0.0)) or profile.circle


def home_circle(craft: Craft, profile: Profile, known: Telemetry) -> float:
    """Return the radius in metres at which it circles its home when it returns."""
    return abs(known.parameters.get(profile.dialect.home_circle, 0.0)) or circle(craft, profile, known)


def room(craft: Craft, profile: Profile, known: Telemetry) -> float:
    """Return the radius in metres that contains its circles, in wind too."""
    return circle(craft, profile, known) * profile.drift


def described(craft: Craft, profile: Profile, known: Telemetry) -> str:
    """Return a text about the room that a vehicle needs, with the figures."""
    radius, needed = circle(craft, profile, known), room(craft, profile, known)
    if needed == radius:
        return f"a circle of {radius:g} m"
    name = profile.dialect.circle
    whose = f" ({name})" if craft.circle is None and name in known.parameters else ""
    return f"a circle of {needed:g} m: it circles at {radius:g} m{whose}, and wind carries it farther out"


def goal(command: GoTo | Follow) -> Geometry:
    """Return the last place of a command."""
    return command.place if isinstance(command, GoTo) else command.path[-1]


def stay(command: GoTo | Follow, radius: float) -> Geometry | None:
    """Return the point around which a vehicle stays in its last place, None if a circle does not fit.

    It is the centroid if a circle around it respects the surroundings, else the nearest such point.
    """
    at = standing(command.shape or point(0, 0), goal(command), command.around, radius)
    return None if at is None else waypoint(at)


def cramped(command: GoTo | Follow, craft: Craft, profile: Profile, known: Telemetry) -> str | None:
    """Return the reason why a vehicle has no room in its last place, with the figures; None if it has room."""
    place, name = goal(command), command.name or "the place"
    if stay(command, room(craft, profile, known)) is not None:
        return None
    needed, mover = described(craft, profile, known), command.shape or point(0, 0)
    alone = widest(mover, place, Surroundings())
    if alone < room(craft, profile, known):
        small = f"{name} is too small: its widest circle has {alone:.0f} m"
        return f"{small}, and to stay in it the {profile.kind} needs {needed}"
    clear = widest(mover, place, command.around)
    return (
        f"{name} leaves too little room beside places that reach into it: the widest circle that crosses no border "
        f"has {clear:.0f} m, and to stay there the {profile.kind} needs {needed}"
    )
