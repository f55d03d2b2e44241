"""What a run tells an installed plugin of the vehicles that it shall drive."""

from __future__ import annotations

from dataclasses import dataclass

from physical import Geometry


@dataclass(frozen=True, slots=True)
class Assigned:
    """A vehicle of the mission that a plugin shall drive.

    Attributes:
        entity: Its name in the mission.
        kind: Its kind there.
        channels: The channels that the mission gives it: publish those that it is on.
        fence: The polygon that it must stay in, None for none: refuse what lies outside.
        time_to_live: The seconds for which a position of it counts.
    """

    entity: str
    kind: str
    channels: tuple[str, ...] = ()
    fence: Geometry | None = None
    time_to_live: float = 30.0
