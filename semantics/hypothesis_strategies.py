"""Hypothesis strategies for the values of `semantics/`, for tests of missions and rules.

Worlds are near Portimão. Places are boxes in slots of a 3 × 3 grid of the surrounding place (or the water), so they
nest or are disjoint by construction. Movers are points or small polygons in slots of their own. Examples shrink towards
few entities, L = A(P), few statements and short runs. The module needs the extra `strategies`.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from typing import TypeVar

from hypothesis import reject
from hypothesis import strategies as st

from physical import Band, box, circle, point
from semantics.behaviours.commands import COMMANDS, Command
from semantics.behaviours.expressions import Fault
from semantics.behaviours.observations import All, Nodes, Of, Query, QueryOperator
from semantics.behaviours.program import Program
from semantics.behaviours.reaction_rules import (
    LinkTerm,
    LinkVariable,
    NodeTerm,
    NodeVariable,
    Pattern,
    PlaceTerm,
    PlaceVariable,
    Reaction,
)
from semantics.behaviours.values import Text
from semantics.environment import Appears, Clause, Drifts, Drops, Leaves, Says, Vanishes
from semantics.properties.kinds import RequestMode, asked_by
from semantics.properties.property import Property
from semantics.random_programs import AGENT_NAMES, random_program
from semantics.state.agents import Code
from semantics.state.configuration import Configuration, Transition
from semantics.state.initial import Beliefs, initial
from semantics.state.physical_model import Carried, Placed, Placement
from semantics.state.setting import Control, Scheduler, Setting
from semantics.state.signature import REGION, Kind, Name, Signature
from semantics.state.structure import Structure
from semantics.successors import successors

CHANNELS = ("control:g0", "control:g1", "wifi")
KIND_OF = {"place": "Place", "uav": "Uav", "vessel": "Vessel", "crate": "Crate", "station": "Station"}


T = TypeVar("T")


def pick(draw: st.DrawFn, options: Sequence[T]) -> T:
    """Draw one of some options, shrinking to the first; cheaper than building a strategy for each draw."""
    return options[draw(_numbers(len(options)))]


@lru_cache(maxsize=64)
def _numbers(count: int) -> st.SearchStrategy[int]:
    return st.integers(0, count - 1)


@dataclass(frozen=True)
class World:
    """A signature, entities with their kinds, P₀, and free slots for further entities.

    Attributes:
        signature: The kinds.
        kinds: The kind of each entity, present or absent.
        placements: P₀: the placements of the present entities.
        channels: Their channels.
        free: Unoccupied points.
    """

    signature: Signature
    kinds: Mapping[Name, str]
    placements: Mapping[Name, Placement]
    channels: Mapping[Name, tuple[Name, ...]]
    free: tuple[Placed, ...]

    def initial(
        self,
        setting: Setting | None = None,
        agents: Mapping[Name, tuple[Name, Code]] | None = None,
        beliefs: Beliefs | None = None,
    ) -> Configuration:
        """Return the initial configuration of this world."""
        return initial(setting or self.setting(), self.placements, self.channels, agents or {}, beliefs)

    def setting(self, program: Program | None = None, environment: tuple[Clause, ...] = ()) -> Setting:
        """Return the setting of a mission in this world."""
        return Setting(self.signature, self.kinds, program or Program((), {}, COMMANDS), environment)


# --- worlds ---------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Slot:
    """A square of the earth's surface: its south-west corner, and its side in degrees."""

    south: float = 37.0
    west: float = -8.8
    side: float = 0.27

    def inner(self, number: int) -> "_Slot":
        """Return one of the nine slots inside."""
        row, column = divmod(number, 3)
        third = self.side / 3
        return _Slot(self.south + (row + 0.1) * third, self.west + (column + 0.1) * third, 0.8 * third)

    def place(self) -> Placed:
        return Placed(box((self.south, self.west), (self.south + self.side, self.west + self.side)))

    def point(self, altitude: Band | None = None) -> Placed:
        return Placed(point(*self._centre()), altitude)

    def hull(self) -> Placed:
        return Placed(circle(self._centre(), 60, vertices=6))

    def _centre(self) -> tuple[float, float]:
        return (self.south + self.side / 2, self.west + self.side / 2)


@dataclass
class _Ground:
    """The world built so far: each place's slot, how many of its nine inner slots are taken, and all placements."""

    slots: dict[Name, _Slot] = field(default_factory=lambda: {REGION: _Slot()})
    taken: dict[Name, int] = field(default_factory=lambda: {REGION: 0})
    placements: dict[Name, Placement] = field(default_factory=dict)

    def room(self) -> list[Name]:
        return [place for place in self.slots if self.taken[place] < 8]

    def take(self, place: Name) -> _Slot:
        # The middle slot stays free for waypoints.
        number = (0, 2, 6, 8, 1, 3, 5, 7)[self.taken[place]]
        self.taken[place] += 1
        return self.slots[place].inner(number)


def signatures() -> st.SearchStrategy[Signature]:
    """Yield signatures of Place, Uav, Vessel, Crate and Station, with random containment, carrying and driving."""
    everyone = frozenset(KIND_OF.values())
    cargo = st.frozensets(st.sampled_from(["Crate", "Uav", "Station", "Vessel"]))
    return st.builds(
        lambda carries, holds, passive, driven: Signature.of(
            [
                Kind("Place", everyone, passive=passive),
                Kind("Uav", driven=driven),
                Kind("Vessel", holds, carries, driven=driven),
                Kind("Crate", holds),
                Kind("Station"),
            ]
        ),
        st.just(frozenset({"Crate", "Uav"})) | cargo,
        st.just(frozenset()) | cargo,
        st.just(False) | st.booleans(),
        st.just(True) | st.booleans(),
    )


@st.composite
def worlds(draw: st.DrawFn, signature: st.SearchStrategy[Signature] | None = None) -> World:
    """Yield small worlds: nested places, vehicles, carriers with cargo, links, absent entities; uav0 is present."""
    of = draw(signatures() if signature is None else signature)
    ground = _Ground()
    places = [f"place{number}" for number in range(pick(draw, [1, 2, 3]))]
    for name in places:
        slot = ground.take(pick(draw, ground.room()))
        ground.placements[name] = slot.place()
        ground.slots[name], ground.taken[name] = slot, 0
    movers = _draw_names(draw)
    for name in movers:
        placement = _draw_placement(draw, of, ground, name)
        if placement is not None:
            ground.placements[name] = placement
    return World(
        of,
        {name: _kind(name) for name in (*places, *movers)},
        ground.placements,
        {name: draw(_channels) for name in sorted(ground.placements)},
        tuple(ground.take(place).point() for place in ground.room()),
    )


_channels: st.SearchStrategy[tuple[Name, ...]] = st.lists(
    st.sampled_from(CHANNELS), unique=True, max_size=2
).map(lambda found: tuple(sorted(found)))


def _kind(name: Name) -> str:
    return KIND_OF[name.rstrip("0123456789")]


def _draw_names(draw: st.DrawFn) -> list[Name]:
    numbers = {"vessel": (0, 2), "uav": (1, 2), "crate": (0, 1), "station": (0, 1)}
    return [
        f"{word}{number}"
        for word, (least, most) in numbers.items()
        for number in range(pick(draw, range(least, most + 1)))
    ]


def _draw_placement(draw: st.DrawFn, signature: Signature, ground: _Ground, name: Name) -> Placement | None:
    kind = _kind(name)
    carriers = [other for other in ground.placements if kind in signature[_kind(other)].carries]
    if name != "uav0" and pick(draw, range(6)) == 5:
        return None
    aboard = bool(carriers) and pick(draw, [False, True])
    if aboard:
        shape = _Slot().hull() if kind == "Vessel" else _Slot().point()
        return Carried(pick(draw, carriers), shape)
    slot = ground.take(pick(draw, ground.room()))
    return slot.hull() if kind == "Vessel" else slot.point(pick(draw, [None, None, Band(50, 100)]))


# --- structures -----------------------------------------------------------------------------------------------


@st.composite
def beliefs(draw: st.DrawFn, world: World) -> Beliefs:
    """Yield an L₀ that may lag behind P₀: nodes with other parents, unknown nodes, other links; always a forest."""
    logical = world.initial().structure.logical
    parents = {name: logical.parent(name) for name in sorted(world.kinds)}
    names = st.sampled_from(sorted(world.kinds))
    for name, place in draw(st.lists(st.tuples(names, st.none() | st.just(REGION) | names), max_size=3)):
        _believe(parents, name, place)
    links = draw(st.dictionaries(names, _channels, max_size=2))
    return Beliefs(parents, {name: those for name, those in links.items() if parents[name] is not None})


def _believe(parents: dict[Name, Name | None], name: Name, place: Name | None) -> None:
    if place is None:
        for child, its in parents.items():
            parents[child] = REGION if its == name else its
        parents[name] = None
        return
    around: Name | None = place
    while around is not None and around not in (REGION, name):
        around = parents[around]
    if around == REGION:
        parents[name] = place


@st.composite
def structures(draw: st.DrawFn, lagging: bool | None = None) -> Structure:
    """Yield structures with L = A(P), or with an L that lags behind P; both if `lagging` is None."""
    world = draw(worlds())
    lags = pick(draw, [False, True]) if lagging is None else lagging
    return world.initial(beliefs=draw(beliefs(world)) if lags else None).structure


def queries(names: Sequence[Name]) -> st.SearchStrategy[Query]:
    """Yield queries over these names, about three operators deep at most."""
    leaves: st.SearchStrategy[Query] = st.lists(
        st.sampled_from(names), min_size=1, max_size=2, unique=True
    ).map(lambda found: Nodes(tuple(sorted(found))))
    return st.recursive(
        leaves | st.just(All()),
        lambda inner: st.builds(Of, st.sampled_from(QueryOperator), inner),
        max_leaves=3,
    )


# --- reactions ------------------------------------------------------------------------------------------------


def commands(host: Name, names: Sequence[Name]) -> st.SearchStrategy[Reaction]:
    """Yield the reactions of the language's commands, from a host, over these names."""
    name = st.sampled_from(names)

    def of(command: Command) -> st.SearchStrategy[Reaction]:
        via = st.lists(name, max_size=2 if command.travels else 0)
        operands = st.tuples(*(name for _ in command.operands))
        return st.builds(lambda given, way: command(host, *given, *way), operands, via)

    return st.one_of([of(command) for command in COMMANDS.values()])


@st.composite
def patterns(draw: st.DrawFn, names: Sequence[Name], host: Name | None = None) -> Pattern:
    """Yield redexes: names, node, place and link variables, closed nodes; and the host as a node, if given."""
    kinds = st.none() | st.sampled_from(sorted(KIND_OF.values()))
    variables = [NodeVariable(f"n{number}", draw(kinds)) for number in range(draw(st.integers(0, 2)))]
    fixed = draw(st.lists(st.sampled_from(names), max_size=2, unique=True))
    nodes: list[NodeTerm] = [*dict.fromkeys([*([host] if host else []), *fixed]), *variables]
    placed = draw(st.lists(st.sampled_from(nodes), unique=True, max_size=3)) if nodes else []
    places = st.sampled_from([*nodes, PlaceVariable("x"), PlaceVariable("y"), REGION])
    parents = tuple((node, place) for node in placed if (place := draw(places)) != node)
    links = tuple(draw(st.lists(st.tuples(_link_terms, st.sampled_from(nodes)), max_size=2))) if nodes else ()
    closed = tuple(draw(st.lists(st.sampled_from(nodes), max_size=1))) if nodes else ()
    return Pattern(tuple(nodes), parents, links, closed)


_link_terms: st.SearchStrategy[LinkTerm] = st.sampled_from(
    [*CHANNELS, LinkVariable("c"), LinkVariable("d", kind="control"), LinkVariable("e", but="control")]
)


@st.composite
def reactions(draw: st.DrawFn, names: Sequence[Name], host: Name) -> Reaction:
    """Yield reactions: moves of the host, commands, and redexes whose reactum moves and relinks some of their nodes."""
    way = pick(draw, ["move", "command", "other"])
    if way == "move":
        holders = [name for name in names if name.startswith(("place", "vessel"))]
        return COMMANDS["MOVE_HOST_TO"](host, pick(draw, holders or names))
    if way == "command":
        return draw(commands(host, names))
    redex = draw(patterns(names, host))
    parents = tuple((node, _elsewhere(draw, redex, node, place)) for node, place in redex.parents)
    joined = [(link, pick(draw, redex.nodes)) for link, _ in redex.links if pick(draw, [False, True])]
    links = tuple(pair for pair in dict.fromkeys([*redex.links, *joined]) if pick(draw, [True, False]))
    return Reaction("REACTION", redex, Pattern(redex.nodes, parents, links))


def _elsewhere(draw: st.DrawFn, redex: Pattern, node: NodeTerm, place: PlaceTerm) -> PlaceTerm:
    others: list[PlaceTerm] = [place, *(other for other in redex.nodes if other != node)]
    return pick(draw, others)


# --- behaviours -----------------------------------------------------------------------------------------------


@st.composite
def programs(draw: st.DrawFn, names: Sequence[Name], agents: int = 1) -> tuple[Program, tuple[Code, ...]]:
    """Yield a well-scoped program of all statements over these names, and the code of its agents.

    Some of its computations are faults.
    """
    return random_program(lambda count: draw(_numbers(count)), names, agents)


# --- configurations -------------------------------------------------------------------------------------------


@st.composite
def environments(draw: st.DrawFn, world: World) -> tuple[Clause, ...]:
    """Yield environment sections of at most two clauses of any kinds."""
    placed = [name for name, at in sorted(world.placements.items()) if isinstance(at, Placed)]
    clauses: list[st.SearchStrategy[Clause]] = [
        st.builds(Drops, st.sampled_from(CHANNELS), st.booleans()),
        st.builds(Leaves, st.sampled_from(placed), st.sampled_from(CHANNELS), st.booleans()),
        st.builds(Vanishes, st.sampled_from(placed)),
        st.builds(
            Says, st.just(Text("go")), st.sampled_from(AGENT_NAMES), st.integers(1, 2), st.integers(0, 3)
        ),
        st.sampled_from([name for name in placed if not name.startswith("place")]).map(
            lambda name: _drift(world, name)
        ),
    ]
    absent = sorted(set(world.kinds) - set(world.placements))
    if absent:
        clauses.append(st.builds(Appears, st.sampled_from(absent), st.just(world.free[:2]), _channels))
    return tuple(draw(st.lists(st.one_of(clauses), max_size=2, unique_by=_subject)))


@st.composite
def _missable(draw: st.DrawFn, world: World) -> tuple[Name, ...]:
    """Yield at most two entities that an observation may miss."""
    names = sorted(world.kinds)
    return tuple(sorted({pick(draw, names), pick(draw, names)}))


def _subject(clause: Clause) -> tuple[str, object]:
    return (type(clause).__name__, clause.number if isinstance(clause, Says) else "")


def _drift(world: World, name: Name) -> Drifts:
    placements = (world.placements[name], *world.free)
    placed = tuple(at for at in placements if isinstance(at, Placed))
    everywhere = tuple(range(len(placed)))
    return Drifts(name, placed, tuple(map(str, everywhere)), (everywhere,) * len(placed), everywhere)


@st.composite
def initial_configurations(
    draw: st.DrawFn,
    schedulers: Sequence[Scheduler] = tuple(Scheduler),
    controls: Sequence[Control] = tuple(Control),
    monitored: bool | None = False,
    lagging: bool | None = None,
    misses: bool | None = None,
) -> Configuration:
    """Yield initial configurations with programs, an environment, and any scheduler and control.

    Some computations fail: `expand` reports their faults, `successors` raises one.

    Args:
        draw: Given by hypothesis.
        schedulers: The schedulers to draw from.
        controls: The controls to draw from.
        monitored: Whether the race monitor is on; both if None.
        lagging: Whether L₀ may differ from A(P₀); both if None.
        misses: Whether observations may miss entities; both if None.
    """
    world = draw(worlds())
    number = draw(st.integers(1, 2))
    program, code = draw(programs(sorted(world.kinds), number))
    hosts = ["uav0", "uav0", *sorted(world.placements)]
    agents = {AGENT_NAMES[each]: (pick(draw, hosts), code[each]) for each in range(number)}
    setting = world.setting(program, draw(environments(world))).with_(
        scheduler=pick(draw, schedulers),
        control=pick(draw, controls),
        monitored=pick(draw, [False, True]) if monitored is None else monitored,
        missable=draw(_missable(world)) if misses or (misses is None and pick(draw, range(3)) == 2) else (),
    )
    lags = pick(draw, [False, False, True]) if lagging is None else lagging
    return world.initial(setting, agents, draw(beliefs(world)) if lags else None)


@dataclass(frozen=True)
class GeneratedMission:
    """A mission without a text, as input of `check`.

    Attributes:
        initial: The initial configuration.
        properties: One property of each kind that needs no formula.
        notes: Empty.
    """

    initial: Configuration
    properties: tuple[Property, ...]
    notes: tuple[str, ...] = ()


def missions(start: st.SearchStrategy[Configuration] | None = None) -> st.SearchStrategy[GeneratedMission]:
    """Yield missions with every property that needs no formula; many never end, so check them within limits."""
    kinds = asked_by(RequestMode.BY_DEFAULT, RequestMode.BY_NAME, RequestMode.ALWAYS)
    properties = tuple(Property(kind, kind.value) for kind in kinds)
    first = initial_configurations() if start is None else start
    return first.map(lambda c: GeneratedMission(c, properties))


@st.composite
def configurations(
    draw: st.DrawFn, start: st.SearchStrategy[Configuration] | None = None, steps: int = 16
) -> Configuration:
    """Yield configurations reached by a random run of at most `steps` steps; `successors` raises no Fault on them.

    An initial configuration with a fault is drawn anew.
    """
    c = draw(initial_configurations() if start is None else start)
    allowed = _steps(c)
    if allowed is None:
        reject()
    for turn in [draw(_numbers(16)) for _ in range(pick(draw, range(steps + 1)))]:
        if not allowed:
            break
        after = allowed[max(0, turn - 6) % len(allowed)].target  # often the first, which serves a request
        following = _steps(after)
        if following is None:
            break
        c, allowed = after, following
    return c


def _steps(c: Configuration) -> Sequence[Transition] | None:
    """Return the successors, None where a computation fails."""
    try:
        return successors(c)
    except Fault:
        return None
