"""Small missions built by hand, and their exhaustive exploration."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from physical import box, circle, point
from semantics.behaviours.commands import COMMANDS
from semantics.behaviours.expressions import Apply, Host, Literal, QueryOf, SetOf, TupleOf, Variable
from semantics.behaviours.patterns import Anything
from semantics.behaviours.program import Program
from semantics.behaviours.statements import (
    Case,
    ChooseFrom,
    ControlBy,
    If,
    Loop,
    Observe,
    React,
    Send,
    Statement,
    Tested,
)
from semantics.state.configuration import Configuration, Transition
from semantics.state.initial import Beliefs, initial
from semantics.state.logical_model import LogicalModel
from semantics.state.physical_model import Carried, Placed, Placement
from semantics.state.setting import Scheduler, Setting
from semantics.state.signature import Kind, Signature
from semantics.successors import successors

EVERYONE = frozenset({"Place", "Spill", "Uav", "Vessel", "Crate", "Station", "Bunker"})
SIGNATURE = Signature.of(
    [
        Kind("Place", EVERYONE),
        Kind("Bunker", EVERYONE, passive=True),
        Kind("Spill", frozenset({"Uav"})),
        Kind("Uav", driven=True),
        Kind("Vessel", carries=frozenset({"Crate", "Uav", "Vessel"}), driven=True),
        Kind("Crate"),
        Kind("Station"),
    ]
)
KINDS = {
    "sea": "Place",
    "base": "Place",
    "area": "Place",
    "spill": "Spill",
    "bunker": "Bunker",
    "u0": "Uav",
    "u1": "Uav",
    "ship": "Vessel",
    "boat": "Vessel",
    "crate": "Crate",
    "gcs0": "Station",
    "gcs1": "Station",
}
SHAPES: dict[str, Placed] = {
    "sea": Placed(box((36.5, -9.0), (37.0, -8.0))),  # area and spill are in it
    "base": Placed(box((37.1, -8.8), (37.2, -8.6))),
    "area": Placed(box((36.6, -8.8), (36.8, -8.6))),
    "spill": Placed(circle((36.7, -8.7), 400)),
    "bunker": Placed(box((37.1, -8.4), (37.2, -8.2))),
    "u0": Placed(point(37.15, -8.7)),  # in base
    "u1": Placed(point(37.12, -8.75)),  # in base
    "ship": Placed(circle((36.9, -8.2), 200)),  # in sea
    "boat": Placed(circle((36.9, -8.4), 100)),  # in sea
    "crate": Placed(point(36.95, -8.1)),  # in sea
    "gcs0": Placed(point(37.3, -8.7)),
    "gcs1": Placed(point(37.3, -8.6)),
}


GUARD = Tested()
"""Begins the body of a guarded case. (pytest would take `Tested` for a test.)"""


def aboard(carrier: str, name: str) -> Carried:
    """Put an entity on a carrier."""
    return Carried(carrier, SHAPES[name])


def mission(
    entities: Iterable[str],
    statements: Iterable[Statement] = (),
    agents: Mapping[str, tuple[str, tuple[int, ...]]] | None = None,
    *,
    channels: Mapping[str, Iterable[str]] | None = None,
    placed: Mapping[str, Placement | None] | None = None,
    beliefs: Beliefs | None = None,
    program: Program | None = None,
    signature: Signature = SIGNATURE,
    **setting: object,
) -> Configuration:
    """Return a mission's first configuration; entities stand where `SHAPES` has them, but for `placed`."""
    names = list(entities)
    placements = {name: SHAPES[name] for name in names} | dict(placed or {})
    present = {name: at for name, at in placements.items() if at is not None}
    made = Setting(
        signature, {name: KINDS[name] for name in names}, program or Program(tuple(statements), {}, COMMANDS)
    )
    return initial(made.with_(**setting), present, channels or {}, agents or {}, beliefs)


def around() -> QueryOf:
    """CHILDREN(PARENT(HOST))."""
    return QueryOf("CHILDREN", QueryOf("PARENT", QueryOf(None, Host())))


def of_name(operator: str, name: str) -> QueryOf:
    return QueryOf(operator, QueryOf(None, Literal(name)))


def is_in(name: str, variable: str) -> Apply:
    return Apply("in", (Literal(name), Variable(variable)))


def logical_of(*names, **more) -> LogicalModel:
    """Return the L that a mission over the small world begins with."""
    return mission(names, **more).structure.logical


def move_to(place: str) -> ControlBy:
    return ControlBy("MOVE_HOST_TO", (Literal(place),))


def received(variable: str, *body: int, guard: Apply | None = None) -> React:
    return React((Case(Anything(variable, "observation"), guard, body),))


def figure_2(guarded: bool = False, **setting: object) -> Configuration:
    """Return the mission of Figure 2: u0 in base goes to area, looks, and goes into the spill if it sees it."""
    test = is_in("spill", "obs")
    statements = (
        move_to("area"),
        Observe(around()),
        received("obs", 3, 4, guard=test) if guarded else received("obs", 3),
        GUARD if guarded else If(test, (4,)),
        move_to("spill"),
    )
    return mission(["area", "base", "spill", "u0"], statements, {"a": ("u0", (0, 1, 2))}, **setting)


@dataclass
class Exploration:
    configurations: list[Configuration]
    transitions: list[tuple[Configuration, Transition]]

    def labels(self) -> list[str]:
        return [str(transition.label) for _, transition in self.transitions]


def explore(start: Configuration, limit: int = 20_000) -> Exploration:
    """Explore breadth first; a mission that is larger than the limit is a mistake of the test."""
    seen = {start: None}
    found = Exploration([start], [])
    for c in found.configurations:
        for transition in successors(c):
            found.transitions.append((c, transition))
            if transition.target not in seen:
                seen[transition.target] = None
                found.configurations.append(transition.target)
        assert len(found.configurations) <= limit
    return found


def run(c: Configuration, *rules: str) -> Configuration:
    """Take the first transition of each of these rules in turn."""
    for rule in rules:
        allowed = successors(c)
        c = next((t.target for t in allowed if t.label.rule == rule), None)
        assert c is not None, f"{rule} is not enabled: {[str(t.label) for t in allowed]}"
    return c


def enabled(c: Configuration) -> list[str]:
    """Return the names of the rules that are enabled, sorted."""
    return sorted(t.label.rule for t in successors(c))


def talkative() -> Configuration:
    """Return a mission in which sets, tuples and observations are sent, stored and chosen from, in no line."""
    names = SetOf(tuple(map(Literal, ("sea", "area", "spill", "go", "base"))))
    statements = (
        Send(names, Literal("b")),
        Send(TupleOf((Literal("go"), names)), Literal("b")),
        Observe(QueryOf("ALL", None)),
        React((Case(Anything("o"), None, (4,)),)),
        ChooseFrom("x", names, (5,)),
        Send(SetOf((Variable("x"), Variable("o"))), Literal("b")),
        Loop((7,), outermost=True),
        React((Case(Anything("m", "message"), None, ()),)),
    )
    agents = {"a": ("u0", (0, 1, 2, 3)), "b": ("u0", (6,))}
    return mission(
        ["area", "base", "sea", "u0"], statements, agents, scheduler=Scheduler.UNORDERED, monitored=True
    )
