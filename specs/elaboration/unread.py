"""What an elaboration finds that does not depend on the parts of a text that could not be read."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Final

from specs.diagnostics import Diagnostic, Source
from specs.grammar import keywords
from specs.syntax import Span

_NAME: Final = re.compile(r"[^\W\d_](?:[\w:.\-]*\w)?")


def independent(
    findings: Iterable[Diagnostic], unread: Iterable[Span], source: Source
) -> Iterator[Diagnostic]:
    """Yield the findings that are true whatever stands in the unread parts.

    Left out is what is said of a name that stands in one, since it may be declared or used there, and what is said of
    a stretch that has one in it.
    """
    gaps = tuple(unread)
    named = {name for gap in gaps for name in _names(source, gap)} - keywords()
    for found in findings:
        about = {*_NAME.findall(found.message), *_names(source, found.span)}
        if not named & about and not any(_overlap(found.span, gap) for gap in gaps):
            yield found


def _names(source: Source, span: Span) -> list[str]:
    return _NAME.findall(source.text[span.start : span.end])


def _overlap(one: Span, other: Span) -> bool:
    return one.start < other.end and other.start < one.end
