"""Indexes that exclude most of thousands of rules, for a state and after a change, as masks of rule numbers."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from typing import Final

from bigraphs.engine.reactions import CompiledReaction
from bigraphs.engine.state_arrays import GroundState, bits

_GROUP: Final = 16


class RuleIndex:
    """Patterns by the controls of their nodes; pattern `n` is bit `n` of a mask.

    `short[control][k]` is the mask of the patterns that need more than k nodes of a control. So a state needs one
    lookup per control, however many patterns there are. Controls are divided into groups: a step changes the counts of
    a few controls, and the results of the other groups stay valid.
    """

    def __init__(self, needs: Sequence[Counter[int]]) -> None:
        self.all = (1 << len(needs)) - 1
        short: dict[int, list[int]] = {}
        for number, need in enumerate(needs):
            for control, count in need.items():
                few = short.setdefault(control, [])
                few += [0] * (count - len(few))
                for fewer in range(count):
                    few[fewer] |= 1 << number
        ordered = sorted(short.items())
        self._groups = [ordered[start : start + _GROUP] for start in range(0, len(ordered), _GROUP)]
        self._group_of = {control: place // _GROUP for place, (control, _) in enumerate(ordered)}

    def possible(self, state: GroundState) -> int:
        """Return the patterns for which a state has enough nodes of every control."""
        return self.spared(self.lacking(state))

    def spared(self, lacking: Sequence[int]) -> int:
        """Return the patterns that no group of controls excludes."""
        found = 0
        for excluded in lacking:
            found |= excluded
        return self.all & ~found

    def lacking(self, state: GroundState) -> list[int]:
        """Return for each group of controls the patterns that need more nodes of one of them than the state has."""
        return [_lacking(group, state) for group in self._groups]

    def lacking_after(self, before: Sequence[int], state: GroundState, controls: Iterable[int]) -> list[int]:
        """Return the same after a step that changed the node counts of these controls."""
        found = list(before)
        for group in {self._group_of.get(control, -1) for control in controls} - {-1}:
            found[group] = _lacking(self._groups[group], state)
        return found


def _lacking(group: Sequence[tuple[int, list[int]]], state: GroundState) -> int:
    nodes, found = state.by_control, 0
    for control, few in group:
        there = nodes[control].bit_count()
        if there < len(few):
            found |= few[there]
    return found


class ReactionIndex(RuleIndex):
    """The reactions of a system, by the changes that may create or destroy an occurrence of each."""

    def __init__(self, reactions: Sequence[CompiledReaction]) -> None:
        super().__init__([reaction.controls for reaction in reactions])
        self.reactions = tuple(reactions)
        self._holding = _by_control((reaction.number, reaction.controls) for reaction in reactions)
        self._exact = _by_control((reaction.number, reaction.exact) for reaction in reactions)
        self._closed = sum(1 << reaction.number for reaction in reactions if reaction.closed)

    def concerned(
        self, before: GroundState, after: GroundState, changed: int, emptied: int, linked: int
    ) -> int:
        """Return the reactions whose occurrences may change when these slots are touched (see `Spot`)."""
        holding = self._holding
        if after.world.sharing:
            return _union(holding, _controls(before, after, changed | emptied | linked))
        found = _union(holding, _controls(before, after, changed))
        found |= _union(self._exact, _controls(before, after, emptied))
        if linked and self._closed:
            found |= _union(holding, _controls(before, after, linked)) & self._closed
        return found


def _by_control(mentions: Iterable[tuple[int, Iterable[int]]]) -> dict[int, int]:
    found: dict[int, int] = {}
    for number, controls in mentions:
        for control in controls:
            found[control] = found.get(control, 0) | 1 << number
    return found


def _controls(before: GroundState, after: GroundState, slots: int) -> set[int]:
    """Return the controls of the nodes in these slots, before and after."""
    labels = {
        each.labels[slot] for slot in bits(slots) for each in (before, after) if slot < len(each.labels)
    }
    return {after.world.control_of[label] for label in labels if label >= 0}


def _union(masks: dict[int, int], controls: Iterable[int]) -> int:
    found = 0
    for control in controls:
        found |= masks.get(control, 0)
    return found


def numbers_in(mask: int) -> Iterator[int]:
    """Yield the numbers in a mask in ascending order, without the cache of `bits`: such masks rarely recur."""
    while mask:
        low = mask & -mask
        mask ^= low
        yield low.bit_length() - 1
