"""Conversion between the agents of configurations and processes: starting a computation, and writing its result."""

from semantics.behaviours.computation import Process
from semantics.behaviours.expressions import EvaluationScope
from semantics.behaviours.program import Program
from semantics.behaviours.statements import React, Statement
from semantics.behaviours.values import Value
from semantics.races.provenance import NOTHING, Provenance, held
from semantics.races.relevance import HOSTED, communicated_variables, heirs, uses_host
from semantics.state.agents import (
    AgentProvenance,
    Code,
    Store,
    code_cell,
    host_cell,
    mailbox_cell,
    store_cell,
    watch_cell,
)
from semantics.state.cell_values import AGENTS, Changes
from semantics.state.configuration import Configuration
from semantics.state.eta import line_cell, sends_cell
from semantics.state.setting import Scheduler, Setting
from semantics.state.signature import Name


def next_statement(c: Configuration, a: Name) -> Statement | None:
    """Return the next statement of an agent, None if it has ended."""
    code = c.alpha.code(a)
    return c.setting.program.statements[code[0]] if code else None


def waits(code: Code | None, program: Program) -> bool:
    """Whether code is at a `react`; a question about a cell."""
    return bool(code) and isinstance(program.statements[code[0]], React)  # type: ignore[index]  # not None


def process_of(c: Configuration, a: Name) -> Process:
    """Return an agent as a process."""
    agents, watch = c.alpha, c.alpha.watch(a)
    code, store = agents.code(a), agents.store(a)
    rests_on = watch.store if watch else (NOTHING,) * len(store)
    kept = {name: each for (name, _), each in zip(store, rests_on, strict=True)}
    scope = scope_of(c.setting, a, agents.host(a), dict(store), kept)
    scope.placed = watch.host if watch else NOTHING
    process = Process(c.setting.program, code, watch.code if watch else (NOTHING,) * len(code), scope)
    process.begun = frozenset(watch.begun if watch else ())
    return process


def continuing(c: Configuration, process: Process) -> Changes:
    """Return the writes of α[a ↦ a']: the code after the jumps before it, and the variables that it may read."""
    process.unroll()
    a = process.scope.agent
    store, rests_on = _variables(process)
    changes: Changes = {code_cell(a): process.code, store_cell(a): store}
    watch = c.alpha.watch(a)
    if watch is not None:
        changes[watch_cell(a)] = _watch(process, rests_on, watch.mailbox)
    return changes


def _variables(process: Process) -> tuple[Store, tuple[Provenance, ...]]:
    """Return the variables with their provenance; without `computed` for variables that are never passed on."""
    store, rests_on = process.variables()
    told = communicated_variables(process.program, process.code)
    kept = zip(store, rests_on, strict=True)
    return store, tuple(each if name in told else _untold(each) for (name, _), each in kept)


def _watch(
    process: Process, store: tuple[Provenance, ...], mailbox: tuple[Provenance, ...] = ()
) -> AgentProvenance:
    code, variables = (tuple(_held(process, each) for each in part) for part in (process.rests_on, store))
    begun = tuple(sorted(process.begun))
    return AgentProvenance(code, variables, mailbox, placed(process, process.scope.placed), begun)


def _held(process: Process, provenance: Provenance) -> Provenance:
    """Return a provenance as the computing agent holds it."""
    return held(provenance, process.scope.agent, heirs(process.program, process.code))


def placed(process: Process, provenance: Provenance) -> Provenance:
    """Return the provenance of the choice of an agent's host; empty if its code never uses the host."""
    tested = frozenset(each for each in provenance if each.asked is not None)
    if not tested or not uses_host(process.program, process.code):
        return NOTHING
    told = HOSTED in communicated_variables(process.program, process.code)
    return _held(process, tested if told else _untold(tested))


def _untold(provenance: Provenance) -> Provenance:
    return frozenset(each.deciding() for each in provenance)


def starting(setting: Setting, a: Name, host: Name, process: Process) -> Changes:
    """Return the cells of a new agent, except the list of agents."""
    process.unroll()
    store, rests_on = _variables(process)
    lines = [line_cell(a)]
    lines += [sends_cell(a)] if setting.scheduler is Scheduler.PROGRAM_ORDER else []
    changes: Changes = {
        host_cell(a): host,
        code_cell(a): process.code,
        store_cell(a): store,
        mailbox_cell(a): (),
    }
    changes |= dict.fromkeys(lines, ())
    if setting.monitored:
        changes |= {watch_cell(a): _watch(process, rests_on)} | {("watch", *cell): () for cell in lines}
    return changes


def new_process(setting: Setting, a: Name, host: Name, code: tuple[int, ...]) -> Process:
    """Return a process that has not begun."""
    return Process(setting.program, code, (NOTHING,) * len(code), scope_of(setting, a, host, {}, {}))


def scope_of(
    setting: Setting, a: Name, host: Name, store: dict[str, Value], rests_on: dict[str, Provenance]
) -> EvaluationScope:
    """Return the scope of an agent in a mission."""
    return EvaluationScope(a, host, store, rests_on, setting.kinds, setting.program.kept.get(a, {}))


def joining(c: Configuration, a: Name) -> Changes:
    """Return the writes of α + a."""
    return {AGENTS: tuple(sorted({*c.alpha.names(), a}))}


def resting_on(process: Process, *parts: Provenance) -> Provenance:
    """Return the provenance of a request: that of its statement, and of its arguments."""
    return _held(process, process.rests_on[0].union(*parts))
