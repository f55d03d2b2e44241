"""The vehicles of a run that an installed plugin drives."""

from __future__ import annotations

from dataclasses import dataclass

from physical import Geometry


@dataclass(frozen=True, slots=True)
class Assigned:
    """A vehicle of the mission that a plugin drives.

    Attributes:
        entity: Its name in the mission.
        kind: Its kind there.
        channels: Its channels in the mission: publish those that it is on.
        fence: The polygon that it must stay in, None for none: refuse positions outside.
        time_to_live: The seconds for which its position is valid.
    """

    entity: str
    kind: str
    channels: tuple[str, ...] = ()
    fence: Geometry | None = None
    time_to_live: float = 30.0
