"""Pacing: loops that make requests without ever waiting, so that the requests pile up; static."""

from collections.abc import Iterable

from semantics.analysis.termination import counts_up
from semantics.behaviours.program import Program
from semantics.behaviours.statements import (
    Block,
    Call,
    ControlBy,
    For,
    ForEach,
    Loop,
    Migrate,
    Observe,
    React,
    Send,
    While,
    branches,
)

REQUESTS = (Observe, ControlBy, Migrate, Send)
"""The statements that make a request and continue."""

Requests = frozenset[int]
NONE: Requests = frozenset()


def unpaced(program: Program, number: int) -> Requests:
    """Return the requests of a loop in turns without a wait; empty if the loop certainly ends."""
    match program.statements[number]:
        case Loop(body):
            return _unheard(program, body, frozenset()) or NONE
        case While(test, body) if not counts_up(program, test, body):
            return _unheard(program, body, frozenset()) or NONE
        case _:
            return NONE


def _unheard(program: Program, block: Block, calls: frozenset[str]) -> Requests | None:
    """Return the requests on paths through a block without a wait, None if there is no such path."""
    found = NONE
    for number in block:
        passed = _passed(program, number, calls)
        if passed is None:
            return None
        found |= passed
    return found


def _passed(program: Program, number: int, calls: frozenset[str]) -> Requests | None:
    statement = program.statements[number]
    match statement:
        case React() | Loop():
            return None
        case Call(behaviour):
            body = program.behaviours[behaviour].body
            return None if behaviour in calls else _unheard(program, body, calls | {behaviour})
        case For(_, _, each):
            return _passed(program, each, calls)
        case While() | ForEach():
            return _unheard(program, statement.body, calls) or NONE
    ways = branches(statement)
    if not ways:
        return frozenset({number}) if isinstance(statement, REQUESTS) else NONE
    return _union(_unheard(program, way, calls) for way in ways)


def _union(ways: Iterable[Requests | None]) -> Requests | None:
    found = [each for each in ways if each is not None]
    return NONE.union(*found) if found else None
