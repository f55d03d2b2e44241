"""The constants of a live run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from semantics.live_policy import LivePolicy
from semantics.properties.property import Property
from semantics.state.configuration import Configuration
from semantics.state.signature import Name


@dataclass(frozen=True, eq=False)
class Plan:
    """The constants of a live run.

    Attributes:
        first: The mission's first configuration, under `control timed` and `fcfs`.
        vehicles: For each entity that takes commands, the plugin that owns it.
        precautions: The mission's responses to broken assumptions and exceeded time limits.
        strict: Whether other requests wait while a vehicle or an operator keeps one waiting, since the verdict is for
            `fcfs` only.
        peers: The plugin of the other stations, which also reports vehicles; empty if there are none.
        invariants: The mission's invariants about ways, which the run watches.
        fixed: The entities that never move: where they are not seen, they are where the mission has them.
    """

    first: Configuration
    vehicles: Mapping[Name, str] = field(default_factory=dict)
    precautions: LivePolicy = field(default_factory=LivePolicy)
    strict: bool = False
    peers: str = ""
    invariants: tuple[Property, ...] = ()
    fixed: frozenset[Name] = frozenset()
