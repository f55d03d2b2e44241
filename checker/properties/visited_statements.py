"""Visited parts of a mission's text: statements, branches, and clauses of the environment.

All of them are projections of configurations: an agent's `code` cell, the inputs of its computation, and the words of
labels. The statements within one `fun` step leave no trace in a configuration, so each different moment is computed
again. A computation depends only on its agent's code, variables and host, and on its incoming values.
"""

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any, ClassVar

from checker.properties.inspections import InTime
from semantics.behaviours.computation import Passage, Process, compute, first_fitting
from semantics.behaviours.expressions import Fault
from semantics.behaviours.process_conversion import scope_of
from semantics.behaviours.statements import React, at_internal
from semantics.behaviours.values import Value
from semantics.races.provenance import NOTHING
from semantics.state.agents import Code, Store, code_cell, host_cell, mailbox_cell, store_cell
from semantics.state.configuration import Configuration
from semantics.state.eta import line_cell
from semantics.state.requests import READY
from semantics.state.setting import Setting
from semantics.state.signature import Name
from semantics.successors import Expansion

COMPUTING = frozenset({"fun", "rcv_obs", "rcv_msg", "timeout"})
"""The rules by which an agent executes statements, or takes a case."""


@dataclass(frozen=True, slots=True)
class ProgramPoint:
    """One agent before a computation, or at a react.

    Attributes:
        agent: The agent.
        host: Its host.
        code: Its remaining code.
        store: Its variables.
        heard: The observations and messages that it may receive, if it is at a react.
    """

    agent: Name
    host: Name
    code: Code
    store: Store
    heard: tuple[Value, ...] = ()


@dataclass(slots=True)
class Visited:
    """The data for coverage; as an inspection it collects them from each configuration.

    Attributes:
        codes: The remaining code of each agent.
        moments: The moments of computing or receiving agents.
        passed: The executed statements and branches that are known without a moment.
        happened: The words of the environment's events and messages.
        known: The cells of agents seen so far, so that no moment is constructed twice.
        in_time: Its view of configurations, for a mission with timing.
    """

    in_time: ClassVar[InTime] = InTime.TAKEN

    codes: dict[Name, set[Code]] = field(default_factory=dict)
    moments: set[ProgramPoint] = field(default_factory=set)
    passed: set[Passage] = field(default_factory=set)
    happened: set[str] = field(default_factory=set)
    known: set[tuple[Any, ...]] = field(default_factory=set)

    def __call__(self, _: int, c: Configuration, expansion: Expansion) -> None:
        """Record every agent's position, the computing agents, and the environment's events."""
        read = c.state.read
        for a in c.alpha.names():
            self.codes.setdefault(a, set()).add(read(code_cell(a)))
        for transition in expansion.by_agents:
            if transition.label.rule in COMPUTING and transition.label.agent is not None:
                self.meet(c, transition.label.agent)
        for fault in expansion.faults:
            self.meet(c, fault.agent)
        self.happened.update(str(transition.label.about) for transition in expansion.by_environment)

    def add(self, part: "Visited") -> None:
        """Add the data of another worker."""
        for agent, codes in part.codes.items():
            self.codes.setdefault(agent, set()).update(codes)
        self.moments |= part.moments
        self.passed |= part.passed
        self.happened |= part.happened
        self.known |= part.known

    def meet(self, c: Configuration, a: Name) -> None:
        """Record the moment of an agent, unless its cells were seen before."""
        cells = (code_cell(a), store_cell(a), mailbox_cell(a), line_cell(a), host_cell(a))
        key = (a, *map(c.state.read, cells))
        if key not in self.known:
            self.known.add(key)
            self.moments.add(moment_of(c, a))


def where_it_stands(a: Name, c: Configuration) -> tuple[Code, frozenset[Passage]] | None:
    """Return an agent's remaining code, and the statements and branches it executes in one step."""
    if a not in c.alpha:
        return None
    return c.read(code_cell(a)), frozenset(passages(c.setting, moment_of(c, a)))


def moment_of(c: Configuration, a: Name) -> ProgramPoint:
    """Return the inputs of an agent's computation; they are in that agent's cells and requests only."""
    code, heard = c.alpha.code(a), tuple[Value, ...]()
    if code and isinstance(c.setting.program.statements[code[0]], React):
        ready = (each.request for each in c.eta.ready(a))
        seen = tuple(request.observation for request in ready if isinstance(request, READY))
        heard = (*seen, *c.alpha.mailbox(a))
    return ProgramPoint(a, c.alpha.host(a), code, c.alpha.store(a), heard)


# --- executed statements and branches -------------------------------------------------------------------------


def passages(setting: Setting, moment: ProgramPoint) -> Iterator[Passage]:
    """Yield the statements that a computation executes from a moment, and the branches that it takes."""
    if not moment.code:
        return
    statement = setting.program.statements[moment.code[0]]
    if isinstance(statement, React):
        yield from ((moment.code[0], rank) for rank in _ranks(setting, moment, statement))
    elif at_internal(statement):
        process = _process(setting, moment)
        with suppress(Fault):  # a fault doesn't undo the statements before it
            for _ in compute(process):
                pass
        yield from process.passed


def _ranks(setting: Setting, moment: ProgramPoint, react: React) -> Iterator[int]:
    """Yield the ranks of the cases that take a value; that of the `after` branch if none does."""
    waits = react.after is not None
    for value in moment.heard:
        try:
            rank, _ = first_fitting(_process(setting, moment), react.cases, value, NOTHING)
        except Fault:
            waits = False
            continue
        if rank is not None:
            waits = False
            yield rank
    if waits:
        yield len(react.cases)


def _process(setting: Setting, moment: ProgramPoint) -> Process:
    store = dict(moment.store)
    scope = scope_of(setting, moment.agent, moment.host, store, dict.fromkeys(store, NOTHING))
    return Process(setting.program, moment.code, (NOTHING,) * len(moment.code), scope)
