"""All transitions of a configuration: the rules, agent by agent, the scheduler's turn, and the environment's clauses."""

from collections.abc import Iterator

from semantics.configuration import Configuration, Transition
from semantics.expressions import Fault
from semantics.extension import EXTENSION, say
from semantics.monitor import marked
from semantics.rules import RULES, TIMED_RULES, Rule, env
from semantics.setting import Control, Scheduler
from semantics.signature import Name

TURNLESS = frozenset({"commit"})
"""What is served under `fcfs` without waiting for a turn."""


def rules_of(control: Control) -> tuple[Rule, ...]:
    """Return the rules of an agent under a kind of control."""
    return RULES + (TIMED_RULES if control is Control.TIMED else ()) + EXTENSION


def steps(c: Configuration, a: Name) -> Iterator[Transition]:
    """Yield what one agent's rules allow, apart from others' turns.

    Raises:
        Fault: The agent's computation fails or diverges.
    """
    try:
        for rule in rules_of(c.setting.control):
            yield from rule(c, a)
    except Fault as fault:
        fault.agent = a
        raise


def agent_transitions(c: Configuration) -> tuple[Transition, ...]:
    """Return the transitions of all agents: under `fcfs` the enabled request asked first is served, no other.

    Raises:
        Fault: An agent's computation fails or diverges.
    """
    allowed = [transition for a in c.alpha.names() for transition in steps(c, a)]
    if c.setting.scheduler is Scheduler.FCFS:
        allowed = _in_turn(allowed)
    return tuple(dict.fromkeys(marked(c, transition) for transition in allowed))


def _in_turn(allowed: list[Transition]) -> list[Transition]:
    turns = [t.served.position for t in allowed if t.served is not None and t.label.rule not in TURNLESS]
    return [
        t for t in allowed if t.served is None or t.label.rule in TURNLESS or t.served.position == min(turns)
    ]


def environment_transitions(c: Configuration) -> tuple[Transition, ...]:
    """Return what `env` and `say` allow."""
    clauses = c.setting.environment
    return tuple(dict.fromkeys(t for clause in clauses for rule in (env, say) for t in rule(c, clause)))


def successors(c: Configuration) -> tuple[Transition, ...]:
    """Return every transition of a configuration, once each, in one order.

    Raises:
        Fault: An agent's computation fails or diverges.
    """
    return agent_transitions(c) + environment_transitions(c)
