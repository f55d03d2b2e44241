"""The occurrences of all rules in one state, mostly carried over from the previous state."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from bigraphs.engine.contexts import Surroundings
from bigraphs.engine.draft import Draft
from bigraphs.engine.reactions import Reaction
from bigraphs.engine.rule_index import ReactionIndex, numbers_in
from bigraphs.engine.search_state import Occurrence
from bigraphs.engine.state import State


class Spot:
    """A state with the occurrences of the rules that were asked for.

    What a rewrite did not touch occurs as before; so of the state before only those occurrences are dropped that
    have a touched node, and only those are searched that have one. A node is touched if its places or links
    changed; for a rule that wants it to hold certain nodes and no others, also if what is in it changed; for a rule
    with edges, also if something else on one of its links changed. An index tells which rules that is about: only
    they are asked again. All this is done when a spot is first asked or kept, since most lead to a known state.

    Attributes:
        state: The state.
        known: The mask of the rules whose occurrences are known.
        found: The occurrences of each rule that is known to have any, by its number.
        having: The mask of the rules in `found`.
        lacking: Which rules a state has too few nodes for (see `RuleIndex`), once that was asked.
        lost: The slots whose nodes are not the same ones as before the last step.
    """

    __slots__ = (
        "_around",
        "_before",
        "_changed",
        "_emptied",
        "_from",
        "_index",
        "_known_before",
        "_linked",
        "_possible",
        "found",
        "having",
        "known",
        "lacking",
        "lost",
        "state",
    )

    def __init__(self, state: State, index: ReactionIndex) -> None:
        self.state = state
        self.known = self._known_before = 0
        self.found: dict[int, list[Occurrence]] = {}
        self._before: dict[int, list[Occurrence]] = {}
        self._from: tuple[Spot, Draft] | None = None
        self.having = 0
        self._index = index
        self.lacking: list[int] | None = None
        self._possible = -1
        self._changed = self._emptied = self._linked = 0
        self._around: Surroundings | None = None
        self.lost = 0

    def after(self, draft: Draft) -> Spot:
        """Return the state that a rewrite of this one has made."""
        spot = Spot(draft.finish(), self._index)
        spot._from = self, draft
        spot.lost = draft.removed
        return spot

    def carry(self) -> None:
        """Take over the occurrences of the spot before, and let go of it."""
        if self._from is None:
            return
        before, draft = self._from
        self._from = None
        self._changed, self._emptied, self._linked = draft.changed, draft.emptied, draft.touched_by_links()
        concerned = self._index.concerned(
            before.state, self.state, self._changed, self._emptied, self._linked
        )
        self.known, self._known_before = before.known & ~concerned, before.known & concerned
        self.having = before.having & ~concerned
        if before.lacking is not None:
            self.lacking = self._index.lacking_after(before.lacking, self.state, draft.counted)
        for number, found in before.found.items():
            (self._before if concerned >> number & 1 else self.found)[number] = found

    def parts(self) -> tuple[object, ...]:
        """Return what a spot is made of, as plain values."""
        self.carry()
        touched = self._changed, self._emptied, self._linked
        return (
            self.state.parts(),
            self.known,
            self.found,
            self._known_before,
            self._before,
            touched,
            self.lost,
        )

    def remade(self, parts: tuple[Any, ...]) -> Spot:
        """Return the spot of such parts, which are of this one's system."""
        state, known, found, known_before, before, touched, lost = parts
        spot = Spot(self.state.remade(state), self._index)
        spot.known, spot.found, spot._known_before, spot._before = known, found, known_before, before
        spot.having = sum(1 << number for number in found)
        spot._changed, spot._emptied, spot._linked = touched
        spot.lost = lost
        return spot

    def askable(self) -> int:
        """Return the mask of the rules that are not known to have no occurrence."""
        if self._possible < 0:
            self.carry()
            self.lacking = self.lacking or self._index.lacking(self.state)
            self._possible = self._index.spared(self.lacking)
            self.known |= self._index.all & ~self._possible
        return self._possible & (~self.known | self.having)

    def enabled(self, rules: int) -> Iterator[tuple[Reaction, list[Occurrence]]]:
        """Yield those of the rules in a mask that may act, in order, and where they may."""
        for number in numbers_in(rules & self.askable()):
            reaction = self._index.reactions[number]
            if live := self.live(reaction):
                yield reaction, live

    def occurrences(self, reaction: Reaction) -> list[Occurrence]:
        """Return every occurrence of a rule, wherever it is, one of each that its symmetries make equal."""
        number = reaction.number
        if not self.known >> number & 1:
            self.state.world.pause()
            found = self._carried(reaction) if self._known_before >> number & 1 else self._fresh(reaction)
            self.known |= 1 << number
            if found:
                self.found[number] = sorted(found)  # so their order does not tell how they were found
                self.having |= 1 << number
        return self.found.get(number, [])

    def _fresh(self, reaction: Reaction) -> list[Occurrence]:
        found = reaction.matcher.find(self.state)
        return reaction.representatives.choose(found) if found else found

    def _carried(self, reaction: Reaction) -> list[Occurrence]:
        if reaction.matcher.unplanned():
            return self._fresh(reaction)
        touched = self._touched(reaction)
        fresh = reaction.matcher.find_at(self.state, touched)
        found = [each for each in self._before.get(reaction.number, ()) if not each.mask & touched]
        return found + reaction.representatives.choose(fresh) if fresh else found

    def live(self, reaction: Reaction) -> list[Occurrence]:
        """Return the occurrences where the rule may act and its conditions hold."""
        found = self.occurrences(reaction)
        if reaction.wide and found:
            around = self._around = self._around or Surroundings(self.state, passive=self.state.world.passive)
            found = [each for each in found if around.admits(reaction.pattern, each)]
        for condition in reaction.conditions:
            found = [each for each in found if condition.holds(self.state, each)]
        return found

    def _touched(self, reaction: Reaction) -> int:
        if self.state.world.sharing:
            return self._changed | self._emptied | self._linked
        exact = 0
        for control in reaction.exact:
            exact |= self.state.by_control[control]
        touched = self._changed | self._emptied & exact
        return touched | self._linked if reaction.closed else touched
