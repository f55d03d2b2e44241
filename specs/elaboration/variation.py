"""Variations of a mission at load time: its scheduler, kind of control, and files."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from semantics.state.setting import Control, Scheduler


@dataclass(frozen=True, slots=True)
class Variation:
    """The same mission under another scheduler or kind of control, or in a world from other files.

    Attributes:
        scheduler: The replacement of the mission's scheduler; None keeps it.
        control: The replacement of the mission's kind of control; None keeps it.
        sources: The replacements of the mission's files, by the names that it gives.
    """

    scheduler: Scheduler | None = None
    control: Control | None = None
    sources: Mapping[str, Path] = field(default_factory=dict)


AS_WRITTEN = Variation()
