"""The findings that do not depend on the unreadable parts of a text."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Final

from specs.codes import Code
from specs.diagnostics import Diagnostic, Source
from specs.grammar import keywords
from specs.recovery import SECTION
from specs.syntax import Span

_NAME: Final = re.compile(r"[^\W\d_](?:[\w:.\-]*\w)?")


_DECLARING_NOTHING: Final = frozenset({"check", "live"})
_OF_ABSENCE: Final = frozenset({Code.NO_TIMING, Code.NOT_TIMED})
"""Findings about missing declarations, which may be in an unread part."""


def independent(
    findings: Iterable[Diagnostic], unread: Iterable[Span], source: Source
) -> Iterator[Diagnostic]:
    """Yield the findings that are true for any contents of the unread parts.

    It omits findings about a name that occurs in an unread part, since that part may declare or use it. It also omits
    findings whose span overlaps an unread part. A `check` section declares nothing that is used outside of a property.
    """
    gaps = tuple(unread)
    findings = [found for found in findings if not gaps or found.code not in _OF_ABSENCE]
    declaring = (gap for gap in gaps if _section(source, gap) not in _DECLARING_NOTHING)
    named = {name for gap in declaring for name in _names(source, gap)} - keywords()
    for found in findings:
        about = {*_NAME.findall(found.message), *_names(source, found.span)}
        if not named & about and not any(_overlap(found.span, gap) for gap in gaps):
            yield found


def _section(source: Source, gap: Span) -> str:
    """Return the word of the section that contains a part; empty if the part spans several."""
    begun = [found for found in SECTION.finditer(source.text) if found.start("word") < gap.end]
    several = len(begun) > 1 and begun[-1].start("word") > gap.start
    return begun[-1]["word"] if begun and not several else ""


def _names(source: Source, span: Span) -> list[str]:
    return _NAME.findall(source.text[span.start : span.end])


def _overlap(one: Span, other: Span) -> bool:
    return one.start < other.end and other.start < one.end
