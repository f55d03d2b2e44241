"""Partial-order reduction: the ample subset of the steps that a configuration allows.

Independent steps of different actors are followed in one order only. docs/explanation/reduction.md explains why this is
sound, and for which properties it is refused.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from enum import Enum

from checker.properties.inspections import is_unfair
from checker.reduction.actors import Acting, Actor, Actors
from checker.reduction.visible import Eyes
from semantics.properties.propositions import Proposition
from semantics.state.configuration import Configuration, Transition
from semantics.successors import Expansion, by_clause

Later = Callable[[Transition], bool]
"""Whether the configuration that a transition leads to is expanded after the one that it starts from."""


class Proviso(Enum):
    """The proviso against postponing a step for ever."""

    SOME = "some"
    """One of the followed steps leads to a configuration that is expanded later: enough for safety properties."""

    ALL = "all"
    """All of them do, so every cycle has a fully expanded configuration, as LTL without next needs."""


class Ample:
    """Chooses ample sets within one mission."""

    def __init__(
        self, initial: Configuration, formulas: Iterable[Proposition] = (), proviso: Proviso = Proviso.SOME
    ) -> None:
        self.actors = Actors(initial)
        self.eyes = Eyes(initial, formulas)
        self.enough = any if proviso is Proviso.SOME else all

    def choose(self, c: Configuration, expansion: Expansion, later: Later) -> tuple[Transition, ...]:
        """Return the transitions to follow: an ample set, or all if none is known."""
        everything = expansion.transitions
        for chosen in self.candidates(c, expansion):
            if self.is_ample(c, chosen) and self.enough(map(later, chosen)):
                return chosen
        return everything

    def is_ample(self, c: Configuration, chosen: tuple[Transition, ...]) -> bool:
        """Tell whether the steps are invisible to all properties, and one of them must be taken eventually."""
        if any(self.eyes.differ(c, each.target) for each in chosen):
            return False
        return any(each.label.agent is not None and not is_unfair(c, each) for each in chosen)

    def candidates(self, c: Configuration, expansion: Expansion) -> list[tuple[Transition, ...]]:
        """Return the steps of persistent sets of actors that omit some step, the smallest first."""
        if len(expansion.transitions) < 2:
            return []
        movable = dict.fromkeys(self.actors.actor_of(each.label) for each in expansion.by_agents)
        sets = dict.fromkeys(persistent(self.actors.of(c), movable))
        found = (self.steps_of(c, expansion, actors) for actors in sets)
        return sorted((each for each in found if len(each) < len(expansion.transitions)), key=len)

    def steps_of(
        self, c: Configuration, expansion: Expansion, actors: frozenset[Actor]
    ) -> tuple[Transition, ...]:
        """Return the transitions of some actors, in the order of the expansion."""
        clauses = (c.setting.environment[int(each.owner)] for each in actors if each.kind == "clause")
        around = {step for clause in clauses for step in by_clause(c, clause)}
        ours = [step for step in expansion.by_agents if self.actors.actor_of(step.label) in actors]
        return (*ours, *(step for step in expansion.by_environment if step in around))


def persistent(acting: Mapping[Actor, Acting], seeds: Iterable[Actor]) -> Iterator[frozenset[Actor]]:
    """Yield for each seed the least set around it whose current steps no actor outside ever disturbs."""
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
    """Tell whether another actor may ever disturb an actor's current steps.

    An agent's next request is served after those that already wait in its line.
    """
    behind = actor.kind == "line" and other == Actor("program", actor.owner)
    return acting[actor].now.disturbs(acting[other].aside if behind else acting[other].ever)
