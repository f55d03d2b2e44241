"""Completion: the words of the language and the names that fit at an offset."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Final

from bigactors.lsp.edited_mission import Reading
from bigactors.lsp.name_resolution import variables_of
from semantics.behaviours.commands import COMMAND_WORDS
from specs.build_behaviour import PATTERN_TYPES
from specs.build_world import CONTROL_MODES, FALLBACKS, SCHEDULERS
from specs.diagnostics import MissionError, Source
from specs.elaboration.expressions import FUNCTIONS
from specs.elaboration.names import AGENTS
from specs.elaboration.temporal import EACH, RULES
from specs.preprocessing import prepare
from specs.recovery import Expected, expected_behind
from specs.standard_signature import standard_kinds
from specs.syntax import Family, Signature, Span

_BEGUN: Final = re.compile(r"\w+(?:[:.\-]\w+)*\Z|\Z")
_WORD: Final = re.compile(r"\w+")
_ENTITIES: Final = ("entity",)
_CLAIMS: Final = ("entity", "agent")

NAMES_BEHIND: Final[Mapping[str, tuple[str, ...]]] = {
    **dict.fromkeys(("contains", "carries", "as"), ("kind",)),
    **dict.fromkeys(("linked", "leaves"), ("channel",)),
    **dict.fromkeys(("by", "hosted_at", "among", "within", "at", "directly"), _ENTITIES),
    **dict.fromkeys(("present", "known", "actually", "possibly", "surely", "in"), _ENTITIES),
    **dict.fromkeys(("to", "ended", "waiting", "pending", "bound", "live"), ("agent",)),
    **dict.fromkeys(("taken", "enabled"), ("agent", "step")),
    "observe": (*_ENTITIES, "variable"),
    "miss": ("entity", "kind"),
    "control": ("rule",),
}
"""The sorts of names that may follow a word, directly or later in its construct."""

_FIXED: Final[Mapping[str, tuple[str, ...]]] = {
    "step": (*RULES, *EACH),
    "type": PATTERN_TYPES,
    "scheduler": SCHEDULERS,
    "control": CONTROL_MODES,
    "fallback": FALLBACKS,
    "all": (AGENTS,),
}
_BEHIND: Final = {".": "field", "scheduler": "scheduler", "control": "control"}
_SORTS_BEHIND_COLON: Final = {"case": "type", "live": "fallback"}
_COLONS: Final = frozenset(["world", "rule", "case", "live", "forall", "exists"])
_AMONG: Final = ("kind", "all", "family")
"""The sorts of names that quantifiers range over."""

_VALUES: Final = ("variable", "entity", "agent")

_NEW: Final = frozenset(
    ["mission", "kind", "channel", "rule", "def", "BigActor", "let", "for", "spawn", "from", "keep"]
)
"""The words that a new name follows."""


@dataclass(frozen=True, slots=True)
class Candidate:
    """A possible completion: `sort` is the sort of a name, `word`, `function` or `command`."""

    text: str
    sort: str


@dataclass(frozen=True, slots=True)
class Candidates:
    """The possible completions at an offset, and the span of the word that they replace."""

    span: Span
    all: tuple[Candidate, ...]


def complete(reading: Reading, offset: int) -> Candidates:
    """Return the completions at an offset; none within comments and strings."""
    begun = _BEGUN.search(reading.text, max(0, offset - 100), offset)
    start = begun.start() if begun else offset
    if begun and "." in begun.group():  # in `a.x`, keep the name before the dot
        start = offset - len(begun.group().rpartition(".")[2])
    try:
        prepared = prepare(Source("", reading.text[:start]))
    except MissionError:
        return Candidates(Span(start, offset), ())
    line = reading.text.rfind("\n", 0, start) + 1
    if prepared.mistakes or any(line <= comment.span.start for comment in prepared.comments):
        return Candidates(Span(start, offset), ())
    expected = expected_behind(prepared)
    if ";" in expected.words and not reading.text[line:start].strip():  # a new line may begin a new statement
        expected = expected_behind(replace(prepared, text=prepared.text + ";"))
    end = _WORD.match(reading.text, offset)
    found = [*_names(reading, expected, start), *_words(expected)]
    return Candidates(Span(start, end.end() if end else offset), tuple(dict.fromkeys(found)))


def _words(expected: Expected) -> Iterator[Candidate]:
    for word in sorted(expected.words):
        if word.isidentifier() and len(word) > 1:
            yield Candidate(word, "command" if word in COMMAND_WORDS else "word")
    if "SELF" in expected.words:
        yield from (Candidate(name, "function") for name in FUNCTIONS)


def _names(reading: Reading, expected: Expected, offset: int) -> Iterator[Candidate]:
    words = [word for word in expected.before if word not in ("", ";")]
    for sort in _sorts(expected, words):
        if sort == "variable":
            seen = _seen_at(reading.text, offset)
            yield from (Candidate(name, sort) for name in reading.occurrences.variables(seen))
        elif sort == "field":
            yield from (Candidate(name, "variable") for name in variables_of(reading.mission, words[-2]))
        elif sort in _FIXED:
            yield from (Candidate(name, "word") for name in _FIXED[sort])
        else:
            yield from (Candidate(name, sort) for name in _declared(reading, sort))


def _seen_at(text: str, offset: int) -> int:
    """Return the offset that decides which variables are in scope: the end of the text before, its block open."""
    end = len(text[:offset].rstrip())
    return offset if text[end - 1 : end] == "}" else end


def _declared(reading: Reading, sort: str) -> tuple[str, ...]:
    if sort == "family":
        return tuple(sorted(family.name.text for family in reading.mission.each(Family)))
    sections = reading.mission.each(Signature)
    if sort == "kind" and (not sections or any(section.standard for section in sections)):
        standard = {kind.name.text for kind in standard_kinds()}
        return tuple(sorted(standard | set(reading.occurrences.names(sort))))
    return reading.occurrences.names(sort)


def _sorts(expected: Expected, words: list[str]) -> tuple[str, ...]:
    """Return the sorts of names that fit, by the words around the offset."""
    last = words[-1] if words else ""
    if not expected.sorts & {"NAME", "CHANNEL"} or last in _NEW:
        return ()
    if "SELF" in expected.words:
        command = any(word in COMMAND_WORDS for word in words[_last(words, "control") :])
        return ("variable", "agent") if last == "to" else ("variable", "entity") if command else _VALUES
    if "skip" in expected.words:  # a statement may begin
        return ("behaviour", "variable")
    if "actually" in expected.words:
        return (*_CLAIMS, "variable")
    if last == ":":
        opening = words[_opening(words)]
        return _AMONG if opening in ("forall", "exists") else (_SORTS_BEHIND_COLON.get(opening, "kind"),)
    if last in _BEHIND:
        return (_BEHIND[last],)
    if last == "of":
        return ("agent", "step") if "fairness" in words else ("kind",)
    if last == "{" and "believes" in words:
        return ("entity",)
    if "someone" in expected.words:
        return ("entity", "channel")
    for word in reversed(words):
        if word in NAMES_BEHIND:
            return NAMES_BEHIND[word]
        if word in ("{", "=>", "="):
            break
    return ()


def _last(words: list[str], word: str) -> int:
    """Return the index of a word's last occurrence, or the length of the list."""
    return len(words) - 1 - words[::-1].index(word) if word in words else len(words)


def _opening(words: list[str]) -> int:
    """Return the index of the word that gives a colon its meaning."""
    return max((place for place, word in enumerate(words) if word in _COLONS), default=0)
