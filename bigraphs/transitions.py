"""Transition systems: the results of explorations, as arrays and as graphs."""

from __future__ import annotations

from array import array
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import repeat
from typing import TYPE_CHECKING, Any, NamedTuple

from bigraphs.bigraph import Bigraph
from bigraphs.compact_lists import Column, DictionaryColumn, Texts
from bigraphs.engine.decoding import from_key, to_bigraph
from bigraphs.engine.intern_tables import InternTables
from bigraphs.system import Rule, System, SystemKind

if TYPE_CHECKING:
    import networkx as nx


class Transition(NamedTuple):
    """One transition.

    `weight` is its probability, its rate, or 1 in a BRS. `rules` holds the labels of its rules, sorted; `occurrences`
    is the number of their occurrences. `action` is its action, in an NBRS.
    """

    source: int
    target: int
    weight: float
    rules: tuple[str, ...]
    occurrences: int
    action: str | None


class TransitionKind(NamedTuple):
    """A transition without its source and target; a system has few distinct kinds."""

    weight: float
    rules: tuple[str, ...]
    occurrences: int
    action: str | None


@dataclass(frozen=True)
class TransitionSystem:
    """The reachable states, numbered from 0 in breadth-first order, and their transitions.

    Attributes:
        keys: The key of each state.
        holding: For each state the numbers of the predicates that hold in it.
        first: For each expanded state the number of its first transition; at the end the number of all transitions.
        targets: For each transition its target state.
        kinds: For each transition its other fields.
        found_from: For each state its predecessor in the search.
        reason: Why some states were not expanded; empty if all were.
    """

    system: System
    world: InternTables
    keys: Texts
    holding: DictionaryColumn[tuple[int, ...]]
    first: Column
    targets: Column
    kinds: DictionaryColumn[TransitionKind]
    found_from: Column
    occurrences: int
    seconds: float
    reason: str = ""

    def __repr__(self) -> str:
        return (
            f"<TransitionSystem states={len(self)} transitions={len(self.targets)} complete={self.complete}>"
        )

    @property
    def complete(self) -> bool:
        """Return whether every reachable state is present with all its transitions."""
        return not self.reason

    @property
    def expanded(self) -> int:
        """Return the number of expanded states, which come first; in a complete system all states."""
        return len(self.first) - 1

    @property
    def kind(self) -> SystemKind:
        """Return the kind of the system: the meaning of its weights."""
        return self.system.kind

    @cached_property
    def starts(self) -> array[int]:
        """For each transition its source state."""
        found = array("I")
        for state in range(self.expanded):
            found.extend(repeat(state, len(self.leaving(state))))
        return found

    @cached_property
    def labels(self) -> tuple[bytearray, ...]:
        """For each predicate one byte per state: 1 where it holds."""
        return tuple(self._label(predicate) for predicate in range(len(self.system.predicates)))

    def _label(self, predicate: int) -> bytearray:
        holds = [predicate in numbers for numbers in self.holding.values]
        return bytearray(holds[code] for code in self.holding.codes)

    def __len__(self) -> int:
        return len(self.keys)

    def state(self, number: int) -> Bigraph:
        """Return the bigraph of a state."""
        return to_bigraph(from_key(self.world, self.keys[number]))

    def leaving(self, state: int) -> range:
        """Return the numbers of the transitions from a state; empty if it was not expanded."""
        return range(self.first[state], self.first[state + 1]) if state < self.expanded else range(0)

    def transitions(self) -> Iterator[Transition]:
        """Yield the transitions, sorted by source."""
        return (each for state in range(self.expanded) for each in self.transitions_from(state))

    def transitions_from(self, state: int) -> Iterator[Transition]:
        """Yield the transitions from a state."""
        return (
            Transition(state, self.targets[number], *self.kinds[number]) for number in self.leaving(state)
        )

    def states_with(self, predicate: int) -> Iterator[int]:
        """Yield the numbers of the states in which a predicate holds."""
        holds = [predicate in numbers for numbers in self.holding.values]
        return (state for state, code in enumerate(self.holding.codes) if holds[code])

    def labels_of(self, state: int) -> tuple[str, ...]:
        """Return the labels of the predicates that hold in a state."""
        return tuple(self.system.predicates[number].label for number in self.holding[state])

    def path_to(self, state: int) -> list[int]:
        """Return a shortest path from the initial state to a state, both included."""
        path = [state]
        while path[-1]:
            path.append(self.found_from[path[-1]])
        return path[::-1]

    def rules_between(self, source: int, target: int) -> tuple[str, ...]:
        """Return the labels of the rules that lead from one state to another, sorted."""
        leading = (each.rules for each in self.transitions_from(source) if each.target == target)
        return tuple(sorted({rule for rules in leading for rule in rules}))

    def rules_never_used(self) -> tuple[Rule, ...]:
        """Return the ordinary rules without a transition, in source order."""
        used = {label for kind in self.kinds.values for label in kind.rules}
        ordinary = (rule for each in self.system.classes if not each.instantaneous for rule in each.rules)
        return tuple(rule for rule in ordinary if rule.label not in used)

    def beginning(self, states: int) -> TransitionSystem:
        """Return the first `states` states and the transitions between them."""
        first, targets, kinds = array("Q", (0,)), array("I"), DictionaryColumn[TransitionKind]()
        for state in range(min(states, self.expanded)):
            for number in self.leaving(state):
                if self.targets[number] < states:
                    targets.append(self.targets[number])
                    kinds.append(self.kinds[number])
            first.append(len(targets))
        return replace(
            self,
            keys=Texts(self.keys[:states]),
            holding=DictionaryColumn(self.holding[:states]),
            first=first,
            targets=targets,
            kinds=kinds,
            found_from=self.found_from[:states],
        )

    def to_networkx(self) -> nx.MultiDiGraph[int]:
        """Return a graph of states (`labels`) and transitions (`rules`, `weight`, `occurrences`, `action`)."""
        import networkx as nx  # noqa: PLC0415 - rarely needed and slow to import

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
