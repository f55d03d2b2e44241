"""Informants: the agents that may pass on their observations.

A message or a spawned agent carries its sender's provenance, if the sender had observed anything. In many missions no
sender had: agents first agree, then observe and move.
"""

from collections.abc import Iterator
from typing import NamedTuple

from semantics.analysis.overapproximation import Names
from semantics.analysis.traversal import blocks
from semantics.analysis.value_flow import ValueFlow
from semantics.behaviours.program import Program
from semantics.behaviours.statements import Block, Observe, React, Send, Spawn, Statement
from semantics.races.relevance import tells
from semantics.state.configuration import Configuration
from semantics.state.requests import OBS
from semantics.state.signature import Name


def tellers(initial: Configuration, roles: ValueFlow) -> Names:
    """Return the agents that may pass on observations, their own or received ones."""
    first = frozenset(_tellers(initial, roles, carrying=False))
    return frozenset(_tellers(initial, roles, carrying=True)) if first else first


def _tellers(initial: Configuration, roles: ValueFlow, *, carrying: bool) -> Iterator[Name]:
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
    """The effect of passing statements: whether the agent may have observed anything, and passed it on."""

    observed: bool
    told: bool


class _Lives:
    """The effect of each statement, with and without an earlier observation; a least fixpoint because of loops.

    Args:
        program: The statements.
        carrying: Whether messages may carry the observations of others.
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
        """Return the effect of a sequence of statements."""
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
        for _ in range(2):  # a loop's body runs again after its own observations
            found = [self.through(block, observed=observed) for block in blocks(self.program, statement)]
            observed |= any(each.observed for each in found)
            told |= any(each.told for each in found)
        return _Passed(observed, told)
