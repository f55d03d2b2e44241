"""A configuration partitioned among stations: each runs the bigActors of its hosts, and knows the hosts of the others.

The whole configuration is the union of the stations' parts and the parcels between them. It changes only by the rules
of this package: `snd`, `migrate` and `spawn` are applied at the station of the agent whose rules they are. Their effect
on an agent of another station then *leaves* in a parcel and *enters* there, which does not change the whole.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

from semantics.admission.parcel_refusals import may_be_hosted, text_objection
from semantics.analysis.value_flow import flow_of
from semantics.behaviours.process_conversion import joining
from semantics.environment import Says
from semantics.state.agents import code_cell, host_cell, mailbox_cell, store_cell
from semantics.state.cell_values import Cell, Changes
from semantics.state.configuration import Configuration, Label, Transition
from semantics.state.logical_model import links_cell, parent_cell
from semantics.state.parcels import Parcel, Running, parcel_request, requested
from semantics.state.requests import FLY
from semantics.state.signature import REGION, Name

Station = str

HERE: Cell = ("here",)
"""The cell with the station of this part; absent in a configuration that is not partitioned."""


def station_cell(host: Name) -> Cell:
    """Address the station that runs the agents of a host."""
    return ("station", host)


def sent_cell(station: Station) -> Cell:
    """Address the number of parcels that have left for a station."""
    return ("sent", station)


def took_cell(station: Station) -> Cell:
    """Address the number of parcels from a station that have entered."""
    return ("took", station)


@dataclass(frozen=True, slots=True)
class Parting:
    """The partition of a configuration, seen from one station.

    Attributes:
        here: The station of this part.
        hosts: The station of each host.
        sent: The number of parcels that had left for each other station when the run began.
        took: The number of parcels from each other station that had entered by then.
    """

    here: Station
    hosts: Mapping[Name, Station]
    sent: Mapping[Station, int]
    took: Mapping[Station, int]


@dataclass(frozen=True, slots=True)
class Passage:
    """The passage of a parcel between stations; a leaving parcel's contents are in the configuration.

    Attributes:
        agent: The agent of the parcel.
        station: Its destination, or its origin.
        number: Its number in the sequence from one station to the other.
        parcel: The entering parcel; None for a leaving one.
    """

    agent: Name
    station: Station
    number: int
    parcel: Parcel | None = None


@dataclass(frozen=True, slots=True)
class HostReport:
    """Another station's report of an agent's host."""

    agent: Name
    host: Name


@dataclass(frozen=True, slots=True)
class Belief:
    """Another station's report of its write to a slot of L.

    Attributes:
        node: The node.
        slot: `parent` or `links`.
        names: The parent, empty for a node outside L; or the links.
    """

    node: Name
    slot: str
    names: tuple[Name, ...]


Elsewhere = Passage | HostReport | Belief
"""The events that involve other stations, as steps record them."""


def parted(c: Configuration, parting: Parting) -> Configuration:
    """Return a station's part of a configuration; of agents at other stations it has only the hosts."""
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
    """Whether a configuration is one station's part of a whole."""
    return c.read(HERE) is not None


def station_of(c: Configuration, a: Name) -> Station | None:
    """Return the station that runs an agent, None if no station does."""
    station: Station | None = c.read(station_cell(c.alpha.host(a)))
    return station


def is_here(c: Configuration, a: Name) -> bool:
    """Whether an agent runs at this station; always true in a configuration that is not partitioned."""
    return not is_parted(c) or station_of(c, a) == c.read(HERE)


def parcel_of(c: Configuration, a: Name) -> Parcel | None:
    """Return this station's contents of an agent, None if empty; raises ValueError while it flies a vehicle."""
    code, store, mail = c.alpha.code(a), c.alpha.store(a), c.alpha.mailbox(a)
    host, program = c.alpha.host(a), c.setting.program
    requests = tuple(parcel_request(program, pending.request, host) for pending in c.eta.of(a))
    says = tuple(c.read(counter) for counter in _counters(c, a))
    running = Running(host, code, store, requests, says) if code or store or requests else None
    return Parcel(a, mail, running) if mail or running else None


def _counters(c: Configuration, a: Name) -> tuple[Cell, ...]:
    """Return the cells that count the remaining messages from outside to an agent; they travel with it."""
    clauses = c.setting.environment
    return tuple(each.counter for each in clauses if isinstance(each, Says) and each.agent == a)


def leave(c: Configuration, a: Name) -> Iterator[Transition]:
    """Send away an agent that runs at another station: its remaining code, mail and requests.

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
    """Take in a parcel from another station: each parcel once, and in order.

    the number-th parcel from station s has mail for a, or a itself      number − 1 parcels from s have entered
    the text can have produced it: a at a statement of it, values that fit, requests that its statements make
    ─────────────────────────────────────────────────────────────────────────────────────────  ⟨enter : a, s⟩
    ⟨α | S | η⟩  →  ⟨α[a ↦ its remaining code, mailbox(a) + mail] | S | η ∪ a's requests⟩
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
    """Return why a parcel cannot enter (its agent runs here, or the text cannot have produced it); else empty."""
    a, running = parcel.agent, parcel.running
    if running is None and a not in c.alpha:
        return f"there is no bigActor {a:.60} here"
    if running is not None:
        if a in c.alpha and is_here(c, a) and c.alpha.code(a):
            return f"{a:.60} runs here already"
        if running.host not in c.setting.kinds:
            return f"{running.host:.60} is unknown here"
        if c.read(station_cell(running.host)) != c.read(HERE):
            return f"this station does not run the bigActors on {running.host:.60}"
    return text_objection(c.setting, flow_of(c.setting), parcel)


def learn(c: Configuration, a: Name, host: Name) -> Iterator[Transition]:
    """Learn the host of an agent that runs at another station; this station knows nothing else of it.

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
    """Adopt the writes of another station's `sense`, `actuate` or `commit` to L: all stations share one L.

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
    """Return the writes of parent(node) that keep L a forest: new places and nodes on a cycle go to the region."""
    logical = c.structure.logical
    if parent is None or parent == REGION:
        return {parent_cell(node): parent}
    if logical.parent(parent) is None:
        return {parent_cell(parent): REGION, parent_cell(node): parent}
    return {parent_cell(node): REGION if node in (parent, *logical.ancestors(parent)) else parent}


PASSING: tuple[Callable[..., Iterator[Transition]], ...] = (leave, enter, learn, believe)
"""The rules between stations."""


def passing(c: Configuration, passage: Elsewhere) -> Iterator[Transition]:
    """Yield the transition of an event that involves other stations."""
    if isinstance(passage, HostReport):
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
    """Return a configuration without an agent's code, variables, mail and requests; its host stays."""
    while pending := c.eta.of(a):
        c = c.with_(c.eta.removing(pending[0]))
    return c.with_({code_cell(a): (), store_cell(a): (), mailbox_cell(a): ()})
