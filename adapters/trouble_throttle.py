"""Troubles, collected: repeated ones are reported once a second."""

from __future__ import annotations

from typing import Final

from adapters.plugin import Trouble, World

EVERY: Final = 1.0
MAX_KINDS: Final = 64
"""The most kinds of troubles that are counted apart; others are counted together."""


class Troubles:
    """The troubles since the last report, by kind."""

    def __init__(self, source: str) -> None:
        self._source = source
        self._found: dict[str, tuple[str, int]] = {}
        self._reported: float | None = None

    def note(self, what: str, detail: str = "", count: int = 1) -> None:
        """Count one trouble, or several; the first detail of its kind is kept."""
        kind = what if what in self._found or len(self._found) < MAX_KINDS else "other troubles"
        first, before = self._found.get(kind, (detail, 0))
        self._found[kind] = (first, before + count)

    def report(self, world: World, *, now: bool = False) -> None:
        """Report all troubles, if a second has passed since the last report, or at once."""
        time = world.now()
        early = self._reported is not None and time - self._reported < EVERY
        if not self._found or (early and not now):
            return
        for what, (detail, count) in self._found.items():
            world.report(Trouble(self._source, time, what, detail, count))
        self._found.clear()
        self._reported = time
