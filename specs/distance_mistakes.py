"""Common mistakes in claims about places and distances: `uav0 at most 3 km from gcs0`."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final

from specs.codes import Code
from specs.diagnostics import Diagnostic
from specs.parse_error import ParsePoint, Word, word_at, word_before

_NEARER: Final = frozenset({"less", "nearer", "closer", "below", "under"})
_FARTHER: Final = frozenset({"more", "farther", "further", "over", "above", "beyond"})
_METRES: Final[Mapping[str, float]] = {
    **dict.fromkeys(("NM", "nm", "nmi", "Nm"), 1852.0),
    **dict.fromkeys(("ft", "feet", "foot"), 0.3048),
    **dict.fromkeys(("mi", "mile", "miles"), 1609.344),
    **dict.fromkeys(("yd", "yards"), 0.9144),
    **dict.fromkeys(("metre", "metres", "meter", "meters", "M"), 1.0),
    **dict.fromkeys(("kilometre", "kilometres", "kilometer", "kilometers", "KM", "Km"), 1000.0),
}
"""The metres of the units that the language does not have."""


_MODALS: Final[Mapping[str, str]] = {
    **dict.fromkeys(("maybe", "perhaps", "possible", "might", "may", "could"), "possibly"),
    **dict.fromkeys(("definitely", "certainly", "certain", "sure", "must", "necessarily"), "surely"),
}
"""Words for the two claims about regions that the language does not have."""


def foreign_length(at: ParsePoint) -> Diagnostic | None:
    """`at least 2 NM from uav1`, `altitude 400 ft`."""
    if not {"m", "km"} <= at.accepted or at.found.text not in _METRES or not at.before.is_number:
        return None
    metres = float(at.before.text) * _METRES[at.found.text]
    message = f"lengths are in m or km, found {at.found.shown}"
    return at.mistake(Code.MISSING_UNIT, message, f"write {metres:.10g} m")


def distance_bound(at: ParsePoint) -> Diagnostic | None:
    """`uav0 at most 25 km from west0`, `uav0 less than 2 km from west0`, `uav0 nearer than 50 m to uav1`."""
    most = at.accepted == {"least"} and at.found.text in ("most", "maximum", "max")
    claimed = {"directly", "linked"} <= at.accepted
    if not most and not (claimed and at.found.text in _NEARER | _FARTHER):
        return None
    who = word_before(at.prepared.text, at.before.span.start) if most else at.before
    number = at.following
    if number.text == "than":
        number = word_at(at.prepared.text, number.span.end)
    unit = word_at(at.prepared.text, number.span.end).text
    if not number.is_number or unit not in ("m", "km", *_METRES):
        return None
    length = (
        f"{number.text} {unit}" if unit in ("m", "km") else f"{float(number.text) * _METRES[unit]:.10g} m"
    )
    other = word_at(at.prepared.text, _behind(at, number.span.end, 3)).text or "place0"
    if at.found.text in _FARTHER:
        hint = f"write {who.text} at least {length} from {other}"
    else:
        hint = f"write {who.text} within {length} of {other}"
    return at.mistake(Code.UNEXPECTED, "distances are compared by 'within' and 'at least'", hint)


def _behind(at: ParsePoint, start: int, words: int) -> int:
    """Return the start of the last of some words behind an offset."""
    for _ in range(words - 1):
        start = word_at(at.prepared.text, start).span.end
    return start


def spare_away(at: ParsePoint) -> Diagnostic | None:
    """`uav0 at least 2 km away from west0`."""
    if at.found.text == "away" and at.accepted == {"from", "or"}:
        return at.mistake(Code.UNEXPECTED, "expected 'from', found 'away'", "leave it out")
    return None


def negated_place(at: ParsePoint) -> Diagnostic | None:
    """`uav0 not in west0`, `possibly uav0 not in west0`."""
    inside = at.found.text == "not" and at.following.text == "in" and "in" in at.accepted
    if not inside or at.in_expression:
        return None
    modal = word_before(at.prepared.text, at.before.span.start).text
    place = word_at(at.prepared.text, at.following.span.end).text
    claim = f"{at.before.text} in {place}"
    if modal in ("possibly", "surely"):
        hint = f"write not possibly {claim}: it never is; or not surely {claim}: it may be elsewhere"
    else:
        hint = f"write not {modal + ' ' if modal in ('actually', 'believed') else ''}{claim}"
    return at.mistake(Code.UNEXPECTED, "'not' stands before the whole claim", hint)


def negated_distance(at: ParsePoint) -> Diagnostic | None:
    """`uav0 not within 2 km of west0`, `uav0 not at least 50 m from uav1`."""
    compared = at.following.text in ("within", "at") and {"within", "at"} <= at.accepted
    if at.found.text != "not" or not compared or at.in_expression:
        return None
    hint = f"write not {at.before.text} {at.following.text} ..."
    return at.mistake(Code.UNEXPECTED, "'not' stands before the whole claim", hint)


def other_modal(at: ParsePoint) -> Diagnostic | None:
    """`maybe uav0 in west0`, `definitely uav0 in west0`."""
    meant = _MODALS.get(at.before.text)
    if meant is None or not at.found.is_name or not {"directly", "linked"} <= at.accepted:
        return None
    message = f"'{at.before.text}' is not a word of the language here"
    return Diagnostic(Code.MISSPELT_KEYWORD, at.before.span, message, f"write {meant} {at.found.text} in ...")


def never(at: ParsePoint) -> Diagnostic | None:
    """`never uav0 in west0`, `not never actually uav0 in west0`."""
    if at.before.text != "never" or not {"directly", "linked"} <= at.accepted:
        return None
    claim = f"{at.found.text} {at.following.text}"
    denied = word_before(at.prepared.text, at.before.span.start)
    message, span = "'never' is not a word of the language here", at.before.span
    if denied.text == "not":
        message, span = "'not never' is not written here", denied.span.to(span)
        hint = f"write {claim} ..., without both: in reachable, it is true at some time"
    else:
        hint = f"write not {claim} ...: an invariant is true at all times; in ltl, always not {claim} ..."
    return Diagnostic(Code.MISSPELT_KEYWORD, span, message, hint)


def begins_distance(text: str, word: Word) -> bool:
    """Return whether a word is the `within` of a distance, and not of a deadline: `within 5 km`."""
    number = word_at(text, word.span.end)
    unit = word_at(text, number.span.end).text
    return word.text == "within" and number.is_number and unit in ("m", "km", *_METRES)


def late_deadline(at: ParsePoint) -> Diagnostic | None:
    """`invariant "r": within 5 min uav0 in east0`: read as the claim of an entity `within`."""
    if at.before.text != "within" or not at.found.is_number or not {"directly", "linked"} <= at.accepted:
        return None
    unit = at.following.text
    hint = f'a deadline is a property: within {at.found.text} {unit} "name": formula'
    return Diagnostic(Code.UNEXPECTED, at.before.span, "'within' and a duration begin no formula", hint)


def claim_by_at(at: ParsePoint) -> Diagnostic | None:
    """`uav0 at west0`: read as the claim `uav0 at least ...`."""
    who = word_before(at.prepared.text, at.before.span.start).text
    if at.accepted != {"least"} or at.before.text != "at" or who in ("take", "takes") or not at.found.is_name:
        return None
    message, hint = "'at' is not a word of the language here", f"write in: {who} in {at.found.text}"
    return Diagnostic(Code.MISSPELT_KEYWORD, at.before.span, message, hint)


DISTANCE_MISTAKES: Final[tuple[Callable[[ParsePoint], Diagnostic | None], ...]] = (
    foreign_length,
    distance_bound,
    claim_by_at,
    spare_away,
    negated_place,
    negated_distance,
    other_modal,
    never,
    late_deadline,
)
