"""Validate publications at their entry into a run: all of them can be printed, encoded and recorded."""

from __future__ import annotations

import math
from dataclasses import fields, replace
from typing import Any

from adapters.plugin import Aged, Gone, Published, Report
from physical import is_word, legible


def flaw_of(published: Published) -> str:
    """Return the flaw of a publication, or an empty text."""
    said = published.property if isinstance(published, Aged) else published
    words, numbers = [said.entity], [said.time or 0.0]
    if isinstance(published, Aged):
        numbers.append(published.time_to_live)
    if not isinstance(said, Gone):
        words += [said.kind, *said.channels, *([] if said.carried_by is None else [said.carried_by])]
        numbers += [] if said.velocity is None else [said.velocity.speed, said.velocity.course]
    spoilt = next((word for word in words if not is_word(word)), None)
    if spoilt is not None:
        return f"{spoilt!r:.60} is no word of 1 to 200 characters"
    return "" if all(map(math.isfinite, numbers)) else f"a time or velocity of {said.entity} is no number"


def legible_report(report: Report) -> Report:
    """Return a report with printable texts: file names and server answers may hold anything."""
    texts: list[tuple[str, Any]] = [(each.name, getattr(report, each.name)) for each in fields(report)]
    spoilt = {name: legible(text) for name, text in texts if isinstance(text, str) and legible(text) != text}
    return replace(report, **spoilt) if spoilt else report  # type: ignore[arg-type]  # texts for texts
