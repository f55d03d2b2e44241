"""Variations of a mission when it is loaded: its scheduler, kind of control, and files."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from semantics.state.setting import Control, Scheduler


@dataclass(frozen=True, slots=True)
class Variation:
    """The same mission under another scheduler or kind of control, or in a world from other files.

    Attributes:
        scheduler: In the place of the mission's own; None leaves it.
        control: Likewise.
        sources: Files in the place of those that the mission names, by the name that it gives.
    """

    scheduler: Scheduler | None = None
    control: Control | None = None
    sources: Mapping[str, Path] = field(default_factory=dict)


AS_WRITTEN = Variation()
