"""Informants: the agents that may pass on what they have observed.

A message or a spawned agent carries what its sender rests on, if that had observed anything by then. In many missions
nobody's does: first they agree, then they look and move.
"""

from collections.abc import Iterator
from typing import NamedTuple

from checker.reduction.bounds import Names
from checker.reduction.roles import Roles
from semantics.behaviours.program import Program
from semantics.behaviours.statements import (
    Block,
    Call,
    For,
    Loop,
    Observe,
    React,
    Send,
    Spawn,
    Statement,
    branches,
)
from semantics.races.relevance import tells
from semantics.state.configuration import Configuration
from semantics.state.requests import OBS
from semantics.state.signature import Name


def tellers(initial: Configuration, roles: Roles) -> Names:
    """Return the agents that may tell others of what they have observed, or were told of by others that had."""
    first = frozenset(_tellers(initial, roles, carrying=False))
    return frozenset(_tellers(initial, roles, carrying=True)) if first else first


def _tellers(initial: Configuration, roles: Roles, *, carrying: bool) -> Iterator[Name]:
    lives = _Lives(initial.setting.program, carrying=carrying)
    for agent in roles.agents:
        if agent not in roles.first:
            may_tell = tells(lives.program, roles[agent].statements)
        else:
            looking = any(isinstance(each.request, OBS) for each in initial.eta.of(agent))
            may_tell = lives.through(initial.alpha.code(agent), observed=looking or carrying).told
        if may_tell:
            yield agent


class _Passed(NamedTuple):
    """What is so once something was passed: whether anything may be observed, and told of once it was."""

    observed: bool
    told: bool


class _Lives:
    """What comes of each statement, begun with something observed or not; a least fixpoint, since loops lead back.

    Args:
        program: The statements.
        carrying: Whether messages may carry what others have observed.
    """

    def __init__(self, program: Program, *, carrying: bool) -> None:
        self.program = program
        self.carrying = carrying
        self.passed = [tuple(_Passed(observed, told=False) for observed in (False, True))] * len(
            program.statements
        )
        grown = True
        while grown:
            after = [
                tuple(self._pass(each, observed) for observed in (False, True)) for each in program.statements
            ]
            grown, self.passed = after != self.passed, after

    def through(self, code: Block, *, observed: bool) -> _Passed:
        """Return what may be so after some statements, one after another."""
        told = False
        for number in code:
            observed, more = self.passed[number][observed]
            told |= more
        return _Passed(observed, told)

    def _pass(self, statement: Statement, observed: bool) -> _Passed:
        match statement:
            case Observe():
                return _Passed(observed=True, told=False)
            case Send() | Spawn():
                return _Passed(observed, told=observed)
            case React() if self.carrying:
                observed = True
        told = False
        for _ in range(2):  # what is a loop begins again with what was observed in it
            found = [self.through(block, observed=observed) for block in self._blocks(statement)]
            observed |= any(each.observed for each in found)
            told |= any(each.told for each in found)
        return _Passed(observed, told)

    def _blocks(self, statement: Statement) -> tuple[Block, ...]:
        match statement:
            case Call(behaviour):
                return (self.program.behaviours[behaviour].body,)
            case Loop(body):
                return (body,)
            case For(_, _, each):
                return ((each,),)
            case _:
                return branches(statement)
