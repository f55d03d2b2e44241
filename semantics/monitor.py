"""The memory of the race monitor: what is changed, and by whom, of the observations that an agent still rests on.

Rules only carry along what values rest on; here it is marked what has changed in that since.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import partial

from semantics.agents import Watch, watch_cell
from semantics.cells import MONITOR, QUEUE, Cell, Changes
from semantics.configuration import Configuration, Transition
from semantics.eta import line_cell, sends_cell
from semantics.provenance import NOTHING, SLOT, Dependency, Key, Provenance, differences
from semantics.queries import Query, evaluate
from semantics.requests import CTR, FLY, SND, Request
from semantics.signature import Name
from semantics.structure import Parent, Relation

CONTROLS = frozenset({"actuate", "command", "commit"})
"""The rules by which an agent changes P. (The paper knows `actuate`; `command` takes an entity out of its place.)"""


def marked(c: Configuration, transition: Transition) -> Transition:
    """Return the transition with what it changed marked in what others rest on, where that is monitored.

    What an agent changes itself it knows: it makes nothing stale that the agent holds, nor what it sends afterwards. A
    message on its way is its receiver's, so what the sender changes after sending is another's doing.
    """
    if not c.setting.monitored or transition.label.rule not in CONTROLS:
        return transition
    after = transition.target
    slots = changed_slots(c, after)
    author = str(transition.label.agent)
    mark = partial(_mark, memo={}, answer=lambda query: slots | _changed_answers(c, after, query))
    changes: Changes = {}
    for agent in after.alpha.names():
        changes |= _mark_memory(after, agent, mark) if agent != author else {}
    for cell in _request_cells(after):
        changes |= _mark_requests(after, cell, author, mark)
    return replace(transition, target=after.with_(changes)) if changes else transition


def changed_slots(before: Configuration, after: Configuration) -> frozenset[Key]:
    """Return the slots of A(P) in which two configurations differ."""
    old, new = before.structure.physical, after.structure.physical
    keys: set[Key] = set()
    for name in before.setting.kinds:
        parents = {p.abstract_parent(name) if name in p else None for p in (old, new)}
        if len(parents) > 1:
            keys |= {(f"{SLOT}parent", name)} | {(f"{SLOT}children", place) for place in parents if place}
        if old.links(name) != new.links(name):
            keys.add((f"{SLOT}links", name))
    return frozenset(keys)


def slots_used(relations: tuple[Relation, ...], closed: tuple[Name, ...]) -> frozenset[Key]:
    """Return the slots that a redex uses."""
    kinds = ((f"{SLOT}{'parent' if isinstance(pair, Parent) else 'links'}", pair.node) for pair in relations)
    return frozenset(kinds) | {(f"{SLOT}children", node) for node in closed}


def stale_tests(request: Request, rests_on: Provenance, used: frozenset[Key]) -> tuple[Dependency, ...]:
    """Return what a control rests on that others have changed since it was observed: a test, or a relation it uses."""
    if not isinstance(request, CTR | FLY):
        return ()
    stale = (
        each
        for each in rests_on
        if each.asked is not None and (each.stale or used.intersection(each.changed))
    )
    return tuple(sorted(stale, key=repr))


def _changed_answers(before: Configuration, after: Configuration, query: Query) -> frozenset[Key]:
    views = [evaluate(query, c.structure.physical, c.alpha) for c in (before, after)]
    return differences(views[0], views[1])


Mark = Callable[[Provenance], Provenance]
Memo = dict[Query, frozenset[Key]]


def _mark(provenance: Provenance, *, memo: Memo, answer: Callable[[Query], frozenset[Key]]) -> Provenance:
    return frozenset(_mark_one(each, memo, answer) for each in provenance)


def _mark_one(each: Dependency, memo: Memo, answer: Callable[[Query], frozenset[Key]]) -> Dependency:
    if each.query not in memo:
        memo[each.query] = answer(each.query)
    changed = memo[each.query].difference(each.changed)
    return replace(each, changed=tuple(sorted(changed.union(each.changed)))) if changed else each


def _mark_memory(c: Configuration, agent: Name, mark: Mark) -> Changes:
    watch = c.alpha.watch(agent)
    if watch is None:
        return {}
    parts = (tuple(map(mark, part)) for part in (watch.code, watch.store, watch.mailbox))
    return {watch_cell(agent): Watch(*parts)}


def _request_cells(c: Configuration) -> list[Cell]:
    cells = [QUEUE, *(make(agent) for agent in c.alpha.names() for make in (line_cell, sends_cell))]
    return [cell for cell in cells if c.read(cell)]


def _mark_requests(c: Configuration, cell: Cell, author: Name, mark: Mark) -> Changes:
    kept = zip(c.read(cell), c.read((MONITOR, *cell)), strict=True)
    marked = tuple(each if _holder(request) == author else mark(each) for request, each in kept)
    return {(MONITOR, *cell): marked}


def _holder(request: Request) -> Name:
    return request.to if isinstance(request, SND) else request.agent


def monitored(c: Configuration) -> Configuration:
    """Return a configuration in which the monitor begins to remember; nothing rests on anything yet."""
    setting = c.setting.with_(monitored=True)
    cells: Changes = {}
    for agent in c.alpha.names():
        agents = c.alpha
        lengths = (len(agents.code(agent)), len(agents.store(agent)), len(agents.mailbox(agent)))
        cells[watch_cell(agent)] = Watch(*((NOTHING,) * length for length in lengths))
        lines = (line_cell(agent), sends_cell(agent), QUEUE)
        cells |= {
            (MONITOR, *cell): (NOTHING,) * len(c.read(cell)) for cell in lines if c.read(cell) is not None
        }
    return Configuration(setting, c.state.with_(cells))
