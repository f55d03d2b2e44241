"""A system of bigraphs as a model: its states one by one, for anybody's search."""

from __future__ import annotations

from collections.abc import Iterator

from bigraphs.bigraph import Bigraph
from bigraphs.engine.decoding import from_key, to_bigraph
from bigraphs.engine.machine import Machine
from bigraphs.engine.occurrences import Spot
from bigraphs.engine.state_arrays import Key
from bigraphs.system import System


class SystemModel:
    """A system of bigraphs; a state is a key, the same for isomorphic bigraphs.

    Transitions to one state, by one action, are one transition, labelled with all their rules.

    Attributes:
        initial: The key of the initial state, after the instantaneous rules.
    """

    def __init__(self, system: System) -> None:
        self.machine = Machine(system)
        self.known: dict[Key, Key] = {}
        self.initial = self._key(self.machine.start()[0])

    def successors(self, state: Key) -> Iterator[tuple[str, Key]]:
        """Yield the transitions from a state."""
        merged: dict[tuple[Key, str | None], set[str]] = {}
        for step in self.machine.steps(Spot(from_key(self.machine.world, state), self.machine.index)):
            rule = step.reaction.rule
            merged.setdefault((self._key(step.target), rule.action), set()).add(rule.label)
        for (target, _), rules in merged.items():
            yield ", ".join(sorted(rules)), target

    def bigraph(self, state: Key) -> Bigraph:
        """Return the bigraph of a state."""
        return to_bigraph(from_key(self.machine.world, state))

    def _key(self, spot: Spot) -> Key:
        """Return the key by which the first of some isomorphic bigraphs was met."""
        raw = spot.state.key()
        canonical = raw if self.machine.world.plain else self.machine.labelling.canonical_of(raw)
        return self.known.setdefault(canonical, raw)
