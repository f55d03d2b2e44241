"""The occurrences of all rules in one state, mostly carried over from the previous state."""

from __future__ import annotations

from collections.abc import Sequence

from bigraphs.engine.contexts import Surroundings
from bigraphs.engine.draft import Draft
from bigraphs.engine.reactions import Reaction
from bigraphs.engine.search_state import Occurrence
from bigraphs.engine.state import State


class Spot:
    """A state with the occurrences of the rules that were asked for.

    What a rewrite did not touch occurs as before; so of the state before only those occurrences are dropped that
    have a touched node, and only those are searched that have one. A node is touched if its places or links
    changed; for a rule that wants it to hold certain nodes and no others, also if what is in it changed; for a rule
    with edges, also if something else on one of its links changed.

    Attributes:
        state: The state.
        found: For each rule its occurrences, if they were asked for.
        lost: The slots whose nodes are not the same ones as before the last step.
    """

    __slots__ = ("_around", "_before", "_changed", "_emptied", "_linked", "found", "lost", "state")

    def __init__(self, state: State, rules: int) -> None:
        self.state = state
        self.found: list[list[Occurrence] | None] = [None] * rules
        self._before: Sequence[list[Occurrence] | None] = self.found
        self._changed = self._emptied = self._linked = 0
        self._around: Surroundings | None = None
        self.lost = 0

    def after(self, draft: Draft) -> Spot:
        """Return the state that a rewrite of this one has made."""
        spot = Spot(draft.finish(), len(self.found))
        spot._before = self.found
        spot._changed, spot._emptied = draft.changed, draft.emptied
        spot._linked = draft.touched_by_links()
        spot.lost = draft.removed
        return spot

    def occurrences(self, reaction: Reaction) -> list[Occurrence]:
        """Return every occurrence of a rule, wherever it is, one of each that its symmetries make equal."""
        number = reaction.number
        found = self.found[number]
        if found is None:
            before = self._before[number]
            if before is None:
                fresh, found = reaction.matcher.find(self.state), []
            else:
                touched = self._touched(reaction)
                fresh = reaction.matcher.find_at(self.state, touched)
                found = [each for each in before if not each.mask & touched]
            if fresh:
                found += reaction.representatives.choose(fresh)
            self.found[number] = found
        return found

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
