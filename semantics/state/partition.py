"""A configuration partitioned among stations: each runs its hosts' bigActors, and knows where the others are.

The whole is what the stations have together, and what is on its way between them. It moves by the rules of this
package alone: `snd`, `migrate` and `spawn` are taken where the agent runs whose rules they are. What they put into an
agent that runs elsewhere then *leaves* in a parcel, and *enters* there: which changes nothing of the whole.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

from semantics.admission.objections import may_be_hosted, text_objection
from semantics.admission.value_flow import flow_of
from semantics.behaviours.stepping import joining
from semantics.environment import Says
from semantics.state.agents import code_cell, host_cell, mailbox_cell, store_cell
from semantics.state.cells import Cell, Changes
from semantics.state.configuration import Configuration, Label, Transition
from semantics.state.logical_model import links_cell, parent_cell
from semantics.state.parcels import Parcel, Running, asked, requested
from semantics.state.requests import FLY
from semantics.state.signature import REGION, Name

Station = str

HERE: Cell = ("here",)
"""Which station a part is of; nothing in a configuration that is not parted."""


def station_cell(host: Name) -> Cell:
    """Address the station that runs the agents of a host."""
    return ("station", host)


def sent_cell(station: Station) -> Cell:
    """Address how many parcels have left for a station."""
    return ("sent", station)


def took_cell(station: Station) -> Cell:
    """Address how many parcels of a station have entered."""
    return ("took", station)


@dataclass(frozen=True, slots=True)
class Parting:
    """How a configuration is parted.

    Attributes:
        here: Whose part is meant.
        hosts: For each node whose agents a station runs, that station.
        sent: How many parcels had left for each other station when the run began.
        took: How many of theirs had entered.
    """

    here: Station
    hosts: Mapping[Name, Station]
    sent: Mapping[Station, int]
    took: Mapping[Station, int]


@dataclass(frozen=True, slots=True)
class Passage:
    """A parcel that passes between stations, as a step says it; where it leaves, the configuration says what is in it.

    Attributes:
        agent: Whose it is.
        station: Where it goes to or comes from.
        number: The how-many-th it is, between these two.
        parcel: What enters; None for what leaves.
    """

    agent: Name
    station: Station
    number: int
    parcel: Parcel | None = None


@dataclass(frozen=True, slots=True)
class Whereabouts:
    """Another station says where an agent is hosted."""

    agent: Name
    host: Name


@dataclass(frozen=True, slots=True)
class Belief:
    """Another station says what it has written into a slot of L.

    Attributes:
        node: Of which node.
        slot: `parent` or `links`.
        names: Where it is, nothing for what L does not have; or on which links.
    """

    node: Name
    slot: str
    names: tuple[Name, ...]


Elsewhere = Passage | Whereabouts | Belief
"""What other stations have a part in: as steps say it."""


def parted(c: Configuration, parting: Parting) -> Configuration:
    """Return a station's part of a configuration: of agents that run elsewhere it has their hosts alone."""
    cells: Changes = {HERE: parting.here}
    for host, station in parting.hosts.items():
        cells[station_cell(host)] = station
    for station in sorted(set(parting.hosts.values()) - {parting.here}):
        cells[sent_cell(station)] = parting.sent.get(station, 0)
        cells[took_cell(station)] = parting.took.get(station, 0)
    part = c.with_(cells)
    for agent in part.alpha.names():
        if not is_here(part, agent):
            part = _without(part, agent)
    return part


def is_parted(c: Configuration) -> bool:
    """Tell whether a configuration is one station's part of a whole."""
    return c.read(HERE) is not None


def station_of(c: Configuration, a: Name) -> Station | None:
    """Return the station that runs an agent, None where no station does."""
    station: Station | None = c.read(station_cell(c.alpha.host(a)))
    return station


def is_here(c: Configuration, a: Name) -> bool:
    """Tell whether an agent runs here: everywhere, where nothing is parted."""
    return not is_parted(c) or station_of(c, a) == c.read(HERE)


def parcel_of(c: Configuration, a: Name) -> Parcel | None:
    """Return what is here of an agent, None where nothing is; raises ValueError while it flies a vehicle."""
    code, store, mail = c.alpha.code(a), c.alpha.store(a), c.alpha.mailbox(a)
    host, program = c.alpha.host(a), c.setting.program
    requests = tuple(asked(program, pending.request, host) for pending in c.eta.of(a))
    says = tuple(c.read(counter) for counter in _counters(c, a))
    running = Running(host, code, store, requests, says) if code or store or requests else None
    return Parcel(a, mail, running) if mail or running else None


def _counters(c: Configuration, a: Name) -> tuple[Cell, ...]:
    """Return the cells that count how often something may still be said to an agent: they go where it goes."""
    clauses = c.setting.environment
    return tuple(each.counter for each in clauses if isinstance(each, Says) and each.agent == a)


def leave(c: Configuration, a: Name) -> Iterator[Transition]:
    """Send away what this station has of an agent that runs elsewhere.

    a runs at station s, which is not this one      something of a is here      no FLY of a ∈ η
    ─────────────────────────────────────────────────────────────────────────────────────────  ⟨leave : a, s⟩
    ⟨α | S | η⟩  →  ⟨α[a ↦ nothing left to run, no mail] | S | η − a's requests⟩
    """
    if a not in c.alpha or is_here(c, a):  # premise: a runs elsewhere
        return
    station = station_of(c, a)
    if any(isinstance(each.request, FLY) for each in c.eta.of(a)):  # premise: no FLY of a ∈ η
        return
    if station is None or parcel_of(c, a) is None:  # premises: at a station, something is here
        return
    count: int = c.read(sent_cell(station))
    yield Transition(Label("leave", a, station), _without(c, a).with_({sent_cell(station): count + 1}))


def enter(c: Configuration, station: Station, number: int, parcel: Parcel) -> Iterator[Transition]:
    """Take in what another station had of an agent: each parcel once, and in order.

    the number-th parcel from station s has mail for a, or a itself      number − 1 parcels from s have entered
    the text can have produced it: a at a statement of it, values that fit, requests that its statements make
    ─────────────────────────────────────────────────────────────────────────────────────────  ⟨enter : a, s⟩
    ⟨α | S | η⟩  →  ⟨α[a ↦ what is left to run, mailbox(a) + mail] | S | η ∪ a's requests⟩
    """
    a, running = parcel.agent, parcel.running
    if c.read(took_cell(station)) != number - 1:  # premise: the parcels before it have entered, and it hasn't
        return
    if objection(c, parcel):  # premise: the text can have produced it
        return
    entered = c.with_({took_cell(station): number})
    if running is not None:
        entered = _arriving(entered, a, running)
    for message in parcel.mail:
        entered = entered.with_(entered.alpha.posting(a, message))
    yield Transition(Label("enter", a, station), entered)


def objection(c: Configuration, parcel: Parcel) -> str:
    """Say why a parcel cannot enter: its agent runs here already, or this mission's text cannot have produced it."""
    a, running = parcel.agent, parcel.running
    if running is None and a not in c.alpha:
        return f"there is no bigActor {a:.60} here"
    if running is not None:
        if a in c.alpha and is_here(c, a) and c.alpha.code(a):
            return f"{a:.60} runs here already"
        if running.host not in c.setting.kinds:
            return f"nothing is known of {running.host:.60} here"
        if c.read(station_cell(running.host)) != c.read(HERE):
            return f"this station does not run what is hosted at {running.host:.60}"
    return text_objection(c.setting, flow_of(c.setting), parcel)


def learn(c: Configuration, a: Name, host: Name) -> Iterator[Transition]:
    """Learn the host of an agent that runs at another station; nothing else of it is known here.

    a does not run here      h is a host of another station, where the text may host a, and not the one known
    ─────────────────────────────────────────────────────────────────────────────────────────  ⟨learn : a, h⟩
    ⟨α | S | η⟩  →  ⟨α[host(a) ↦ h] | S | η⟩
    """
    station = c.read(station_cell(host))
    if station is None or station == c.read(HERE):  # premise: h is a host of another station
        return
    if not may_be_hosted(c.setting, flow_of(c.setting), a, host):  # premise: the text may host a there
        return
    if a not in c.alpha:
        yield Transition(Label("learn", a, host), _arriving(c, a, Running(host)))
    elif not is_here(c, a) and c.alpha.host(a) != host:  # premises: a does not run here, h is news
        yield Transition(Label("learn", a, host), c.with_(c.alpha.hosting(a, host)))


def believe(c: Configuration, belief: Belief) -> Iterator[Transition]:
    """Take over what another station's `sense`, `actuate` or `commit` has written into L: all stations share one L.

    station s has written parent(n) = p, or links(n) = l      L stays a forest
    ──────────────────────────────────────────────────────────────────────────  ⟨believe : n⟩
    ⟨α | (L, P, β, γ) | η⟩  →  ⟨α | (L[n ↦ p], P, β, γ) | η⟩, or L[n ↦ l]
    """
    node = belief.node
    if node not in c.setting.kinds:
        return
    cells: Changes = {links_cell(node): tuple(sorted(set(belief.names)))}
    if belief.slot == "parent":
        parent = belief.names[0] if belief.names else None
        if parent is not None and parent not in {*c.setting.kinds, REGION}:
            return
        cells = _nesting(c, node, parent)
    target = c.with_(cells)
    if target != c:
        yield Transition(Label("believe", None, node), target)


def _nesting(c: Configuration, node: Name, parent: Name | None) -> Changes:
    """Write parent(node), and keep L a forest: what would be in itself is in the region, and so is what is new."""
    logical = c.structure.logical
    if parent is None or parent == REGION:
        return {parent_cell(node): parent}
    if logical.parent(parent) is None:
        return {parent_cell(parent): REGION, parent_cell(node): parent}
    return {parent_cell(node): REGION if node in (parent, *logical.ancestors(parent)) else parent}


PASSING: tuple[Callable[..., Iterator[Transition]], ...] = (leave, enter, learn, believe)
"""What happens between stations."""


def passing(c: Configuration, passage: Elsewhere) -> Iterator[Transition]:
    """Yield the step that something of other stations is."""
    if isinstance(passage, Whereabouts):
        yield from learn(c, passage.agent, passage.host)
        return
    if isinstance(passage, Belief):
        yield from believe(c, passage)
        return
    if passage.parcel is not None:
        yield from enter(c, passage.station, passage.number, passage.parcel)
        return
    for transition in leave(c, passage.agent):
        if transition.target.read(sent_cell(passage.station)) == passage.number:
            yield transition


def _arriving(c: Configuration, a: Name, running: Running) -> Configuration:
    known = a in c.alpha
    cells: Changes = {host_cell(a): running.host, code_cell(a): running.code, store_cell(a): running.store}
    cells |= dict(zip(_counters(c, a), running.says, strict=False))
    there = c.with_(cells if known else {**joining(c, a), **cells, mailbox_cell(a): ()})
    for request in running.requests:
        there = there.with_(there.eta.adding(requested(c.setting.program, request)))
    return there


def _without(c: Configuration, a: Name) -> Configuration:
    """Return a configuration in which nothing of an agent is left but its host."""
    while pending := c.eta.of(a):
        c = c.with_(c.eta.removing(pending[0]))
    return c.with_({code_cell(a): (), store_cell(a): (), mailbox_cell(a): ()})
