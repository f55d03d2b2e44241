"""The semantic tokens by which an editor colours names."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Final

from bigactors.lsp.edited_mission import Reading
from specs.syntax import Span

TYPES: Final[Mapping[str, str]] = {
    "type": "kind",
    "class": "agent",
    "enumMember": "entity",
    "event": "channel",
    "macro": "rule",
    "function": "behaviour",
    "variable": "variable",
}
"""The protocol's types of tokens, and our sorts of names."""

MODIFIERS: Final = ("declaration",)
_NUMBERS: Final = {sort: number for number, sort in enumerate(TYPES.values())}


@dataclass(frozen=True, slots=True)
class NameToken:
    """A name, with the number of its type in `TYPES`."""

    span: Span
    type: int
    modifiers: int


def tokens(reading: Reading) -> Iterator[NameToken]:
    """Yield the names of a mission by position."""
    for each in reading.occurrences.all:
        yield NameToken(each.span, _NUMBERS[each.symbol.sort], int(each.declares))
