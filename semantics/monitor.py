"""The memory of the race monitor: what is changed, and by whom, of the observations that an agent still rests on.

Rules only carry along what values rest on; here it is marked what has changed in that since.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import cache, partial

from semantics.agents import Watch, watch_cell
from semantics.cells import MONITOR, QUEUE, Cell, Changes, merged
from semantics.configuration import Configuration, Transition
from semantics.eta import line_cell, sends_cell
from semantics.provenance import EVERYTHING, NOTHING, SLOT, Dependency, Key, Provenance, differences
from semantics.queries import Nodes, Of, Query, evaluate
from semantics.relevance import ANY, Questions, anybodys, meet, questions_of, relevant, slots_of
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
    after, author = transition.target, str(transition.label.agent)

    def marking(holder: Name) -> Changes:
        """Return the marks in the memory of one agent and in its requests; nobody's are those of the common queue."""
        answer = cache(partial(_changed, c, after))
        mine = {} if holder in (author, NOBODY) else _mark_memory(after, holder, answer)
        return mine | merged(
            _mark_requests(after, cell, author, answer) for cell in _request_cells(after, holder)
        )

    return replace(transition, target=after.with_each(after.each((NOBODY, *after.alpha.names()), marking)))


NOBODY: Name = ""
"""Whose requests are those of the queue that all agents share under `fcfs`."""


def _changed(before: Configuration, after: Configuration, query: Query, asked: Questions) -> frozenset[Key]:
    """Return which of some questions two configurations answer differently: slots of A(P), and answers to a query."""
    names = touched(before, after)
    slots = changed_slots(before, after, names, asked)
    if not meet(asked, _answers_about(query, names)):
        return slots
    old, new = (evaluate(query, c.structure.physical, c.alpha) for c in (before, after))
    return slots | relevant(differences(old, new, names if is_local(query) else None), asked)


def _answers_about(query: Query, names: tuple[Name, ...]) -> Questions:
    """Return the answers to a query that may differ where only these entities' places and links do."""
    about = names if is_local(query) and not set(names).intersection(nodes_of(query)) else (ANY,)
    answers = {(kind, name) for kind in ("in", "parent", "links") for name in about}
    return frozenset(answers | {("children", ANY), EVERYTHING})


def touched(before: Configuration, after: Configuration) -> tuple[Name, ...]:
    """Return the entities whose place or links in A(P) may have changed, sorted."""
    everyone, setting = tuple(sorted(before.setting.kinds)), before.setting
    names: set[Name] = set()
    for cell in after.state.changed(before.state):
        holds = cell[0] == "placement" and setting.signature[setting.kind(cell[-1])].holds
        if holds or cell[0] == "down":
            return everyone
        if cell[0] in ("placement", "channels"):
            names.add(cell[-1])
    return tuple(sorted(names))


def is_local(query: Query) -> bool:
    """Tell whether, as long as the places and links are the same that were swept, each answer is about one entity."""
    if not isinstance(query, Of) or query.operator not in ("CHILDREN", "LINKED_TO"):
        return False
    inner = query.of
    while isinstance(inner, Of) and inner.operator == "PARENT":
        inner = inner.of
    return isinstance(inner, Nodes)


def nodes_of(query: Query) -> tuple[Name, ...]:
    """Return the nodes that a query begins with; none for ALL."""
    while isinstance(query, Of):
        query = query.of
    return query.names if isinstance(query, Nodes) else ()


def changed_slots(
    before: Configuration, after: Configuration, names: tuple[Name, ...], asked: Questions
) -> frozenset[Key]:
    """Return which of some slots of A(P) differ in two configurations, where only these entities may."""
    old, new = before.structure.physical, after.structure.physical
    keys: set[Key] = set()
    for name in names:
        links: Key = (f"{SLOT}links", name)
        if relevant([links], asked) and old.links(name) != new.links(name):
            keys.add(links)
        if not meet(asked, frozenset({(f"{SLOT}parent", name), (f"{SLOT}children", ANY)})):
            continue
        parents = {p.abstract_parent(name) if name in p else None for p in (old, new)}
        if len(parents) > 1:
            keys |= {(f"{SLOT}parent", name)} | {(f"{SLOT}children", place) for place in parents if place}
    return relevant(keys, asked)


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


Answer = Callable[[Query, Questions], frozenset[Key]]
"""Which of some questions about an observation a transition has given another answer."""


def _mark(provenance: Provenance, asked: Questions, answer: Answer) -> Provenance:
    return frozenset(_mark_one(each, asked, answer) for each in provenance)


def _mark_one(each: Dependency, asked: Questions, answer: Answer) -> Dependency:
    if each.stale:
        return each
    if each.asked is not None:
        asked = frozenset(key for key in asked if key[0].startswith(SLOT)) | {each.asked}
    changed = answer(each.query, asked).difference(each.changed)
    return each.having(changed.union(each.changed)) if changed else each


def _mark_memory(c: Configuration, agent: Name, answer: Answer) -> Changes:
    watch = c.alpha.watch(agent)
    if watch is None or not any((*watch.code, *watch.store, *watch.mailbox)):
        return {}
    asked = questions_of(c, agent)
    parts = (
        tuple(_mark(each, asked, answer) for each in part)
        for part in (watch.code, watch.store, watch.mailbox)
    )
    return {watch_cell(agent): Watch(*parts)}


def _request_cells(c: Configuration, holder: Name) -> list[Cell]:
    cells = [QUEUE] if holder == NOBODY else [line_cell(holder), sends_cell(holder)]
    return [cell for cell in cells if c.read(cell)]


def _mark_requests(c: Configuration, cell: Cell, author: Name, answer: Answer) -> Changes:
    kept = zip(c.read(cell), c.read((MONITOR, *cell)), strict=True)
    marked = tuple(
        each if not each or _holder(request) == author else _mark(each, _asked_by(c, request), answer)
        for request, each in kept
    )
    return {(MONITOR, *cell): marked}


def _holder(request: Request) -> Name:
    return request.to if isinstance(request, SND) else request.agent


def _asked_by(c: Configuration, request: Request) -> Questions:
    """Return what may matter of what a request rests on: for a control its own redex, for a message who gets it."""
    if isinstance(request, CTR | FLY):
        return slots_of(request.reaction.redex)
    return anybodys(c) if isinstance(request, SND) else questions_of(c, request.agent)


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
