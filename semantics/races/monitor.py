"""The race monitor's memory: the parts of an agent's observations that others have changed, and the authors.

The rules only propagate provenance; this module marks the changes in it.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import cache, partial
from typing import NamedTuple

from semantics.analysis.termination import begun_loops
from semantics.behaviours.observations import QueryOperator, QueryStep, Steps
from semantics.behaviours.queries import answers, denoted
from semantics.races.provenance import (
    ANY,
    EVERYTHING,
    MEMBERS,
    NOTHING,
    SIZE,
    SLOT,
    Dependency,
    Key,
    Provenance,
    differences,
    is_slot,
)
from semantics.races.relevance import (
    HEARD,
    HOSTED,
    Names,
    Questions,
    anybodys,
    communicated_variables,
    heirs,
    meet,
    possible_receivers,
    questions_of,
    relevant,
    slots_of,
)
from semantics.state.agents import AgentProvenance, watch_cell
from semantics.state.cell_values import MONITOR, QUEUE, Cell, Changes, merged
from semantics.state.configuration import Configuration, Transition
from semantics.state.eta import line_cell, sends_cell
from semantics.state.relations import Parent, Relation
from semantics.state.requests import CTR, FLY, MGR, SND, Request
from semantics.state.signature import Name

CONTROLS = frozenset({"actuate", "command", "commit"})
"""The rules by which an agent changes P. (The paper has `actuate`; `command` takes an entity out of its place.)"""


def marked(c: Configuration, transition: Transition) -> Transition:
    """Return the transition with its changes marked in the provenance of all agents, if the race monitor is on.

    An agent knows its own changes, so they make none of its own actions stale. They are remembered for values that it
    may pass on, since a receiver does not know them. A message in transit belongs to its receiver, so later changes by
    the sender count as another agent's.
    """
    if not c.setting.monitored or transition.label.rule not in CONTROLS:
        return transition
    after, author = transition.target, str(transition.label.agent)

    def marking(holder: Name) -> Changes:
        """Return the marks in one agent's memory and requests; `NOBODY` stands for the shared queue."""
        again = cache(partial(asked_again, c, after))
        memory = {} if holder == NOBODY else _mark_memory(after, holder, author, again)
        return memory | merged(
            _mark_requests(after, cell, author, again) for cell in _request_cells(after, holder)
        )

    return replace(transition, target=after.with_each(after.each((NOBODY, *after.alpha.names()), marking)))


NOBODY: Name = ""
"""The holder of the queue that all agents share under `fcfs`."""


class Again(NamedTuple):
    """The result of asking again.

    Attributes:
        changed: The keys with a new answer: slots of A(P), and answers to a query.
        steps: The steps of the query, resolved anew where a denoted set has changed.
    """

    changed: frozenset[Key]
    steps: Steps


def asked_again(before: Configuration, after: Configuration, steps: Steps, asked: Questions) -> Again:
    """Ask again, after a transition, the slots and answers of a query."""
    names = touched(before, after)
    slots = changed_slots(before, after, names, asked)
    if not _may_change(before, after, steps):
        return Again(slots, steps)
    anew = resolved_anew(before, after, steps, names)
    is_local = anew == steps and not _turns_on(steps, names)
    if not meet(asked, _answers_about(names if is_local else (ANY,))):
        return Again(slots, anew)
    old = answers(steps, before.structure.physical, before.alpha)
    new = answers(anew, after.structure.physical, after.alpha)
    return Again(slots | relevant(differences(old, new, names if is_local else None), asked), anew)


def _may_change(before: Configuration, after: Configuration, steps: Steps) -> bool:
    """Whether a control has changed what a query looks at: places, or links."""
    changed = {cell[0] for cell in after.state.changed(before.state)}
    operators = {step.operator for step in steps}
    looks_at_places = not operators.isdisjoint({"ALL", QueryOperator.PARENT, QueryOperator.CHILDREN})
    looks_at_links = not operators.isdisjoint({"ALL", QueryOperator.LINKED_TO})
    return ("placement" in changed and looks_at_places) or ("channels" in changed and looks_at_links)


def resolved_anew(
    before: Configuration, after: Configuration, steps: Steps, names: tuple[Name, ...]
) -> Steps:
    """Return the steps of a query, resolved anew behind the first whose denotation these entities have changed.

    A migration of the holder since the `sense` does not matter: each step stores the nodes that it was applied to.
    """
    anew = steps[:1]
    for step in steps[1:]:
        passed = steps[: len(anew)]
        if anew == passed and _denotes_the_same(before, after, passed, names):
            anew += (step,)
        else:
            anew += (QueryStep(step.operator, denoted(anew, after.structure.physical, after.alpha)),)
    return anew


def _denotes_the_same(
    before: Configuration, after: Configuration, steps: Steps, names: tuple[Name, ...]
) -> bool:
    if steps[-1].operator in ("", "ALL") or (
        steps[-1].operator == QueryOperator.PARENT and not _turns_on(steps, names)
    ):
        return True
    old, new = (denoted(steps, c.structure.physical, c.alpha) for c in (before, after))
    return old == new


def _turns_on(steps: Steps, names: tuple[Name, ...]) -> bool:
    """Whether the query's answers about other entities may depend on the places and links of these."""
    return any(
        step.operator not in ("", QueryOperator.CHILDREN, QueryOperator.HOSTED_AT)
        and set(names).intersection(step.names)
        for step in steps
    )


def _answers_about(names: tuple[Name, ...]) -> Questions:
    """Return the answers of a query that may change if only its facts about these entities change."""
    answers_to = {(kind, name) for kind in ("in", "parent", "links") for name in names}
    return frozenset(answers_to | {("children", ANY), MEMBERS, SIZE, EVERYTHING})


def touched(before: Configuration, after: Configuration) -> tuple[Name, ...]:
    """Return the entities whose parent or links in A(P) a control may have changed, sorted; it drops no channel."""
    everyone, setting = tuple(sorted(before.setting.kinds)), before.setting
    names: set[Name] = set()
    for cell in after.state.changed(before.state):
        holds = cell[0] == "placement" and setting.signature[setting.kind(cell[-1])].holds
        if holds:
            return everyone
        if cell[0] in ("placement", "channels"):
            names.add(cell[-1])
    return tuple(sorted(names))


def changed_slots(
    before: Configuration, after: Configuration, names: tuple[Name, ...], asked: Questions
) -> frozenset[Key]:
    """Return those of some slots of A(P) that a control has changed; only slots of these entities can differ.

    A control neither adds nor removes entities, and drops no channel. So links differ only with the channels of their
    own entities.
    """
    old, new = before.structure.physical, after.structure.physical
    relinked = {cell[-1] for cell in after.state.changed(before.state) if cell[0] == "channels"}
    keys: set[Key] = set()
    for name in names:
        links: Key = (f"{SLOT}links", name)
        if name in relinked and relevant([links], asked) and old.links(name) != new.links(name):
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
    """Return the stale dependencies of a control: others have changed a tested answer, or a relation that it uses."""
    if not isinstance(request, CTR | FLY):
        return ()
    stale = (
        each
        for each in rests_on
        if each.asked is not None and (each.stale or used.intersection(key for key, _ in each.changed))
    )
    return tuple(sorted(stale, key=repr))


Asking = Callable[[Steps, Questions], Again]
"""Asks some questions about an observation again, after a transition."""


class Marker(NamedTuple):
    """Marks the changes of one control in the provenance of one agent.

    Attributes:
        author: The agent of the control.
        holder: The agent that holds the provenance.
        heirs: The agents that may come to hold it too.
        asked: The questions that may matter.
        again: The function that asks them again.
    """

    author: Name
    holder: Name
    heirs: Names
    asked: Questions
    again: Asking

    def mark(self, provenance: Provenance) -> Provenance:
        """Return the holder's provenance with the changes marked."""
        return frozenset(each if self._is_idle(each) else self._mark(each) for each in provenance)

    def _is_idle(self, each: Dependency) -> bool:
        return each.stale or (self.author == self.holder and not each.computed)

    def _mark(self, each: Dependency) -> Dependency:
        """Return one dependency with the changes marked; the holder's own control does not change the query's steps."""
        asked = self.asked if each.asked is None else frozenset(filter(is_slot, self.asked)) | {each.asked}
        changed, anew = self.again(each.steps, asked)
        steps = each.steps if self.author == self.holder else anew
        if not changed and steps == each.steps:
            return each
        marks = {*each.changed, *((key, self.author) for key in changed)}
        return replace(each, steps=steps).having(marks).held(self.holder, self.heirs)


def _mark_memory(c: Configuration, holder: Name, author: Name, again: Asking) -> Changes:
    watch = c.alpha.watch(holder)
    if watch is None or not any((*watch.code, *watch.store, *watch.mailbox, watch.host)):
        return {}
    to = heirs(c.setting.program, c.alpha.code(holder))
    mark = Marker(author, holder, to, questions_of(c, holder), again).mark
    mailbox_too = holder != author or _passes_on(c, holder, HEARD)
    mailbox = tuple(map(mark, watch.mailbox)) if mailbox_too else watch.mailbox
    code, store = (tuple(map(mark, part)) for part in (watch.code, watch.store))
    return {
        watch_cell(holder): replace(watch, code=code, store=store, mailbox=mailbox, host=mark(watch.host))
    }


def _passes_on(c: Configuration, agent: Name, what: Name) -> bool:
    """Whether an agent may pass on the messages that it receives (`HEARD`), or its host (`HOSTED`)."""
    return what in communicated_variables(c.setting.program, c.alpha.code(agent))


def _request_cells(c: Configuration, holder: Name) -> list[Cell]:
    cells = [QUEUE] if holder == NOBODY else [line_cell(holder), sends_cell(holder)]
    return [cell for cell in cells if c.read(cell)]


def _mark_requests(c: Configuration, cell: Cell, author: Name, again: Asking) -> Changes:
    kept = zip(c.read(cell), c.read((MONITOR, *cell)), strict=True)
    return {(MONITOR, *cell): tuple(_mark_request(c, *each, author, again) for each in kept)}


def _mark_request(
    c: Configuration, request: Request, rests_on: Provenance, author: Name, again: Asking
) -> Provenance:
    holder, becomes = _holder(request), HOSTED if isinstance(request, MGR) else HEARD
    if not rests_on or (holder == author and not _passes_on(c, author, becomes)):
        return rests_on
    return Marker(author, holder, _heirs_of(c, request), _asked_by(c, request), again).mark(rests_on)


def _holder(request: Request) -> Name:
    return request.to if isinstance(request, SND) else request.agent


def _asked_by(c: Configuration, request: Request) -> Questions:
    """Return the questions that may matter to a request: for a control its redex, for a message those of any agent."""
    if isinstance(request, CTR | FLY):
        return slots_of(request.reaction.redex)
    return anybodys(c) if isinstance(request, SND) else questions_of(c, request.agent)


def _heirs_of(c: Configuration, request: Request) -> Names:
    """Return the later holders of a request's provenance: none for a control, all possible receivers for a message."""
    program = c.setting.program
    if isinstance(request, CTR | FLY):
        return frozenset()
    return (
        possible_receivers(program)
        if isinstance(request, SND)
        else heirs(program, c.alpha.code(request.agent))
    )


def monitored(c: Configuration) -> Configuration:
    """Return the configuration with the monitor on; all provenance is still empty."""
    setting = c.setting.with_(monitored=True)
    cells: Changes = {}
    for agent in c.alpha.names():
        agents = c.alpha
        lengths = (len(agents.code(agent)), len(agents.store(agent)), len(agents.mailbox(agent)))
        code, store, mailbox = ((NOTHING,) * length for length in lengths)
        begun = begun_loops(setting.program, agents.code(agent))
        cells[watch_cell(agent)] = AgentProvenance(code, store, mailbox, begun=begun)
        lines = (line_cell(agent), sends_cell(agent), QUEUE)
        cells |= {
            (MONITOR, *cell): (NOTHING,) * len(c.read(cell)) for cell in lines if c.read(cell) is not None
        }
    return Configuration(setting, c.state.with_(cells))
