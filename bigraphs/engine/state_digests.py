"""Outlines of states that do not depend on earlier states: digests of subtrees, cached by code."""

from __future__ import annotations

from typing import TypeAlias

from bigraphs.engine.decoding import history_free
from bigraphs.engine.intern_tables import REFERENCE
from bigraphs.engine.labelling import Labelling
from bigraphs.engine.state_arrays import GroundState, bits

Outline: TypeAlias = list[list[bytes]]


class Outlines:
    """The outlines of the states of one world; they ignore the identities of edges and of shared nodes."""

    def __init__(self, labelling: Labelling) -> None:
        self.labelling = labelling
        self.world = labelling.world
        self._digests: dict[int, bytes] = {}

    def least(self, states: list[GroundState]) -> int:
        """Return the position of the least state, in an order that isomorphic states share.

        Usually the outlines decide. Otherwise the states with the least outline are often isomorphic, and any of them
        serves. In the remaining cases, slow canonical forms decide, which do not depend on earlier states.
        """
        if len(states) == 1:
            return 0
        outlines = [self.outline(state) for state in states]
        least = min(outlines)
        tied = [number for number, outline in enumerate(outlines) if outline == least]
        if len(tied) == 1 or len({states[number].key() for number in tied}) == 1:
            return tied[0]
        distinct = {self.labelling.canonical(states[number]): number for number in reversed(tied)}
        if len(distinct) == 1:
            return tied[0]
        return min(sorted(distinct.values()), key=lambda number: history_free(states[number]))

    def outline(self, state: GroundState) -> Outline:
        """Return the sorted digests of the subtrees in each region."""
        regions = range(self.world.regions)
        return [
            sorted(self._digest(state.codes[slot]) for slot in bits(state.kids[~region]))
            for region in regions
        ]

    def _digest(self, code: int) -> bytes:
        """Return the digest of a subtree; it computes the children first, without recursion."""
        rows, digests = self.world.rows, self._digests
        waiting = [] if code in digests else [code]
        while waiting:
            label, ports, kids, _ = rows[waiting[-1]]
            missing = [kid for kid in kids if kid not in digests]
            if missing:
                waiting += missing
            else:
                digests[waiting.pop()] = self._of(label, ports, [digests[kid] for kid in kids])
        return digests[code]

    def _of(self, label: int, ports: tuple[int, ...], inside: list[bytes]) -> bytes:
        from hashlib import blake2b  # noqa: PLC0415 - few systems compare outlines, and the import is slow

        if label == REFERENCE:
            return b""
        world = self.world
        control = world.signature.controls[world.control_of[label]].name
        links = [world.names[link] if link < len(world.names) else "" for link in ports]
        return blake2b(
            repr((control, world.name_of[label], links, sorted(inside))).encode(), digest_size=16
        ).digest()
