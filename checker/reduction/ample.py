"""Partial-order reduction: an ample set of the enabled steps of a configuration.

Independent steps of different actors are followed in one order only. docs/explanation/reduction.md explains why this is
sound, and for which properties it is refused.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from checker.reduction.actor_footprints import Acting, Actor, Actors
from checker.reduction.cycle_proviso import Parts, Paths, part_of, parts_of
from checker.reduction.preserved_runs import propositions_of, steps_of
from checker.reduction.visible_slots import Eyes
from semantics.properties.kinds import PropertyKind
from semantics.properties.property import Property
from semantics.properties.propositions import Proposition
from semantics.state.configuration import Configuration, Transition
from semantics.state.signature import Name
from semantics.successors import Expansion, by_clause
from semantics.timing.arrivals import is_unfair

Reached = Callable[[Transition], int | None]
"""Returns the number of a transition's target, None if it is new."""


class Persistent(NamedTuple):
    """A persistent set of actors, and their steps."""

    actors: frozenset[Actor]
    steps: tuple[Transition, ...]


class Followed(NamedTuple):
    """The steps to follow, the parts that they take, and the onward step; None for the latter if no step is ignored."""

    steps: tuple[Transition, ...]
    taken: Parts = frozenset()
    onward: Transition | None = None


class Ample:
    """Chooses ample sets within one mission.

    Attributes:
        forward: Whether every step of an ample set leads to a configuration of a greater number, so that each cycle has
            a configuration where all steps are followed. Formulas about runs need this.
        single: Whether an ample set has a single step. Formulas of branching time need this.
        stored: Whether the followed steps are needed after the search.
    """

    def __init__(
        self, initial: Configuration, formulas: Iterable[Proposition] = (), runs: Sequence[Property] = ()
    ) -> None:
        self.actors = Actors(initial)
        self.eyes = Eyes(initial, (*formulas, *propositions_of(runs)), steps_of(runs))
        self.forward = any(each.temporal is not None for each in runs)
        self.stored = bool(runs)
        self.single = any(each.kind is PropertyKind.CTL for each in runs)

    def choose(
        self, c: Configuration, expansion: Expansion, number: int, reached: Reached, paths: Paths
    ) -> Followed:
        """Return the steps of an ample set, of a union of several, or all.

        If every step of the sets so far leads back here, another set joins, with an actor that is ignored on the cycle.
        """
        acting, owners = self.actors.of(c), self.owners(c, expansion)
        if self.forward:
            candidates = self.candidates(expansion, acting, owners, paths.movers.get(number))
            return self.first_forward(c, expansion, candidates, number, reached)
        inside: frozenset[Actor] = frozenset()
        taken: Parts = frozenset()
        for found in self.candidates(expansion, acting, owners, paths.movers.get(number)):
            ignored = (each for each in found.actors.intersection(owners) if each not in inside)
            if all(part_of(each) in taken for each in ignored) or not self.is_ample(c, found.steps):
                continue
            inside |= found.actors
            taken |= parts_of(found.actors, acting)
            steps = tuple(
                step for step, owner in zip(expansion.transitions, owners, strict=True) if owner in inside
            )
            for step in found.steps:
                end = paths.end(reached(step))
                if end.to != number:
                    return Followed(steps, taken, step)
                taken |= end.taken
            if all(each in inside or part_of(each) in taken for each in owners):
                return Followed(steps, taken)
        return Followed(expansion.transitions)

    def first_forward(
        self,
        c: Configuration,
        expansion: Expansion,
        candidates: Iterable[Persistent],
        number: int,
        reached: Reached,
    ) -> Followed:
        """Return the steps of the first ample set of which every step leads forward, or all."""
        for found in candidates:
            small = len(found.steps) == 1 or not self.single
            if small and self.is_ample(c, found.steps):
                ends = [reached(step) for step in found.steps]
                if all(end is None or end > number for end in ends):
                    return Followed(found.steps)
        return Followed(expansion.transitions)

    def is_ample(self, c: Configuration, chosen: tuple[Transition, ...]) -> bool:
        """Return whether the steps are invisible to all properties, and one of them must be taken eventually."""
        if any(self.eyes.sees(c, each) for each in chosen):
            return False
        return any(each.label.agent is not None and not is_unfair(c, each) for each in chosen)

    def candidates(
        self,
        expansion: Expansion,
        acting: Mapping[Actor, Acting],
        owners: Sequence[Actor],
        mover: Name | None,
    ) -> Iterator[Persistent]:
        """Yield the persistent sets that omit some step, by size; those around the last mover come first."""
        found: set[frozenset[Actor]] = set()
        allowed = list(zip(expansion.transitions, owners, strict=True))
        movable = dict.fromkeys(owners[: len(expansion.by_agents)])
        for seeds in ([a for a in movable if a.owner == mover], [a for a in movable if a.owner != mover]):
            sets = [each for each in dict.fromkeys(persistent(acting, seeds)) if each not in found]
            found.update(sets)
            steps = (tuple(step for step, owner in allowed if owner in each) for each in sets)
            several = [each for each in map(Persistent, sets, steps) if len(each.steps) < len(allowed)]
            yield from sorted(several, key=lambda each: len(each.steps))

    def owners(self, c: Configuration, expansion: Expansion) -> tuple[Actor, ...]:
        """Return the actor of each transition; the first clause, if several allow it."""
        environment = c.setting.environment if expansion.by_environment else ()
        clauses = {
            step: Actor("clause", number)
            for number, clause in reversed(list(enumerate(environment)))
            for step in by_clause(c, clause)
        }
        ours = (self.actors.actor_of(step.label) for step in expansion.by_agents)
        return (*ours, *(clauses[step] for step in expansion.by_environment))


def persistent(acting: Mapping[Actor, Acting], seeds: Iterable[Actor]) -> Iterator[frozenset[Actor]]:
    """Yield for each seed the least persistent set around it: no actor outside ever disturbs its current steps."""
    for seed in seeds:
        inside = {seed}
        waiting = [seed]
        while waiting:
            actor = waiting.pop()
            joining = [other for other in acting if other not in inside and disturbed(acting, actor, other)]
            inside.update(joining)
            waiting += joining
        yield frozenset(inside)


def disturbed(acting: Mapping[Actor, Acting], actor: Actor, other: Actor) -> bool:
    """Return whether another actor may ever disturb an actor's current steps.

    A line serves the requests that already wait in it before the program's next one.
    """
    behind = actor.kind == "line" and other == Actor("program", actor.owner)
    return acting[actor].now.disturbs(acting[other].aside if behind else acting[other].ever)
