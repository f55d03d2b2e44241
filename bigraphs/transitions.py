"""Transition systems: the result of exploring a reactive system, as arrays and as a graph."""

from __future__ import annotations

from array import array
from bisect import bisect_left, bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

from bigraphs.bigraph import Bigraph
from bigraphs.engine.decoding import from_key, to_bigraph
from bigraphs.engine.state import Key
from bigraphs.engine.world import World
from bigraphs.system import System, SystemKind

if TYPE_CHECKING:
    import networkx as nx


class Transition(NamedTuple):
    """One transition.

    `weight` is the probability of it, its rate, or 1 in a BRS; `rules` are the labels of the rules that make it,
    sorted, and `occurrences` in how many ways they do. `action` is the action that it belongs to, in an NBRS.
    """

    source: int
    target: int
    weight: float
    rules: tuple[str, ...]
    occurrences: int
    action: str | None


@dataclass(frozen=True, slots=True)
class TransitionSystem:
    """The states that are reachable, numbered from 0 as they were found, breadth first, and the transitions between.

    `keys` tell the states, `labels` hold for each predicate a byte per state, `starts`, `targets` and so on an entry
    per transition, sorted by where they start; `rule_sets` are what `rules` counts in. `found_from` is for each state
    the one that it was found from. Only the first `expanded` states have their transitions; if they are not all, the
    system is not complete, and `reason` says why.
    """

    system: System
    world: World
    keys: list[Key]
    labels: tuple[bytearray, ...]
    starts: array[int]
    targets: array[int]
    weights: array[float]
    actions: array[int]
    rules: array[int]
    counts: array[int]
    rule_sets: tuple[tuple[str, ...], ...]
    found_from: array[int]
    expanded: int
    occurrences: int
    seconds: float
    reason: str = ""

    def __repr__(self) -> str:
        return (
            f"<TransitionSystem states={len(self)} transitions={len(self.targets)} complete={self.complete}>"
        )

    @property
    def complete(self) -> bool:
        """Say whether every reachable state is there, with all of its transitions."""
        return not self.reason

    @property
    def kind(self) -> SystemKind:
        """Return what the weights mean."""
        return self.system.kind

    def __len__(self) -> int:
        return len(self.keys)

    def state(self, number: int) -> Bigraph:
        """Return the bigraph of a state."""
        return to_bigraph(from_key(self.world, self.keys[number]))

    def transition(self, number: int) -> Transition:
        """Return a transition by its number."""
        action = self.actions[number]
        return Transition(
            self.starts[number],
            self.targets[number],
            self.weights[number],
            self.rule_sets[self.rules[number]],
            self.counts[number],
            None if action < 0 else self.system.actions[action].name,
        )

    def transitions(self) -> Iterator[Transition]:
        """Yield the transitions, sorted by where they start."""
        return map(self.transition, range(len(self.starts)))

    def states_with(self, predicate: int) -> Iterator[int]:
        """Yield the numbers of the states in which a predicate occurs."""
        return (number for number, holds in enumerate(self.labels[predicate]) if holds)

    def labels_of(self, state: int) -> tuple[str, ...]:
        """Return the labels of the predicates that occur in a state."""
        predicates = zip(self.system.predicates, self.labels, strict=True)
        return tuple(predicate.label for predicate, holds in predicates if holds[state])

    def path_to(self, state: int) -> list[int]:
        """Return a shortest path from the initial state to a state, both included."""
        path = [state]
        while path[-1]:
            path.append(self.found_from[path[-1]])
        return path[::-1]

    def rules_between(self, source: int, target: int) -> tuple[str, ...]:
        """Return the labels of the rules that lead from one state to another, sorted."""
        first = bisect_left(self.starts, source)
        found: set[str] = set()
        for number in range(first, bisect_right(self.starts, source)):
            if self.targets[number] == target:
                found.update(self.rule_sets[self.rules[number]])
        return tuple(sorted(found))

    def rules_never_used(self) -> tuple[str, ...]:
        """Return the labels of the ordinary rules that make no transition, in the order written."""
        used = {label for rules in self.rule_sets for label in rules}
        ordinary = (rule for each in self.system.classes if not each.instantaneous for rule in each.rules)
        return tuple(rule.label for rule in ordinary if rule.label not in used)

    def restricted(self, states: int, kept: Sequence[int]) -> TransitionSystem:
        """Return the first states, and these transitions, which lie between them."""
        return replace(
            self,
            keys=self.keys[:states],
            labels=tuple(holds[:states] for holds in self.labels),
            starts=array("I", (self.starts[each] for each in kept)),
            targets=array("I", (self.targets[each] for each in kept)),
            weights=array("d", (self.weights[each] for each in kept)),
            actions=array("i", (self.actions[each] for each in kept)),
            rules=array("I", (self.rules[each] for each in kept)),
            counts=array("I", (self.counts[each] for each in kept)),
            found_from=self.found_from[:states],
            expanded=min(self.expanded, states),
        )

    def to_networkx(self) -> nx.MultiDiGraph[int]:
        """Return a graph of states (`labels`) and transitions (`rules`, `weight`, `occurrences`, `action`)."""
        import networkx as nx  # noqa: PLC0415 - few need it, and it is slow to import

        graph: nx.MultiDiGraph[Any] = nx.MultiDiGraph()
        for state in range(len(self)):
            graph.add_node(state, labels=self.labels_of(state))
        for each in self.transitions():
            graph.add_edge(
                each.source,
                each.target,
                rules=each.rules,
                weight=each.weight,
                occurrences=each.occurrences,
                action=each.action,
            )
        return graph
