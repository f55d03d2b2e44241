"""Validate publications at their entry into a run: all of them can be printed, encoded and recorded."""

from __future__ import annotations

import math
from dataclasses import fields, replace
from typing import Any

from adapters.plugin import Aged, Gone, Published, Report
from physical import is_word, legible


def flaw_of(published: Published) -> str:
    """Return the flaw of a publication, or an empty text."""
    observed = published.property if isinstance(published, Aged) else published
    words, numbers = [observed.entity], [observed.time or 0.0]
    if isinstance(published, Aged):
        numbers.append(published.time_to_live)
    if not isinstance(observed, Gone):
        words += [
            observed.kind,
            *observed.channels,
            *([] if observed.carried_by is None else [observed.carried_by]),
        ]
        numbers += [] if observed.velocity is None else [observed.velocity.speed, observed.velocity.course]
    spoilt = next((word for word in words if not is_word(word)), None)
    if spoilt is not None:
        return f"{spoilt!r:.60} is no word of 1 to 200 characters"
    return "" if all(map(math.isfinite, numbers)) else f"a time or velocity of {observed.entity} is no number"


def legible_report(report: Report) -> Report:
    """Return a report with printable texts: file names and server answers may hold anything."""
    texts: list[tuple[str, Any]] = [(each.name, getattr(report, each.name)) for each in fields(report)]
    spoilt = {name: legible(text) for name, text in texts if isinstance(text, str) and legible(text) != text}
    return replace(report, **spoilt) if spoilt else report  # type: ignore[arg-type]  # texts for texts
