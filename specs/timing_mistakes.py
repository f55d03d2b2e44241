"""Common mistakes about times: in bounds, durations, and properties with deadlines."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final

from semantics.behaviours.durations import UNITS, duration_text
from specs.codes import Code
from specs.diagnostics import Diagnostic
from specs.parse_error import ParsePoint, Word, word_at, word_before

_REACTING: Final = "bigActors have one bound together: agents react within 1 s"
_FLYING: Final = "the duration of a flight follows from speeds: write flies at 18 m/s to 25 m/s"
_LASTING: Final = "write lasts 45 min, restored in airfield0 after 20 min"
_CHANGING: Final = "the duration of a change stands in timing { ... }: wifi drops and returns within 5 min"

BEGINNING: Final[Mapping[str, str]] = {
    **dict.fromkeys(("observe", "sensing", "observation", "observations"), "write sense within 5 s"),
    **dict.fromkeys(("react", "reaction", "reactions"), _REACTING),
    **dict.fromkeys(("send", "message"), "write messages over wifi within 5 s, or messages on one host"),
    "control": "write the duration of a command by its first word, HAND within 10 s, and the speed of flights",
}
"""The hint for a bound that begins with a statement's name."""

TAKING: Final[Mapping[str, str]] = {
    **dict.fromkeys(("moves", "drives", "goes", "travels", "sails", "speed", "arrives", "lands"), _FLYING),
    **dict.fromkeys(("endurance", "endures", "battery", "hovers", "survives"), _LASTING),
    **dict.fromkeys(("reacts", "react", "responds", "answers", "computes"), _REACTING),
}
"""The hint for a name's bound with a foreign verb."""

_BEFORE_DURATIONS: Final = frozenset(
    {"take", "takes", "lasts", "within", "every", "after", "until", "tick", "least"}
)


_UNIT_WORDS: Final[Mapping[str, str]] = {
    **dict.fromkeys(("minutes", "minute", "mins"), "min"),
    **dict.fromkeys(("seconds", "second", "sec", "secs"), "s"),
    **dict.fromkeys(("hours", "hour", "hr", "hrs"), "h"),
    **dict.fromkeys(("milliseconds", "millis"), "ms"),
    **dict.fromkeys(("mps",), "m/s"),
    **dict.fromkeys(("kmh", "kph"), "km/h"),
    **dict.fromkeys(("knots", "knot", "kt", "kts"), "kn"),
}
"""The unit of times and speeds for a word of other texts."""


def foreign_unit(at: ParsePoint) -> Diagnostic | None:
    """`within 15 minutes`, `flies at 10 mps`."""
    unit = _UNIT_WORDS.get(at.found.text)
    if unit not in at.accepted or not at.before.is_number:
        return None
    message = f"{at.found.shown} is no unit of the language"
    return at.mistake(Code.MISSING_UNIT, message, f"write {at.before.text} {unit}")


def argued_endurance(at: ParsePoint) -> Diagnostic | None:
    """`check { endurance 25 min }`."""
    if at.before.text != "endurance" or "invariant" not in at.accepted or at.is_first:
        return None
    hint = "its times stand in timing { uav0 lasts 45 min, restored in base0 after 20 min }"
    return at.mistake(Code.UNEXPECTED, "'endurance' stands alone", hint)


def exact_time(at: ParsePoint) -> Diagnostic | None:
    """`tanker0 vanishes at 1 h`."""
    if at.found.text != "at" or not {"after", "within"} <= at.accepted or not at.following.is_number:
        return None
    time = _duration_at(at, at.following)
    return at.mistake(
        Code.UNEXPECTED, "expected 'after' or 'within', found 'at'", f"write after {time}, within {time}"
    )


def foreign_bound(at: ParsePoint) -> Diagnostic | None:
    """`observe takes 2 s`, `uav0 moves at 8 m/s`, `pilot reacts within 1 s`, `agents take at most 1 s`."""
    hint = ""
    if "tick" in at.accepted:
        hint = BEGINNING.get(at.found.text, "")
    elif "flies" in at.accepted:
        hint = TAKING.get(at.found.text, "")
        if at.before.text in BEGINNING and at.found.is_name:
            return Diagnostic(
                Code.MISSPELT_KEYWORD,
                at.before.span,
                f"{at.before.shown} begins no line of timing",
                BEGINNING[at.before.text],
            )
    if hint:
        return at.mistake(Code.MISSPELT_KEYWORD, f"{at.found.shown} is not a word of the language here", hint)
    return _upper_bound_alone(at) or _restored(at)


def _upper_bound_alone(at: ParsePoint) -> Diagnostic | None:
    """`sense takes at most 5 s`."""
    if at.accepted != {"least"} or at.found.text not in ("most", "maximum", "max"):
        return None
    who = _back(at, 3)
    alone = "react within" if who.text == "agents" else "within"
    return at.mistake(
        Code.UNEXPECTED, "an upper bound alone is written with 'within'", f"write {who.text} {alone} 5 s"
    )


def _restored(at: ParsePoint) -> Diagnostic | None:
    """`lasts 25 min restored in yard`, `restored in yard within 10 min`."""
    if at.before.text == "in" and at.found.is_number and _back(at, 2).text == "restored":
        hint = f"write restored in base0 after {_duration_at(at, at.found)}"
        return at.mistake(Code.UNEXPECTED, f"expected a place, found {at.found.shown}", hint)
    if "flies" not in at.accepted:
        return None
    if at.found.text in ("in", "at") and at.before.text == "restored":
        message = "expected ',' before 'restored'"
        return Diagnostic(
            Code.MISSING_COMMA, at.before.span, message, f"write , restored in {at.following.text}"
        )
    if (
        at.found.is_number
        and at.before.text in ("within", "for", "takes")
        and _back(at, 3).text in ("in", ",")
    ):
        message = f"{at.before.shown} is not a word of the language here"
        hint = f"write after {_duration_at(at, at.found)}: it has to be there so long"
        return Diagnostic(Code.MISSPELT_KEYWORD, at.before.span, message, hint)
    return None


def bad_duration(at: ParsePoint) -> Diagnostic | None:
    """`lasts for 25 min`, `takes between 2 s and 5 s`, `after (10 min) =>`, `1 h 25 min`, `circles at 20 m`."""
    if at.before.text in UNITS and _back(at, 2).is_number:
        return _two_durations(at)
    if "NUMBER" not in at.sorts or "STRING" in at.sorts or at.found.is_number:
        return None
    if at.found.text in ("at", "=", "of") and at.following.is_number:
        return at.mistake(Code.UNEXPECTED, f"expected a number, found {at.found.shown}", "leave it out")
    if at.before.text not in _BEFORE_DURATIONS:
        return None
    hint = f"write {at.before.text} 5 min"
    if at.found.text in ("between", "from"):
        hint = f"write {at.before.text} 2 s to 5 s"
    elif at.found.text in ("up", "maximum", "max", "below", "under") and at.before.text in ("take", "takes"):
        hint = f"write {_back(at, 2).text} within 5 s"
    elif at.found.text.startswith('"') and at.following.is_number:
        hint = f"the duration comes first: within {_duration_at(at, at.following)} {at.found.text}: formula"
    return at.mistake(Code.BAD_NUMBER, f"expected a duration, found {at.found.shown}", hint)


def _two_durations(at: ParsePoint) -> Diagnostic | None:
    first = _back(at, 2)
    unit = word_at(at.prepared.text, at.found.span.end).text
    if at.found.is_number and unit in UNITS:
        seconds = float(first.text) * UNITS[at.before.text] + float(at.found.text) * UNITS[unit]
        message = f"a duration has one number, and here is a second, {at.found.shown}"
        return at.mistake(Code.UNEXPECTED, message, f"write {duration_text(seconds)}")
    if at.found.text in (",", "-", "and") and at.following.is_number and {"to", "tick"} <= at.accepted:
        hint = f"write {first.text} {at.before.text} to {_duration_at(at, at.following)}"
        return at.mistake(Code.UNEXPECTED, f"expected 'to', found {at.found.shown}", hint)
    return None


def unnamed_property(at: ParsePoint) -> Diagnostic | None:
    """`within 25 min: ended a`, `invariant: uav0 in base0`."""
    if at.sorts != {"STRING"} or at.found.text != ":" or at.following.text.startswith('"'):
        return None
    hint = 'write a name in double quotes before the colon: "name": formula'
    return at.mistake(Code.UNEXPECTED, "expected the property's name before ':'", hint)


def every_alone(at: ParsePoint) -> Diagnostic | None:
    """`oilSpill0 drifts every 20 min`: events have a least time between them, and no rhythm."""
    if at.found.text != "every" or not at.following.is_number or "at" not in at.accepted:
        return None
    hint = f"write at most every {_duration_at(at, at.following)}: the least time between two of them"
    return at.mistake(Code.UNEXPECTED, "expected 'at most' before 'every'", hint)


def two_least_times(at: ParsePoint) -> Diagnostic | None:
    """`oilSpill0 drifts at most every 10 min to 20 min`."""
    if at.found.text != "to" or at.before.text not in UNITS or _back(at, 3).text != "every":
        return None
    hint = f"leave the longer one out: at most every {_back(at, 2).text} {at.before.text}"
    return at.mistake(Code.UNEXPECTED, "'at most every' takes one time, the least between two events", hint)


def limit_of_nobody(at: ParsePoint) -> Diagnostic | None:
    """`CTR within 5 min: return`, where `within` is taken for a bigActor."""
    if at.before.text != "within" or not at.found.is_number or "within" not in at.accepted:
        return None
    hint = (
        f"write anyone within {_duration_at(at, at.found)}, or name the bigActor whose requests are limited"
    )
    return Diagnostic(Code.UNEXPECTED, at.before.span, "expected a bigActor before 'within'", hint)


def timeout_as_case(at: ParsePoint) -> Diagnostic | None:
    """`case after 10 min => ...`."""
    if at.found.text == "after" and at.before.text == "case":
        message = "'after' stands without 'case'"
        return Diagnostic(Code.UNEXPECTED, at.before.span, message, "write after 10 min => statements")
    return None


def timed_change(at: ParsePoint) -> Diagnostic | None:
    """`environment { wifi drops and returns within 5 min }`."""
    if "tick" in at.accepted or not at.accepted & {"arrives", "someone"}:
        return None
    for word, behind in ((at.before, at.found), (at.found, at.following)):
        if word.text in ("within", "after", "every", "at") and (behind.is_number or behind.text == "most"):
            message = f"{word.shown} is not a word of the language here"
            return Diagnostic(Code.MISSPELT_KEYWORD, word.span, message, _CHANGING)
    return None


def _back(at: ParsePoint, words: int) -> Word:
    """Return the word a number of words before the one found."""
    word = at.found
    for _ in range(words):
        word = word_before(at.prepared.text, word.span.start)
    return word


def _duration_at(at: ParsePoint, number: Word) -> str:
    unit = word_at(at.prepared.text, number.span.end).text
    return f"{number.text} {unit if unit in UNITS else 's'}"


TIMING_MISTAKES: Final[tuple[Callable[[ParsePoint], Diagnostic | None], ...]] = (
    foreign_unit,
    foreign_bound,
    argued_endurance,
    exact_time,
    bad_duration,
    unnamed_property,
    every_alone,
    two_least_times,
    limit_of_nobody,
    timeout_as_case,
    timed_change,
)
