"""The footprint of each step: the processes whose course it may change, and the columns that it touches, for the loops.

A process is an agent, a clause or a vehicle with an endurance. Its columns are those that decide its steps, clocks and
deadlines: the columns on its paths through their trees.
"""

# mypy: disable-error-code="return-value, assignment, arg-type, no-any-return"
# (numba infers the types of compiled functions; mypy takes its integers for Python's)

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.compiled.jit_decorators import inner
from checker.engines.fast.compiled.table import Words
from checker.engines.fast.model.decision_leaves import FIRST, LEAF, PARTS, PARTS_END, STEP
from checker.engines.fast.model.learned_model import LearnedModel, walk
from checker.engines.zones.location_views import AGENTS, LearnedClocks, LocationView

State = NDArray[np.int64]


class LearnedFootprints(NamedTuple):
    """The columns of learned paths and transitions, as sets of `words` words.

    Attributes:
        words, agents, clauses, processes: The words of a set of columns, and the numbers of processes.
        reads: For each leaf the columns on its path.
        writes, copies: For each transition the columns that it writes, and those that it copies.
        writing: For each tree whether some transition of it writes.
        touched, wrote: For each process the columns that it has touched, and those that it has written.
        here: For each process its columns in the row that is left.
        found: The footprint of a step: the set of processes, then that of columns; scratch space.
        written, now: The columns that it writes, and those of a process after it; scratch space.
        begun: The number of the first edge in `fresh`.
        fresh: The footprints of new edges.
    """

    words: int
    agents: int
    clauses: int
    processes: int
    reads: Words
    writes: Words
    copies: Words
    writing: NDArray[np.int8]
    touched: Words
    wrote: Words
    here: Words
    found: Words
    written: Words
    now: Words
    begun: int
    fresh: Words


_ONE = np.uint64(1)


@inner(cache=True)
def unite(into: Words, at: int, more: Words, begin: int, words: int) -> None:
    """Add a set to another one."""
    for k in range(words):
        into[at + k] |= more[begin + k]


@inner(cache=True)
def add_columns(
    t: LearnedClocks, p: LearnedFootprints, v: LocationView, process: int, into: Words, at: int
) -> None:
    """Add the columns of a process in a row."""
    vehicles, agents = np.int64(len(t.vehicles)), v.counts[AGENTS]
    if process >= p.agents + p.clauses:
        unite(into, at, p.reads, p.words * v.answers[process - p.agents - p.clauses], p.words)
        return
    actor = np.int64(process)
    if process >= p.agents:
        actor += agents - p.agents
    while True:
        unite(into, at, p.reads, p.words * v.leaves[actor], p.words)
        unite(into, at, p.reads, p.words * v.answers[vehicles + actor], p.words)
        actor += p.agents
        if process >= p.agents or actor >= agents:
            break


@inner(cache=True)
def look_round(t: LearnedClocks, p: LearnedFootprints, v: LocationView) -> None:
    """Note the columns of all processes in a row."""
    p.here[:] = np.uint64(0)
    for process in range(p.processes):
        add_columns(t, p, v, process, p.here, p.words * process)
        unite(p.touched, p.words * process, p.here, p.words * process, p.words)


@inner(cache=True)
def note_footprint(
    m: LearnedModel, t: LearnedClocks, p: LearnedFootprints, a: LocationView, b: LocationView, actor: int, step: int,
    source: Words, at: int, state: State,
) -> None:  # fmt: skip
    """Note the footprint of an actor's step from one row to another in `found`."""
    whole, columns, agents = p.words, len(p.found) - p.words, a.counts[AGENTS]
    process = actor % p.agents if actor < agents else actor - agents + p.agents
    p.found[:], p.written[:] = np.uint64(0), np.uint64(0)
    unite(p.found, columns, p.reads, whole * a.leaves[actor], whole)
    unite(p.found, columns, p.reads, whole * a.answers[len(t.vehicles) + actor], whole)
    unite(p.found, columns, p.copies, whole * step, whole)
    unite(p.written, 0, p.writes, whole * step, whole)
    for part in range(m.steps[STEP * step + PARTS], m.steps[STEP * step + PARTS_END]):
        if p.writing[m.part[part]]:
            leaf = -np.int64(walk(source, at, m.root[m.part[part]], m.nodes, m.next, state)) - 1
            unite(p.found, columns, p.reads, whole * leaf, whole)
            unite(p.written, 0, p.writes, whole * m.leaves[LEAF * leaf + FIRST], whole)
    unite(p.found, columns, p.written, 0, whole)
    unite(p.touched, whole * process, p.found, columns, whole)
    unite(p.wrote, whole * process, p.written, 0, whole)
    for other in range(p.processes):
        meets = other == process
        for k in range(whole):
            meets = meets or p.here[whole * other + k] & p.written[k] != 0
        if meets:
            p.found[other >> 6] |= _ONE << np.uint64(other & 63)
            p.now[:] = np.uint64(0)
            add_columns(t, p, b, other, p.now, 0)
            for k in range(whole):
                p.found[columns + k] |= p.here[whole * other + k] ^ p.now[k]


@inner(cache=True)
def put_footprints(p: LearnedFootprints, begin: int, end: int) -> bool:
    """Give new edges the noted footprint; False without room."""
    size = len(p.found)
    if (end - p.begun) * size > len(p.fresh):
        return False
    for edge in range(begin, end):
        for k in range(size):
            p.fresh[(edge - p.begun) * size + k] = p.found[k]
    return True
