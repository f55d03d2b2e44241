"""All transitions of a configuration: the rules for each agent, the scheduler's choice, the environment's clauses."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cache

from semantics.behaviours.expressions import Fault
from semantics.bigactor_rules import EXTENSION, migrate, say, snd
from semantics.environment import Clause
from semantics.races.monitor import marked
from semantics.rules import RULES, TIMED_RULES, Rule, actuate, command, commit, env, sense
from semantics.state.cell_values import QUEUE
from semantics.state.configuration import Configuration, Transition
from semantics.state.setting import Control, Scheduler
from semantics.state.signature import Name

SERVING: frozenset[Rule] = frozenset({sense, actuate, command, commit, snd, migrate})
"""The rules that serve a pending request; the others are an agent's own steps."""


@cache
def rules_of(control: Control) -> tuple[Rule, ...]:
    """Return the rules of an agent under a kind of control."""
    return RULES + (TIMED_RULES if control is Control.TIMED else ()) + EXTENSION


def steps(c: Configuration, a: Name) -> Iterator[Transition | Fault]:
    """Yield an agent's transitions regardless of turns, and each fault in the place of the failed rule's transitions.

    Pending requests are served first, as in the paper's run. A failed computation disables only its own rule.
    """
    yield from served(c, a)
    yield from moves(c, a)


def served(c: Configuration, a: Name) -> Iterator[Transition]:
    """Yield the transitions that serve an agent's pending requests."""
    if c.eta.in_line(a):
        for rule in rules_of(c.setting.control):
            if rule in SERVING:
                yield from rule(c, a)


def moves(c: Configuration, a: Name) -> Iterator[Transition | Fault]:
    """Yield the transitions of an agent's own next step, and its faults."""
    for rule in rules_of(c.setting.control):
        if rule in SERVING:
            continue
        try:
            yield from rule(c, a)
        except Fault as fault:
            fault.agent = a
            yield fault


@dataclass(frozen=True, slots=True)
class Expansion:
    """All transitions and faults of one configuration.

    Attributes:
        by_agents: The transitions of agents that are in their turn.
        by_environment: The transitions of `env` and `say`.
        out_of_turn: Transitions of agents that are enabled but not in their turn (`fcfs`).
        faults: The agents' computations that fail or diverge here.
    """

    by_agents: tuple[Transition, ...]
    by_environment: tuple[Transition, ...]
    out_of_turn: tuple[Transition, ...] = ()
    faults: tuple[Fault, ...] = ()

    @property
    def transitions(self) -> tuple[Transition, ...]:
        """All transitions, once each, in one order."""
        return self.by_agents + self.by_environment

    @property
    def enabled(self) -> tuple[Transition, ...]:
        """The transitions of agents, in their turn or not."""
        return self.by_agents + self.out_of_turn


def expand(c: Configuration) -> Expansion:
    """Return all transitions and faults of a configuration: rule by rule, agent by agent, clause by clause."""
    return expand_by(c, c.alpha.names())


def expand_by(c: Configuration, agents: Iterable[Name]) -> Expansion:
    """Return the transitions and faults of some agents and of the environment."""
    by_agents = [step for a in agents for step in steps(c, a)]
    return expansion_of(c, by_agents, [t for clause in c.setting.environment for t in by_clause(c, clause)])


def by_clause(c: Configuration, clause: Clause) -> Iterator[Transition]:
    """Yield the transitions of one clause of the environment."""
    for rule in (env, say):
        for transition in rule(c, clause):
            yield remembered(c, transition)


def remembered(c: Configuration, transition: Transition) -> Transition:
    """Return the transition with the memory of flights updated, where the mission has a `timing` section."""
    if c.setting.timing is None:
        return transition
    from semantics.timing.flight_history import remembering  # noqa: PLC0415 - geometry takes its time to load

    return remembering(c, transition)


def expansion_of(
    c: Configuration, by_agents: Iterable[Transition | Fault], by_environment: Iterable[Transition]
) -> Expansion:
    """Return the rules' transitions marked for the monitor, in one order, without duplicates, and split by turn."""
    steps_found = list(by_agents)
    faults = tuple(step for step in steps_found if isinstance(step, Fault))
    found = [step for step in steps_found if not isinstance(step, Fault)]
    found.sort(key=lambda transition: transition.served is None)
    marks = (marked(c, transition) for transition in found)
    allowed = tuple(
        dict.fromkeys(marks if c.setting.timing is None else (remembered(c, each) for each in marks))
    )
    waiting: tuple[Transition, ...] = ()
    if c.setting.scheduler is Scheduler.FCFS:
        allowed, waiting = _in_turn(allowed)
    return Expansion(allowed, tuple(dict.fromkeys(by_environment)), waiting, faults)


def _in_turn(found: tuple[Transition, ...]) -> tuple[tuple[Transition, ...], tuple[Transition, ...]]:
    """Return the transitions in their turn under `fcfs` (those of the oldest enabled request), and the others."""
    turns = [turn_of(transition) for transition in found]
    first = min((turn for turn in turns if turn is not None), default=None)
    allowed = tuple(t for t, turn in zip(found, turns, strict=True) if turn in (None, first))
    return allowed, tuple(t for t, turn in zip(found, turns, strict=True) if turn not in (None, first))


def turn_of(transition: Transition) -> int | None:
    """Return the position in the `fcfs` queue of the request that a transition serves, None if it takes no turn."""
    served = transition.served
    return served.position if served is not None and served.cell == QUEUE else None


def successors(c: Configuration) -> tuple[Transition, ...]:
    """Return every transition of a configuration, without duplicates, in one order.

    Raises:
        Fault: An agent's computation fails or diverges.
    """
    expansion = expand(c)
    if expansion.faults:
        raise expansion.faults[0]
    return expansion.transitions
