"""The words of autopilots and ground stations, and the mission language's forms for them."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from typing import Final

from semantics.behaviours.commands import COMMAND_WORDS
from semantics.behaviours.durations import UNITS
from specs.codes import Code
from specs.diagnostics import Diagnostic
from specs.parse_error import ParsePoint, Word, word_before

_FLIGHT: Final = (
    "a vehicle takes off and lands as its flights need: write control(MOVE_HOST_TO place); "
    "heights are the altitudes of places"
)
_ORDER: Final = (
    "an operator orders that in flight, by bigactors hold or return; "
    "a mission gives the destination: control(MOVE_HOST_TO place)"
)
_PLACE: Final = (
    "a vehicle is sent to an entity: declare target: Kind = circle (37.08, -8.55) radius 100 m, "
    "and write control(MOVE_HOST_TO target)"
)
ORDERS: Final[Mapping[str, str]] = {
    **dict.fromkeys(("takeoff", "take_off", "land", "arm", "disarm", "climb", "descend"), _FLIGHT),
    **dict.fromkeys(("rtl", "rth", "return", "return_home", "hold", "hover", "loiter", "circle"), _ORDER),
    **dict.fromkeys(("goto", "go_to", "fly_to", "waypoint"), _PLACE),
}
"""The hint for each word, in small letters."""

_LENGTHS: Final = frozenset({"m", "km", "ft", "nm", "kn"})
_OPENED: Final = re.compile(r"(\w+)\s*\([^()\n]*\Z")
_TO_A_POINT: Final = re.compile(r"\b(?:MOVE_HOST_TO|TO|VIA|IN)\s*(?:point\s*)?\(?\s*-?\Z")
_SEEN: Final = 200


def ordered(at: ParsePoint) -> Diagnostic | None:
    """`control(LAND)`, `control(TAKEOFF 50 m)`."""
    word = _requested(at)
    hint = "" if word is None else ORDERS.get(word.text.lower(), "")
    if word is None or not hint:
        return None
    return Diagnostic(Code.MISSPELT_KEYWORD, word.span, f"{word.shown} is no control action", hint)


def _requested(at: ParsePoint) -> Word | None:
    """Return the word at the beginning of a control action; the parser may have read it as a rule's name."""
    if COMMAND_WORDS & at.accepted:
        return at.found
    opening = word_before(at.prepared.text, at.before.span.start)
    control = word_before(at.prepared.text, opening.span.start)
    return at.before if at.accepted == {"("} and (control.text, opening.text) == ("control", "(") else None


def called_with_a_unit(at: ParsePoint, words: Mapping[str, str]) -> Diagnostic | None:
    """`wait(10 min)`, `takeoff(50 m)`; `words` are the words of other languages."""
    if at.found.text not in {*_LENGTHS, *UNITS} or not at.before.is_number or ")" not in at.accepted:
        return None
    start = at.before.span.start
    opened = _OPENED.search(at.prepared.text, max(0, start - _SEEN), start)
    hint = words.get(opened[1]) or ORDERS.get(opened[1].lower()) if opened else None
    if opened is not None and hint and not re.search(rf"\bdef\s+{opened[1]}\b", at.prepared.text):
        message = f"'{opened[1]}' is not a word of the language here"
        return Diagnostic(
            Code.MISSPELT_KEYWORD, word_before(at.prepared.text, opened.end(1)).span, message, hint
        )
    message = f"{at.found.shown} is no part of a value"
    return at.mistake(Code.UNEXPECTED, message, "units stand in after 10 min, radius 400 m and altitude 90 m")


def sent_to_a_point(found: Diagnostic, text: str) -> Diagnostic:
    """Return the diagnostic for `control(MOVE_HOST_TO (37.0, -8.7))`; for another bad number, the given one."""
    start = found.span.start
    if found.code is not Code.BAD_NUMBER or not _TO_A_POINT.search(text, max(0, start - _SEEN), start):
        return found
    message = "a control action names an entity, and here are coordinates"
    return replace(found, code=Code.MISSING_DESTINATION, message=message, hint=_PLACE)
