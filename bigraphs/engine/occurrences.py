"""The occurrences of all rules in one state, mostly inherited from the previous state."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from bigraphs.engine.contexts import PlaceContexts
from bigraphs.engine.mutable_state import MutableState
from bigraphs.engine.reactions import CompiledReaction
from bigraphs.engine.rule_index import ReactionIndex, numbers_in
from bigraphs.engine.search_state import PatternOccurrence
from bigraphs.engine.state_arrays import GroundState


class Spot:
    """A state with the occurrences of the rules that were requested.

    A rewrite preserves every occurrence without a touched node. So only inherited occurrences with a touched node are
    dropped, and only occurrences with a touched node are searched. A node is touched if its places or links changed.
    For a rule with nodes without sites, a node is also touched if its content changed. For a rule with edges, a node is
    also touched if the points of one of its links changed. An index finds the rules concerned; only these are searched
    again. The update happens when a spot is first queried or stored, since most spots lead to a known state.

    Attributes:
        state: The state.
        known: The mask of the rules whose occurrences are known.
        found: The occurrences of each known rule that has any, by its number.
        having: The mask of the rules in `found`.
        lacking: The rules for which the state has too few nodes (see `RuleIndex`), once computed.
        lost: The mask of the slots whose nodes did not survive the last step.
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

    def __init__(self, state: GroundState, index: ReactionIndex) -> None:
        self.state = state
        self.known = self._known_before = 0
        self.found: dict[int, list[PatternOccurrence]] = {}
        self._before: dict[int, list[PatternOccurrence]] = {}
        self._from: tuple[Spot, MutableState] | None = None
        self.having = 0
        self._index = index
        self.lacking: list[int] | None = None
        self._possible = -1
        self._changed = self._emptied = self._linked = 0
        self._around: PlaceContexts | None = None
        self.lost = 0

    def after(self, draft: MutableState) -> Spot:
        """Return the spot that a rewrite of this one leads to."""
        spot = Spot(draft.finish(), self._index)
        spot._from = self, draft
        spot.lost = draft.removed
        return spot

    def carry(self) -> None:
        """Inherit the occurrences of the previous spot, and release it."""
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
        """Return the parts of a spot, as plain values."""
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
        """Return the spot with these parts, which must belong to the same system."""
        state, known, found, known_before, before, touched, lost = parts
        spot = Spot(self.state.remade(state), self._index)
        spot.known, spot.found, spot._known_before, spot._before = known, found, known_before, before
        spot.having = sum(1 << number for number in found)
        spot._changed, spot._emptied, spot._linked = touched
        spot.lost = lost
        return spot

    def askable(self) -> int:
        """Return the mask of the rules that may have an occurrence."""
        if self._possible < 0:
            self.carry()
            self.lacking = self.lacking or self._index.lacking(self.state)
            self._possible = self._index.spared(self.lacking)
            self.known |= self._index.all & ~self._possible
        return self._possible & (~self.known | self.having)

    def enabled(self, rules: int) -> Iterator[tuple[CompiledReaction, list[PatternOccurrence]]]:
        """Yield the rules in a mask that can act, in order, each with its live occurrences."""
        for number in numbers_in(rules & self.askable()):
            reaction = self._index.reactions[number]
            if live := self.live(reaction):
                yield reaction, live

    def occurrences(self, reaction: CompiledReaction) -> list[PatternOccurrence]:
        """Return every occurrence of a rule, one representative of each set of symmetric ones."""
        number = reaction.number
        if not self.known >> number & 1:
            self.state.world.pause()
            found = self._carried(reaction) if self._known_before >> number & 1 else self._fresh(reaction)
            self.known |= 1 << number
            if found:
                self.found[number] = sorted(found)  # sorted, so the order does not depend on the search
                self.having |= 1 << number
        return self.found.get(number, [])

    def _fresh(self, reaction: CompiledReaction) -> list[PatternOccurrence]:
        found = reaction.matcher.find(self.state)
        return reaction.representatives.choose(found) if found else found

    def _carried(self, reaction: CompiledReaction) -> list[PatternOccurrence]:
        if reaction.matcher.unplanned():
            return self._fresh(reaction)
        touched = self._touched(reaction)
        fresh = reaction.matcher.find_at(self.state, touched)
        found = [each for each in self._before.get(reaction.number, ()) if not each.mask & touched]
        return found + reaction.representatives.choose(fresh) if fresh else found

    def live(self, reaction: CompiledReaction) -> list[PatternOccurrence]:
        """Return the occurrences in active places whose conditions hold."""
        found = self.occurrences(reaction)
        if reaction.wide and found:
            around = self._around = self._around or PlaceContexts(
                self.state, passive=self.state.world.passive
            )
            found = [each for each in found if around.admits(reaction.pattern, each)]
        for condition in reaction.conditions:
            found = [each for each in found if condition.holds(self.state, each)]
        return found

    def _touched(self, reaction: CompiledReaction) -> int:
        if self.state.world.sharing:
            return self._changed | self._emptied | self._linked
        exact = 0
        for control in reaction.exact:
            exact |= self.state.by_control[control]
        touched = self._changed | self._emptied & exact
        return touched | self._linked if reaction.closed else touched
