"""Hypothesis strategies for the values of `semantics/`: for tests of missions, rules, and what is built on them.

Worlds stand near Portimão. Places are boxes in slots of a 3 × 3 grid of the place (or the water) around them, so they
nest or lie apart by construction; what moves is a point or a small polygon in a slot of its own. Everything shrinks
towards few entities, L = A(P), few statements and short runs. Needs the extra `strategies`.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from typing import TypeVar

from hypothesis import strategies as st

from physical import Band, box, circle, point
from semantics.agents import Code
from semantics.configuration import Configuration
from semantics.environment import Appears, Clause, Drifts, Drops, Leaves, Says, Vanishes
from semantics.expressions import (
    Apply,
    Either,
    Expression,
    Fault,
    Host,
    Literal,
    QueryOf,
    Self,
    SetOf,
    TupleOf,
    Variable,
)
from semantics.initial import Beliefs, initial
from semantics.patterns import Anything, Elements, Exactly
from semantics.patterns import Pattern as CasePattern
from semantics.physical_model import Carried, Placed, Placement
from semantics.program import Behaviour, Program
from semantics.queries import All, Nodes, Of, Query
from semantics.reactions import (
    COMMANDS,
    LinkTerm,
    LinkVariable,
    NodeTerm,
    NodeVariable,
    Pattern,
    PlaceTerm,
    PlaceVariable,
    Reaction,
)
from semantics.setting import Control, Scheduler, Setting
from semantics.signature import REGION, Kind, Name, Signature
from semantics.statements import (
    Assign,
    Block,
    Call,
    Case,
    Choose,
    ChooseFrom,
    ControlBy,
    Display,
    For,
    ForEach,
    If,
    Loop,
    Match,
    Migrate,
    Observe,
    React,
    Send,
    Spawn,
    Statement,
    Tested,
    While,
)
from semantics.structure import Structure
from semantics.successors import successors
from semantics.values import Truth, Value

CHANNELS = ("control:g0", "control:g1", "wifi")
AGENT_NAMES = ("a", "b", "c", "d")
SPAWNED_NAMES = ("d", "c", "a")
KIND_OF = {"place": "Place", "uav": "Uav", "vessel": "Vessel", "crate": "Crate", "station": "Station"}
OPERATORS = ("PARENT", "CHILDREN", "LINKED_TO", "HOSTED_AT")


T = TypeVar("T")


def pick(draw: st.DrawFn, options: Sequence[T]) -> T:
    """Draw one of some options, the first where it shrinks; cheaper than a strategy made on the spot."""
    return options[draw(_numbers(len(options)))]


@lru_cache(maxsize=64)
def _numbers(count: int) -> st.SearchStrategy[int]:
    return st.integers(0, count - 1)


def arity(command: str) -> int:
    """Return how many arguments a command of the language takes."""
    return 1 if command in ONE_ARGUMENT else 2


ONE_ARGUMENT = frozenset({"MOVE_HOST_TO", "CONNECT_HOST_TO", "DISCONNECT_HOST_FROM"})


@dataclass(frozen=True)
class World:
    """A signature, entities with their kinds, P₀, and free slots in which something may be put.

    Attributes:
        signature: The kinds.
        kinds: The kind of each entity, present or absent.
        placements: P₀ of those that are there.
        channels: Their channels.
        free: Points that nothing takes up.
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
        """Return the configuration that starts in this world."""
        return initial(setting or self.setting(), self.placements, self.channels, agents or {}, beliefs)

    def setting(self, program: Program | None = None, environment: tuple[Clause, ...] = ()) -> Setting:
        """Return the setting of a mission in this world."""
        return Setting(self.signature, self.kinds, program or Program((), {}, COMMANDS), environment)


# --- worlds ---------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Slot:
    """A square of the earth: its south-west corner, and its side in degrees."""

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
    """What is built so far: each place's slot, how many of its nine are taken, and who carries."""

    slots: dict[Name, _Slot] = field(default_factory=lambda: {REGION: _Slot()})
    taken: dict[Name, int] = field(default_factory=lambda: {REGION: 0})
    placements: dict[Name, Placement] = field(default_factory=dict)

    def room(self) -> list[Name]:
        return [place for place in self.slots if self.taken[place] < 8]

    def take(self, place: Name) -> _Slot:
        # The slot in the middle stays free: it is where a waypoint goes.
        number = (0, 2, 6, 8, 1, 3, 5, 7)[self.taken[place]]
        self.taken[place] += 1
        return self.slots[place].inner(number)


def signatures() -> st.SearchStrategy[Signature]:
    """Yield signatures of Place, Uav, Vessel, Crate and Station: who contains, carries, is driven or passive."""
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
    """Yield small worlds: nested places, vehicles, carriers with cargo, links, absent entities; uav0 is there."""
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
    """Yield what L₀ holds where it lags behind P₀: nodes elsewhere, unknown or of other links; always a forest."""
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
    """Yield structures: with L = A(P), or with L that lags behind P; both where `lagging` is None."""
    world = draw(worlds())
    lags = pick(draw, [False, True]) if lagging is None else lagging
    return world.initial(beliefs=draw(beliefs(world)) if lags else None).structure


def queries(names: Sequence[Name]) -> st.SearchStrategy[Query]:
    """Yield queries over these names, at most three operators deep or so."""
    leaves: st.SearchStrategy[Query] = st.lists(
        st.sampled_from(names), min_size=1, max_size=2, unique=True
    ).map(lambda found: Nodes(tuple(sorted(found))))
    return st.recursive(
        leaves | st.just(All()),
        lambda inner: st.builds(Of, st.sampled_from(OPERATORS), inner),
        max_leaves=3,
    )


# --- reactions ------------------------------------------------------------------------------------------------


def commands(host: Name, names: Sequence[Name]) -> st.SearchStrategy[Reaction]:
    """Yield the reactions of the language's commands, from a host, over these names."""
    name = st.sampled_from(names)
    return st.one_of(
        *(st.builds(COMMANDS[one], st.just(host), name) for one in sorted(ONE_ARGUMENT)),
        *(
            st.builds(COMMANDS[two], st.just(host), name, name)
            for two in sorted(set(COMMANDS) - ONE_ARGUMENT)
        ),
    )


@st.composite
def patterns(draw: st.DrawFn, names: Sequence[Name], host: Name | None = None) -> Pattern:
    """Yield redexes: names, node, place and link variables, closed nodes; the host among the nodes if it is given."""
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
    """Yield reactions: commands, and redexes with a reactum that moves and relinks some of their nodes."""
    if pick(draw, [False, True]):
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

Variables = tuple[str, ...]
"""The variables in scope: `o1` holds an observation, `v1` any value."""


class _Writer:
    """Draws statements and numbers them; every variable has a name of its own."""

    def __init__(self, draw: st.DrawFn, names: Sequence[Name]) -> None:
        self.draw = draw
        self.names = names
        self.statements: list[Statement] = []
        self.behaviours: dict[str, Behaviour] = {}
        self.variables = 0

    def pick(self, options: Sequence[T]) -> T:
        return pick(self.draw, options)

    def one(self, *options: Expression) -> Expression:
        return self.pick(options)

    def fresh(self, letter: str = "v") -> str:
        self.variables += 1
        return f"{letter}{self.variables}"

    def add(self, statement: Statement) -> int:
        self.statements.append(statement)
        return len(self.statements) - 1

    def block(self, scope: Variables, depth: int, least: int = 0) -> Block:
        """Draw statements that follow each other; what one binds, those after it may read."""
        block: list[int] = []
        for _ in range(self.pick(range(least, 4))):
            statement = self.statement(scope, depth)
            scope += (statement.variable,) if isinstance(statement, Assign) else ()
            block.append(self.add(statement))
        return tuple(block)

    def statement(self, scope: Variables, depth: int) -> Statement:
        kinds = [*_FLAT, *(_NESTED if depth > 0 else ()), *(("call", "spawn") if self.behaviours else ())]
        write: Callable[[Variables, int], Statement] = getattr(self, f"write_{self.pick(kinds)}")
        return write(scope, depth - 1)

    # expressions

    def leaf(self, scope: Variables) -> Expression:
        values: list[Value] = [*self.names, "go", 1, Truth.TRUE]
        return self.one(*map(Variable, scope), *map(Literal, values), Host(), Self())

    def expression(self, scope: Variables) -> Expression:
        leaf = self.leaf(scope)
        seen = [Apply("nodes", (Variable(name),)) for name in scope if name.startswith("o")]
        go = TupleOf((Literal("go"), leaf))
        one = SetOf((leaf,))
        return self.one(leaf, go, *seen, one, Apply("first", (one,)))

    def name(self, scope: Variables) -> Expression:
        seen = [
            Apply("parent", (Literal(self.pick(self.names)), Variable(name)))
            for name in scope
            if name.startswith("o")
        ]
        return self.one(*map(Literal, self.names), Host(), *map(Variable, scope), *seen)

    def test(self, scope: Variables) -> Expression:
        seen = [
            Apply("in", (Literal(self.pick(self.names)), Variable(name)))
            for name in scope
            if name.startswith("o")
        ]
        same = Apply("==", (self.leaf(scope), self.leaf(scope)))
        either = [Either(self.pick([False, True]), test, same) for test in seen]
        return self.one(*seen, same, Apply("not", (same,)), *either)

    def members(self, scope: Variables) -> Expression:
        seen = [Variable(name) for name in scope if name.startswith("o")]
        return self.one(*seen, SetOf((Literal(self.pick(self.names)), Literal(self.pick(self.names)))))

    def query(self, depth: int = 3) -> QueryOf:
        operator = self.pick(["CHILDREN", "PARENT", "LINKED_TO", None, "HOSTED_AT"]) if depth else None
        if operator is not None:
            return QueryOf(operator, self.query(depth - 1))
        if self.pick(range(4)) == 3:
            return QueryOf("ALL", None)
        return QueryOf(None, self.one(Host(), *map(Literal, self.names)))

    # commands

    def write_observe(self, _: Variables, __: int) -> Statement:
        return Observe(self.query())

    def write_control(self, scope: Variables, _: int) -> Statement:
        command = self.pick(["MOVE_HOST_TO", *sorted(COMMANDS)])
        return ControlBy(command, tuple(self.name(scope) for _ in range(arity(command))))

    def write_react(self, scope: Variables, depth: int) -> Statement:
        return React(self.cases(scope, depth))

    def write_send(self, scope: Variables, _: int) -> Statement:
        return Send(self.expression(scope), Literal(self.pick(AGENT_NAMES)))

    def write_migrate(self, scope: Variables, _: int) -> Statement:
        return Migrate(self.name(scope))

    def write_spawn(self, scope: Variables, _: int) -> Statement:
        behaviour = self.behaviours[self.pick(sorted(self.behaviours))]
        arguments = tuple(self.expression(scope) for _ in behaviour.parameters)
        return Spawn(self.pick(SPAWNED_NAMES), self.name(scope), behaviour.name, arguments)

    # internal computation

    def write_display(self, scope: Variables, _: int) -> Statement:
        return Display(self.expression(scope))

    def write_assign(self, scope: Variables, _: int) -> Statement:
        value = self.expression(scope)
        return Assign(self.fresh(), value)

    def write_match(self, scope: Variables, depth: int) -> Statement:
        otherwise = Case(Anything(), None, self.block(scope, depth))
        return Match(self.expression(scope), (*self.cases(scope, depth), otherwise))

    def cases(self, scope: Variables, depth: int) -> tuple[Case, ...]:
        return tuple(self.case(scope, depth) for _ in range(self.pick([1, 2])))

    def case(self, scope: Variables, depth: int) -> Case:
        letter = self.pick("oov")
        name = self.fresh(letter)
        message: list[CasePattern] = [
            Elements((Exactly("go"), Anything(name))),
            Anything(name, "message"),
            Anything(name),
        ]
        bound: CasePattern = Anything(name, "observation") if letter == "o" else self.pick(message)
        inside = (*scope, name)
        guard = self.test(inside) if self.pick([False, True]) else None
        tested = (self.add(Tested()),) if guard is not None else ()
        return Case(bound, guard, tested + self.block(inside, depth))

    def write_if(self, scope: Variables, depth: int) -> Statement:
        return If(self.test(scope), self.block(scope, depth), self.block(scope, depth))

    def write_while(self, scope: Variables, depth: int) -> Statement:
        return While(self.test(scope), (self.add(self.write_observe(scope, 0)), *self.block(scope, depth)))

    def write_loop(self, scope: Variables, depth: int) -> Statement:
        return Loop((self.add(self.write_react(scope, 0)), *self.block(scope, depth)))

    def write_for(self, scope: Variables, depth: int) -> Statement:
        variable = self.fresh()
        rest = f"{variable}rest#"
        each = self.add(ForEach(variable, rest, self.block((*scope, variable), depth)))
        return For(self.members(scope), rest, each)

    def write_choose(self, scope: Variables, depth: int) -> Statement:
        return Choose((self.block(scope, depth), self.block(scope, depth)))

    def write_choose_from(self, scope: Variables, depth: int) -> Statement:
        variable = self.fresh()
        return ChooseFrom(variable, self.members(scope), self.block((*scope, variable), depth, least=1))

    def write_call(self, scope: Variables, _: int) -> Statement:
        behaviour = self.behaviours[self.pick(sorted(self.behaviours))]
        return Call(behaviour.name, tuple(self.expression(scope) for _ in behaviour.parameters))


_FLAT = ("control", "observe", "react", "observe", "react", "control", "send", "migrate", "display", "assign")
_NESTED = ("if", "match", "for", "choose", "choose_from", "loop", "while")


@st.composite
def programs(draw: st.DrawFn, names: Sequence[Name], agents: int = 1) -> tuple[Program, tuple[Code, ...]]:
    """Yield a well-scoped program of all statements over these names, and the code of so many agents.

    Some of its computations are faults; none diverges before a command.
    """
    writer = _Writer(draw, names)
    if pick(draw, [False, True]):
        parameter = writer.fresh()
        writer.behaviours["helper"] = Behaviour("helper", (parameter,), writer.block((parameter,), 0))
    code = tuple(writer.block((), 2, least=1) for _ in range(agents))
    return Program(tuple(writer.statements), writer.behaviours, COMMANDS), code


# --- configurations -------------------------------------------------------------------------------------------


@st.composite
def environments(draw: st.DrawFn, world: World) -> tuple[Clause, ...]:
    """Yield environment sections of at most three clauses of all kinds."""
    placed = [name for name, at in sorted(world.placements.items()) if isinstance(at, Placed)]
    clauses: list[st.SearchStrategy[Clause]] = [
        st.builds(Drops, st.sampled_from(CHANNELS), st.booleans()),
        st.builds(Leaves, st.sampled_from(placed), st.sampled_from(CHANNELS), st.booleans()),
        st.builds(Vanishes, st.sampled_from(placed)),
        st.builds(Says, st.just("go"), st.sampled_from(AGENT_NAMES), st.integers(1, 2), st.integers(0, 3)),
        st.sampled_from([name for name in placed if not name.startswith("place")]).map(
            lambda name: _drift(world, name)
        ),
    ]
    absent = sorted(set(world.kinds) - set(world.placements))
    if absent:
        clauses.append(st.builds(Appears, st.sampled_from(absent), st.just(world.free[:2]), _channels))
    return tuple(draw(st.lists(st.one_of(clauses), max_size=2, unique_by=_subject)))


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
) -> Configuration:
    """Yield whole first configurations, with programs, an environment, any of the schedulers and controls.

    Args:
        draw: Given by hypothesis.
        schedulers: The schedulers to draw from.
        controls: The controls to draw from.
        monitored: Whether observations are remembered; both where it is None.
        lagging: Whether L₀ may differ from A(P₀); both where it is None.
    """
    world = draw(worlds())
    number = draw(st.integers(1, 2))
    program, code = draw(programs(sorted(world.kinds), number))
    hosts = ["uav0", *sorted(world.kinds)]
    agents = {AGENT_NAMES[each]: (pick(draw, hosts), code[each]) for each in range(number)}
    setting = world.setting(program, draw(environments(world))).with_(
        scheduler=pick(draw, schedulers),
        control=pick(draw, controls),
        monitored=pick(draw, [False, True]) if monitored is None else monitored,
    )
    lags = pick(draw, [False, True]) if lagging is None else lagging
    return world.initial(setting, agents, draw(beliefs(world)) if lags else None)


@st.composite
def configurations(
    draw: st.DrawFn, start: st.SearchStrategy[Configuration] | None = None, steps: int = 12
) -> Configuration:
    """Yield configurations reached by a random run of at most so many steps, none of them into a fault."""
    c = draw(initial_configurations() if start is None else start)
    for turn in [draw(_numbers(12)) for _ in range(pick(draw, range(steps + 1)))]:
        try:
            allowed = successors(c)
        except Fault:
            break
        if not allowed:
            break
        c = allowed[turn % len(allowed)].target
    return c
