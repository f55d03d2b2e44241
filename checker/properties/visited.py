"""Visited parts of a mission's text: statements, branches not taken, and clauses of the environment.

All of it are projections of configurations: an agent's `code` cell, the cells that its computation depends on, and the
words of labels. What one `fun` passes over leaves no trace in a configuration, so that each different moment is
computed once more: a computation depends on nothing but its agent's code, variables and host, and what it hears.
"""

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any, ClassVar

from checker.properties.inspections import InTime
from semantics.behaviours.computation import Passage, Process, compute, first_fitting
from semantics.behaviours.expressions import Fault
from semantics.behaviours.statements import React, at_internal
from semantics.behaviours.stepping import scope_of
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
"""The rules in which an agent passes over statements, or takes a case."""


@dataclass(frozen=True, slots=True)
class Moment:
    """One agent about to compute, or at a react.

    Attributes:
        agent: Who.
        host: Where it is hosted.
        code: What is left of it to run.
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
    """What coverage is computed from; as an inspection it gathers it from each configuration.

    Attributes:
        codes: What was left of each agent to run.
        moments: In which it computed or received something.
        passed: What computations passed over, as far as it is known without their moments.
        happened: The words of what the environment did and said.
        known: The cells of agents that were met, so that no moment is made twice.
        in_time: What it is shown where a mission says how long things take.
    """

    in_time: ClassVar[InTime] = InTime.TAKEN

    codes: dict[Name, set[Code]] = field(default_factory=dict)
    moments: set[Moment] = field(default_factory=set)
    passed: set[Passage] = field(default_factory=set)
    happened: set[str] = field(default_factory=set)
    known: set[tuple[Any, ...]] = field(default_factory=set)

    def __call__(self, _: int, c: Configuration, expansion: Expansion) -> None:
        """Look at where every agent stands, at who computes, and at what the environment does."""
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
        """Add what was gathered elsewhere."""
        for agent, codes in part.codes.items():
            self.codes.setdefault(agent, set()).update(codes)
        self.moments |= part.moments
        self.passed |= part.passed
        self.happened |= part.happened
        self.known |= part.known

    def meet(self, c: Configuration, a: Name) -> None:
        """Note a moment of an agent, unless its cells were met before."""
        cells = (code_cell(a), store_cell(a), mailbox_cell(a), line_cell(a), host_cell(a))
        key = (a, *map(c.state.read, cells))
        if key not in self.known:
            self.known.add(key)
            self.moments.add(moment_of(c, a))


def where_it_stands(a: Name, c: Configuration) -> tuple[Code, frozenset[Passage]] | None:
    """Return what is left of an agent to run, and what its computation passes over in one step."""
    if a not in c.alpha:
        return None
    return c.read(code_cell(a)), frozenset(passages(c.setting, moment_of(c, a)))


def moment_of(c: Configuration, a: Name) -> Moment:
    """Return what an agent's computation depends on; it reads no cells but that agent's and its requests."""
    code, heard = c.alpha.code(a), tuple[Value, ...]()
    if code and isinstance(c.setting.program.statements[code[0]], React):
        ready = (each.request for each in c.eta.ready(a))
        seen = tuple(request.observation for request in ready if isinstance(request, READY))
        heard = (*seen, *c.alpha.mailbox(a))
    return Moment(a, c.alpha.host(a), code, c.alpha.store(a), heard)


# --- what was passed ------------------------------------------------------------------------------------------


def passages(setting: Setting, moment: Moment) -> Iterator[Passage]:
    """Yield the statements that a computation steps over from a moment, and the branches that it takes."""
    if not moment.code:
        return
    statement = setting.program.statements[moment.code[0]]
    if isinstance(statement, React):
        yield from ((moment.code[0], rank) for rank in _ranks(setting, moment, statement))
    elif at_internal(statement):
        process = _process(setting, moment)
        with suppress(Fault):  # what was passed before it was passed all the same
            for _ in compute(process):
                pass
        yield from process.passed


def _ranks(setting: Setting, moment: Moment, react: React) -> Iterator[int]:
    """Yield the ranks of the cases that take something; that of the `after` branch if none takes anything."""
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


def _process(setting: Setting, moment: Moment) -> Process:
    store = dict(moment.store)
    scope = scope_of(setting, moment.agent, moment.host, store, dict.fromkeys(store, NOTHING))
    return Process(setting.program, moment.code, (NOTHING,) * len(moment.code), scope)
