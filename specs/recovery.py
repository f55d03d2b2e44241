"""Error recovery: skip only the item with the mistake, and parse on behind it.

The language consists of lists: declarations, entries of a section, statements, cases. After a mistake, the parser
returns to the innermost open list, drops the unreadable item, and resumes at the next item or at the list's end. If
the braces of a declaration do not match, the list of a word is unknown. Then the parser closes all open lists and
resumes at the next declaration.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cache
from typing import Final

from lark import Token, Tree, UnexpectedInput
from lark.parsers.lalr_analysis import Shift

from specs.building import BuildingMistake, Child, span_of
from specs.diagnostics import Diagnostic
from specs.grammar import SECTIONS, ParserRun, may_follow, spellings, start, terminal, terminals
from specs.parse_error import LINE_NUMBERS, Word, offset_of, word_at, words_from
from specs.preprocessing import Prepared
from specs.syntax import Mission
from specs.syntax.nodes import Span

MOST_MISTAKES: Final = 50
"""The number of mistakes after which the rest of the file is skipped."""

_NAMES: Final = frozenset({"NAME", "CHANNEL", "DROPPING"})
SECTION: Final = re.compile(
    rf"^[ \t]*(?P<word>(?:{'|'.join(sorted(SECTIONS))})\b)(?=\s*[\w{{])", re.MULTILINE
)


@dataclass(frozen=True, slots=True)
class Recovered:
    """The readable parts of a mission, and its mistakes.

    Attributes:
        mission: The tree of the readable parts.
        mistakes: The mistakes in the rest, by position.
        unread: The spans of the items with mistakes.
    """

    mission: Mission
    mistakes: tuple[Diagnostic, ...]
    unread: tuple[Span, ...]


def recover(prepared: Prepared) -> Recovered:
    """Return the readable parts of a prepared text, and its mistakes."""
    reading = _Reading(prepared)
    mission = reading.read()
    mistakes = sorted(reading.mistakes, key=lambda item: item.span)
    return Recovered(mission, tuple(mistakes), tuple(reading.unread))


@dataclass(frozen=True, slots=True)
class Expected:
    """The words that may follow a text.

    Attributes:
        words: The words and signs of the language in their spelling.
        sorts: The grammar's names of everything that may follow.
        before: The words on the parser's stack, outermost first; an empty word stands for a whole construct.
    """

    words: frozenset[str]
    sorts: frozenset[str]
    before: tuple[str, ...]


def expected_behind(prepared: Prepared) -> Expected:
    """Return the words that may follow a prepared text, which may be the beginning of a longer one."""
    reading = _Reading(prepared)
    while not reading.feed(reading.rest()):
        pass
    sorts = frozenset(reading.run.accepts())
    words = frozenset(word for sort in sorts if (word := spellings().get(sort)))
    before = (str(value) if isinstance(value, Token) else "" for value in reading.stacks.values)
    return Expected(words, sorts, tuple(before))


class _Reading:
    """A parse and its mistakes.

    Attributes:
        sections: The offsets of declarations, found by words that begin no other line.
        missing: The number of braces closed by recovery that the text leaves open or closes later.
        resumed: The offset at which the parse last resumed.
    """

    def __init__(self, prepared: Prepared) -> None:
        self.prepared = prepared
        self.text = prepared.text
        self.run = start(prepared.text)
        self.stacks = _Stacks(self.run)
        self.mistakes = dict.fromkeys(prepared.mistakes)
        self.unread: list[Span] = []
        self.sections = [found.start("word") for found in SECTION.finditer(prepared.text)]
        self.missing = 0
        self.resumed = -1

    def read(self) -> Mission:
        """Parse the text with its end."""
        while not (self.feed(self.rest()) and self.feed([Token("$END", "")])):
            pass
        mission: Mission = self.stacks.values[-1]
        return mission

    def rest(self) -> Iterator[Token]:
        """Yield the words that are not parsed yet; their classification depends on the words before."""
        words: Iterator[Token] = self.run.lexer_thread.lex(self.run.parser_state)
        return words

    def feed(self, words: Iterable[Token]) -> bool:
        """Parse words, and return whether all fit; at the first that does not, recover."""
        at = len(self.text)
        try:
            for word in words:
                at = len(self.text) if word.start_pos is None else word.start_pos
                self.run.feed_token(word)
        except BuildingMistake as mistake:
            from specs.autopilot_words import sent_to_a_point  # noqa: PLC0415 - most texts have no mistake

            self.go_on(sent_to_a_point(mistake.diagnostic, self.text), at)
        except UnexpectedInput as stopped:
            from specs.syntax_errors import explain_syntax_error  # noqa: PLC0415 - most texts have no mistake

            found = explain_syntax_error(stopped, self.run, self.prepared)
            self.go_on(found, offset_of(stopped, self.prepared))
        else:
            return True
        return False

    def go_on(self, found: Diagnostic, at: int) -> None:
        """Record a mistake and resume behind its item; `at` is the offset at which the parse stopped."""
        begin = self.item_start(at)
        surplus = self.missing and self.text[at : at + 1] == "}" and not self.stacks.open_braces()
        if len(self.mistakes) + 1 < MOST_MISTAKES:
            self.resumed = self.next_item(at)
        else:
            self.resumed = len(self.text)
        if self.resumed == len(self.text):
            self.close_lists(self.resumed)
        self.run.lexer_thread.state.line_ctr.char_pos = self.resumed
        known = [*self.unread, *(mistake.span for mistake in self.prepared.mistakes)]
        if surplus:
            self.missing -= 1
        elif not (self.numbered(found) or any(begin <= span.start < self.resumed for span in known)):
            self.mistakes.setdefault(found)  # one mistake an item
        self.unread.append(Span(begin, self.resumed))
        if self.prepared.unmatched and found == self.prepared.unmatched[1]:
            self.prepared = replace(self.prepared, unmatched=None)

    def numbered(self, found: Diagnostic) -> bool:
        """Return whether a line number is wrong only because an earlier one is."""
        return found.hint == LINE_NUMBERS and any(known.hint == LINE_NUMBERS for known in self.mistakes)

    def item_start(self, at: int) -> int:
        """Complete the current item if it can end; return the start of the item with the mistake.

        An item that is itself the mistake is not on the stacks any more. A mistake in the line of a complete item is
        part of that item: `kind UAV drivn`, `uav0: UAV point (37, -8)`.
        """
        before, item = self.stacks.items()
        after = max(item.end, self.resumed)
        between = self.text[after:at]
        if self.stacks.complete_item() and (between.strip() or "\n" in between):
            return after + len(between) - len(between.lstrip())
        line = self.text[self.text.rfind("\n", 0, item.start) + 1 : item.start].rstrip()
        return item.start if line[-1:] in ("", ";", "{") else max(before.start, self.resumed)

    def next_item(self, at: int) -> int:
        """Return to a list, and return the start of its next item, or its end."""
        depth, balanced = self.stacks.back_to_list(), self.is_balanced(at)
        behind = word_at(self.text, at).span.end if at <= self.resumed else at  # never parse an item twice
        for word in words_from(self.text, behind):
            place = word.span.start
            if self.is_section(place) and (self.stacks.open_braces() or self.stacks.accepts(word.text)):
                self.close_lists(place)
                return place
            if word.text == "{":
                depth += 1
            elif word.text == "}" and depth:
                depth -= 1
            elif balanced and not depth and self.is_boundary(word):
                return place
            elif balanced and word.text == "}" and self.stacks.open_braces():
                depth = self.stacks.leave_list() - 1
        return len(self.text)

    def is_boundary(self, word: Word) -> bool:
        """Return whether an item of the list begins at a word that is the first of its line, or the list ends there.

        The kind of a property, also a misspelt one, only stands at the property's beginning.
        """
        from specs.common_mistakes import begins_property  # noqa: PLC0415 - most texts have no mistake
        from specs.distance_mistakes import begins_distance  # noqa: PLC0415 - most texts have no mistake

        line = self.text[self.text.rfind("\n", 0, word.span.start) + 1 : word.span.start]
        kind = begins_property(word.text, first=not line.strip()) and not begins_distance(self.text, word)
        if self.stacks.accepts("invariant") and kind:
            return True
        return (word.text in ";}" or line.rstrip()[-1:] in ("", ";")) and self.stacks.accepts(word.text)

    def close_lists(self, place: int) -> None:
        """Close all lists that are open before an offset, except the list of declarations."""
        end = len(self.text[:place].rstrip())
        self.stacks.complete_item()
        self.stacks.back_to_list()
        while self.stacks.open_braces():
            if self.stacks.accepts("}"):
                self.stacks.feed("}", end)
                self.missing += 1
                self.stacks.complete_item()
            else:
                self.stacks.leave_list()

    def is_section(self, place: int) -> bool:
        """Return whether a declaration begins at an offset."""
        number = bisect_right(self.sections, place)
        return number > 0 and self.sections[number - 1] == place

    def is_balanced(self, at: int) -> bool:
        """Return whether the braces of the declaration around an offset match."""
        number = bisect_right(self.sections, at)
        first = self.sections[number - 1] if number else 0
        last = self.sections[number] if number < len(self.sections) else len(self.text)
        depth = 0
        for word in words_from(self.text[first:last], 0):
            depth += (word.text == "{") - (word.text == "}")
            if depth < 0:
                return False
        return not depth


class _Stacks:
    """The stacks of lark's parser: states, and the values between them.

    A state that can shift `;` or `case` is a list of the language: every list has items of one or the other sort.
    """

    def __init__(self, run: ParserRun) -> None:
        self.run = run
        self.states = run.parser_state.state_stack
        self.values = run.parser_state.value_stack

    def _list(self) -> int:
        """Return the index of the innermost list among the states; lists that have ended don't count."""
        table = self.run.parser_state.parse_conf.states
        ended = 0
        for place in range(len(self.states) - 1, 0, -1):
            if not ended and any(table[self.states[place]].get(name, _NONE)[0] is Shift for name in _items()):
                return place
            ended = max(0, ended - _braces(self.values[place - 1 : place]))
        return 0

    def open_braces(self) -> int:
        """Return the number of open braces around the innermost list."""
        return _braces(self.values[: self._list()])

    def items(self) -> tuple[Span, Span]:
        """Return the spans of the last complete item and of the current one; between two items, the last one twice."""
        place = self._list()
        before = _last_item(self.values[place - 1]) if place else Span(0, 0)
        begun = self.values[place:]
        return before, _last_item(begun[0]).to(_last_item(begun[-1])) if begun else before

    def back_to_list(self) -> int:
        """Drop the current item's values; return the number of open braces among them."""
        place = self._list()
        dropped = _braces(self.values[place:])
        del self.states[place + 1 :], self.values[place:]
        return dropped

    def leave_list(self) -> int:
        """Drop the innermost list and the item around it; return the number of open braces in that item."""
        del self.states[-1:], self.values[-1:]
        return self.back_to_list() + 1

    def complete_item(self) -> bool:
        """End the current item if it may end here; return whether it may."""
        if not self.accepts(";"):
            return False
        self.feed(";", 0)  # its position is never used
        self.back_to_list()
        return True

    def accepts(self, word: str) -> bool:
        """Return whether a word may come next."""
        name = terminals().get(word)
        sorts = _NAMES if name is None and word[:1].isalpha() else [name or word]
        return any(may_follow(self.run, sort) for sort in sorts)

    def feed(self, sign: str, place: int) -> None:
        """Parse a sign that the text lacks, at an offset."""
        token = Token(terminal(sign), sign, start_pos=place, end_pos=place)
        try:
            self.run.feed_token(token)
        except BuildingMistake:
            self.back_to_list()


_NONE: Final = (None, None)


@cache
def _items() -> tuple[str, str]:
    return terminal(";"), terminal("case")


def _braces(values: list[Child]) -> int:
    return sum((value == "{") - (value == "}") for value in values if isinstance(value, Token))


def _last_item(value: Child) -> Span:
    """Return the span of a value; of a list, the span of its last item."""
    while isinstance(value, Tree):
        value = next((item for item in reversed(value.children) if item != ";"), value.children[-1])
    return span_of(value)
