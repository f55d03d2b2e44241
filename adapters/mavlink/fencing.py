"""A vehicle's own fences beside the polygon that it is given: a circle around home, and a ceiling."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from adapters.mavlink.constants import Fence, FenceAction
from adapters.mavlink.profiles import ARDUPILOT_DIALECT, Dialect
from adapters.mavlink.telemetry import Telemetry
from physical import Geometry, distance, point

EACH_BY_ITSELF: Final = (4, 6)
"""The version of ArduPilot since which one fence can be switched on without the others."""


@dataclass(frozen=True, slots=True)
class OwnFences:
    """A vehicle's own fences: metres around home and above it, None for a fence that is off."""

    circle: float | None = None
    ceiling: float | None = None
    dialect: Dialect = ARDUPILOT_DIALECT

    def __str__(self) -> str:
        circle, ceiling = self.dialect.fence_circle, self.dialect.fence_ceiling
        around = [] if self.circle is None else [f"within {self.circle:g} m around home ({circle})"]
        below = [] if self.ceiling is None else [f"below {self.ceiling:g} m above home ({ceiling})"]
        return " and ".join([*around, *below])

    def remedy(self, name: str) -> str:
        """Return what an operator may do about the fence of which `name` is the parameter."""
        if self.dialect.fence_action:
            return f"set {name} to more, or to 0 for none"
        return f"set FENCE_TYPE to 4 (the polygon alone), or {name} to more"


def own_fences(known: Telemetry, *, given: bool) -> OwnFences:
    """Return the fences that are on, or come on with a `given` polygon."""
    told, dialect = known.parameters, _dialect(known)
    if dialect.fence_action:
        circle, ceiling = (told.get(name) or None for name in (dialect.fence_circle, dialect.fence_ceiling))
        return OwnFences(circle, ceiling, dialect) if _acts(known) else OwnFences(dialect=dialect)
    by_itself = told.get("FENCE_ENABLE") or told.get("FENCE_AUTOENABLE")
    with_ours = given and (known.version is None or known.version < EACH_BY_ITSELF)
    if not by_itself and not with_ours:
        return OwnFences()
    configured = _configured(known)
    return OwnFences(
        told.get("FENCE_RADIUS") if Fence.CIRCLE in configured else None,
        told.get("FENCE_ALT_MAX") if Fence.ALT_MAX in configured else None,
    )


def _configured(known: Telemetry) -> Fence:
    return Fence(int(known.parameters.get("FENCE_TYPE", 0)) & 15)


def _dialect(known: Telemetry) -> Dialect:
    return ARDUPILOT_DIALECT if known.profile is None else known.profile.dialect


def _acts(known: Telemetry) -> bool:
    """Tell whether a vehicle whose fences need no switch does anything at them, as far as it has told."""
    return known.parameters.get(_dialect(known).fence_action, FenceAction.HOLD) > FenceAction.WARN


def keeps_no_polygon(known: Telemetry) -> str | None:
    """Return why a vehicle would not obey a given polygon."""
    action = _dialect(known).fence_action
    if action:
        told = f"it keeps within no polygon: its {action} is {known.parameters.get(action, 0):g}"
        return None if _acts(known) else f"{told}; set it to 2 (hold) or 3 (return), or fly with --fence none"
    if "FENCE_TYPE" not in known.parameters or Fence.POLYGON in _configured(known):
        return None
    return (
        f"it keeps within no polygon: its FENCE_TYPE is {known.parameters['FENCE_TYPE']:g}; "
        "add 4 to that, or fly with --fence none"
    )


def beyond(
    own: OwnFences, known: Telemetry, at: Geometry, room: float, height: float | None, name: str
) -> Iterator[str]:
    """Yield why a vehicle's own fences prevent it from circling at a point."""
    if own.circle is not None and known.home is not None:
        away = distance(point(*known.home), at) + room
        if away > own.circle:
            yield (
                f"its circle fence of {own.circle:g} m around home does not hold {name}, which takes {away:.0f} m: "
                f"it would stop there, or not go; {own.remedy(own.dialect.fence_circle)}"
            )
    if own.ceiling is not None and height is not None and height >= own.ceiling:
        yield (
            f"its altitude fence of {own.ceiling:g} m does not hold a flight at {height:g} m above home: "
            f"{own.remedy(own.dialect.fence_ceiling)}"
        )
