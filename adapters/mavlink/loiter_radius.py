"""The room that a vehicle needs to stay at a place: the circle that it flies, and the effect of wind."""

from __future__ import annotations

from adapters.mavlink.fleet import Craft
from adapters.mavlink.profiles import Profile
from adapters.mavlink.telemetry import Telemetry


def circle(craft: Craft, profile: Profile, known: Telemetry) -> float:
    """Return the radius in metres at which it circles: the mission's, else its own."""
    if craft.circle is not None:
        return craft.circle
    return abs(known.parameters.get(profile.dialect.circle, 0.0)) or profile.circle


def home_circle(craft: Craft, profile: Profile, known: Telemetry) -> float:
    """Return the radius in metres at which it circles its home when it returns."""
    return abs(known.parameters.get(profile.dialect.home_circle, 0.0)) or circle(craft, profile, known)


def room(craft: Craft, profile: Profile, known: Telemetry) -> float:
    """Return the radius in metres within which its circles stay, in wind too."""
    return circle(craft, profile, known) * profile.drift


def described(craft: Craft, profile: Profile, known: Telemetry) -> str:
    """Return a text about the room that a vehicle needs, with the figures."""
    radius, needed = circle(craft, profile, known), room(craft, profile, known)
    if needed == radius:
        return f"a circle of {radius:g} m"
    name = profile.dialect.circle
    whose = f" ({name})" if craft.circle is None and name in known.parameters else ""
    return f"a circle of {needed:g} m: it circles at {radius:g} m{whose}, and wind carries it farther out"
