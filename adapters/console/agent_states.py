"""The states of the bigActors, and the messages that operators may send them."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import Any, Final

from adapters.console.alerts import vanity
from adapters.console.console_view import Json
from adapters.console.facts import Facts
from adapters.console.parsing import number, text
from adapters.live.operator_commands import typed
from adapters.live.scheduling import in_turn, own_steps
from semantics.behaviours.computation import first_fitting
from semantics.behaviours.expressions import Fault
from semantics.behaviours.patterns import Anything, Elements, Exactly, Pattern
from semantics.behaviours.process_conversion import next_statement, process_of
from semantics.behaviours.statements import Case, React
from semantics.behaviours.values import show
from semantics.environment import Says
from semantics.races.provenance import NOTHING
from semantics.state.agents import written
from semantics.state.configuration import Configuration
from semantics.state.requests import SND
from semantics.state.signature import Name
from semantics.state.station_partition import is_here

MOST: Final = 1_000


def take_deadline(draft: Facts, _time: float, data: Any) -> None:
    """Take in the time until which an agent waits, or the end of its wait."""
    match data:
        case {"agent": str(name), "until": until}:
            draft.deadlines.pop(name, None)
            if (due := number(until)) is not None:
                draft.deadlines[name] = due
                draft.deadlines.bounded(MOST)


def agents(facts: Facts) -> Mapping[str, Json]:
    """Return the section `agents`."""
    if facts.standing is None:
        return {}
    known, due = _agents(facts.standing.configuration, facts.failed), facts.deadlines
    return {name: {**each, "until": due.get(name)} for name, each in known.items()}


@lru_cache(maxsize=1 << 10)
def _agents(c: Configuration, failed: frozenset[Name]) -> Mapping[str, Json]:
    asked = {each.request.agent: each.request for each in in_turn(c) if not isinstance(each.request, SND)}
    return {
        name: {
            "host": c.alpha.host(name),
            "state": "has failed" if name in failed else _state(c, name, asked.get(name)),
            "request": text(str(asked[name])) if name in asked else None,
            "awaits": _awaits(c, name),
        }
        for name in c.alpha.names()
    }


def _state(c: Configuration, name: Name, request: object) -> str:
    if not is_here(c, name):
        return "runs at another station"
    if not c.alpha.code(name) and request is None:
        return "has ended"
    try:
        goes_on = bool(own_steps(c, name))
    except Fault:
        return "has failed"
    if goes_on:
        return "goes on"
    what = " or ".join(_awaits(c, name)) if request is None else text(str(request))
    return f"waits for {what}" if what else "waits"


def _awaits(c: Configuration, name: Name) -> list[str]:
    """Return a description of each case of the agent's current `react`; empty if its next statement is another."""
    statement = next_statement(c, name) if is_here(c, name) else None
    return [text(_taken(case)) for case in statement.cases] if isinstance(statement, React) else []


def _taken(case: Case) -> str:
    """Return a description of the values that a case takes."""
    what = _ANYTHING[case.pattern.of] if isinstance(case.pattern, Anything) else _part(case.pattern)
    return what if case.guard is None else f"{what} that passes a test"


_ANYTHING: Final = {None: "anything", "message": "a message", "observation": "an observation"}


def _part(pattern: Pattern) -> str:
    match pattern:
        case Anything(variable):
            return written(variable or "_")
        case Exactly(value):
            return show(value)
        case Elements(items):
            return f"({', '.join(map(_part, items))})"


def sayings(facts: Facts) -> Mapping[str, Json]:
    """Return the section `sayings`: the messages that the mission allows to the agents of this station."""
    if facts.standing is None:
        return {}
    known = _sayings(facts.standing.configuration)
    return {key: {**each, "vain": vanity(facts, each["agent"])} for key, each in known.items()}


@lru_cache(maxsize=1 << 10)
def _sayings(c: Configuration) -> Mapping[str, Json]:
    found: dict[str, Json] = {}
    clauses = [each for each in c.setting.environment if isinstance(each, Says)]
    for clause in clauses:
        if is_here(c, clause.agent):
            key = f"{clause.agent} {show(clause.message)}"
            left = c.read(clause.counter) + found.get(key, {"left": 0})["left"]
            found[key] = {
                "agent": clause.agent,
                "message": typed(clause, clauses),
                "left": left,
                "awaited": _is_awaited(c, clause),
            }
    return found


def _is_awaited(c: Configuration, said: Says) -> bool:
    """Return whether an agent waits and would take this message now; an earlier message stays in its mailbox."""
    statement = next_statement(c, said.agent) if said.agent in c.alpha else None
    if not isinstance(statement, React):
        return False
    try:
        rank, _ = first_fitting(process_of(c, said.agent), statement.cases, said.message, NOTHING)
        return rank is not None and not own_steps(c, said.agent)
    except Fault:
        return False
