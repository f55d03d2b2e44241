"""Renamings: a configuration under other names of agents and entities, value by value.

A renaming is a permutation of names, and of the statements and variables of agents with similar programs. Collections
sorted by name are sorted again.
"""

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, fields, is_dataclass
from functools import cached_property
from typing import Any, Generic, TypeVar

from physical import Geometry
from physical.extents import Extent
from semantics.behaviours.observations import All, Nodes, Observation, Of, Swept
from semantics.behaviours.program import VariableOf
from semantics.behaviours.reaction_rules import (
    LinkVariable,
    Match,
    NodeVariable,
    Pattern,
    PlaceVariable,
    Reaction,
)
from semantics.behaviours.values import Text, Truth, order_key
from semantics.properties.propositions import Instances, Range
from semantics.state.cell_values import AGENTS, NAMES, Cell, Changes, Row
from semantics.state.configuration import Configuration
from semantics.state.physical_model import Carried, InTransit, Placed
from semantics.state.requests import request_key
from semantics.state.setting import Scheduler
from semantics.timing.flight_history import Adrift

Where = TypeVar("Where", int, Cell)

WORD = re.compile(r"[^\W\d]\w*")

FIXED = (
    *(int, Truth, Text, Geometry, Extent, Placed, Adrift, All, NodeVariable, PlaceVariable, LinkVariable),
    type(None),
)
"""Types without names."""


@dataclass(frozen=True)
class Renaming:
    """A permutation of interchangeable parts; parts that it doesn't list are fixed.

    Attributes:
        names: The permutation of agents and entities.
        numbers: That of statements.
        variables: That of variables.
        cells: That of cells named by a number (`says`).
    """

    names: Mapping[str, str] = field(default_factory=dict)
    numbers: Mapping[int, int] = field(default_factory=dict)
    variables: Mapping[str, str] = field(default_factory=dict)
    cells: Mapping[Cell, Cell] = field(default_factory=dict)

    @cached_property
    def inverse(self) -> "Renaming":
        """The renaming that undoes it."""
        return Renaming(*({after: before for before, after in part.items()} for part in self.parts))

    @property
    def parts(self) -> tuple[Mapping[Any, Any], ...]:
        """Its four permutations."""
        return (self.names, self.numbers, self.variables, self.cells)

    def after(self, first: "Renaming") -> "Renaming":
        """Return the composition with another renaming, which is applied first."""
        together = (
            {each: mine.get(its.get(each, each), its.get(each, each)) for each in {**its, **mine}}
            for mine, its in zip(self.parts, first.parts, strict=True)
        )
        return Renaming(*together)

    # --- cells and configurations -----------------------------------------------------------------------------

    def cell(self, cell: Cell) -> Cell:
        """Return the image of a cell."""
        return self.cells[cell] if cell in self.cells else (cell[0], *(self.name(part) for part in cell[1:]))

    def configuration(self, c: Configuration) -> Configuration:
        """Return the image of a configuration; its setting must be invariant."""
        assert isinstance(c.state, Row)
        unordered = c.setting.scheduler is Scheduler.UNORDERED
        changes: Changes = {}
        for cell, value in c.state.items():
            changes[self.cell(cell)] = self.content(cell, value, unordered=unordered)
        return c.with_(changes)

    def content(self, cell: Cell, value: Any, *, unordered: bool) -> Any:
        """Return the image of a cell's value."""
        what = cell[0]
        if what == "code":
            return tuple(self.numbers.get(number, number) for number in value)
        if what == "store":
            held = ((self.variables.get(name, name), self.value(kept)) for name, kept in value)
            return tuple(sorted(held, key=lambda item: item[0]))
        if cell in (AGENTS, NAMES):
            return tuple(sorted(map(self.name, value)))
        if what == "mailbox":
            return tuple(sorted(map(self.value, value), key=order_key))
        if what == "sends" or (what == "line" and unordered):
            return tuple(sorted(map(self.value, value), key=request_key))
        return self.value(value)

    # --- values -----------------------------------------------------------------------------------------------

    def name(self, name: str) -> str:
        """Return the image of a name."""
        return self.names.get(name, name)

    def text(self, text: str) -> str:
        """Return a text with the names in it renamed."""
        return WORD.sub(lambda word: self.name(word[0]), text)

    def value(self, value: Any) -> Any:
        """Return the image of a value, a request, a query, a placement."""
        if isinstance(value, str):
            return self.name(value)
        if isinstance(value, FIXED):
            return value
        if isinstance(value, tuple) and not hasattr(value, "_fields"):
            return tuple(map(self.value, value))
        if isinstance(value, frozenset):
            return frozenset(map(self.value, value))
        return SPECIAL.get(type(value), _each_field)(self, value)


def _each_field(renaming: Renaming, value: Any) -> Any:
    if not is_dataclass(value) or isinstance(value, type):
        raise TypeError(f"a renaming does not know {type(value).__name__}")
    make: Callable[..., Any] = type(value)
    return make(*(renaming.value(getattr(value, each.name)) for each in fields(value)))


def _sorted(renaming: Renaming, names: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(sorted(map(renaming.name, names)))


def _observation(renaming: Renaming, seen: Observation) -> Observation:
    swept = seen.swept
    return Observation.of(
        _sorted(renaming, seen.shown),
        _sorted(renaming, seen.agents),
        map(renaming.value, seen.relations),
        Swept(
            _sorted(renaming, swept.places),
            _sorted(renaming, swept.nodes),
            swept.links,
            _sorted(renaming, swept.around),
        ),
    )


SPECIAL: Mapping[type, Callable[[Renaming, Any], Any]] = {
    Observation: _observation,
    Nodes: lambda renaming, query: Nodes(_sorted(renaming, query.names)),
    Of: lambda renaming, query: Of(query.operator, renaming.value(query.of)),
    Carried: lambda renaming, placement: Carried(renaming.name(placement.by), placement.shape),
    InTransit: lambda renaming, placement: InTransit(placement.origin, renaming.name(placement.to)),
    Match: lambda renaming, match: Match(tuple((term, renaming.name(name)) for term, name in match.binding)),
    Reaction: lambda renaming, each: Reaction(
        renaming.text(each.text),
        renaming.value(each.redex),
        renaming.value(each.reactum),
        renaming.value(each.via),
    ),
    Pattern: _each_field,
    Instances: lambda renaming, each: Instances(
        each.variable,
        renaming.value(each.range),
        renaming.value(each.body),
        renaming.value(each.anchor),
        each.are_kept,
    ),
    Range: lambda renaming, each: Range(each.variable, each.kind, _sorted(renaming, each.names)),
    VariableOf: lambda renaming, each: VariableOf(
        renaming.name(each.agent), tuple(sorted(renaming.variables.get(one, one) for one in each.variables))
    ),
}
"""Types that are not renamed field by field."""


def spelled(value: Any) -> str:
    """Return a text that distinguishes values and is the same in every process."""
    if isinstance(value, frozenset):
        return "{" + ",".join(sorted(map(spelled, value))) + "}"
    if isinstance(value, tuple) and not hasattr(value, "_fields"):
        return "(" + ",".join(map(spelled, value)) + ")"
    if is_dataclass(value) and not isinstance(value, Geometry):
        inner = ",".join(spelled(getattr(value, each.name)) for each in fields(value))
        return f"{type(value).__name__}({inner})"
    return repr(value)


# --- mentions -------------------------------------------------------------------------------------------------


class _Asked(dict[Any, Any]):
    """An empty permutation that records the requested keys."""

    def __init__(self, met: dict[Any, None]) -> None:
        super().__init__()
        self.met = met

    def get(self, key: Any, default: Any = None) -> Any:
        """Record a key; return the default."""
        self.met[key] = None
        return default

    def __contains__(self, key: object) -> bool:
        self.met[key] = None
        return False


def requested_keys(look: Callable[[Renaming], object]) -> tuple[Any, ...]:
    """Return the names, numbers, variables and cells that a function requests from a renaming, in order."""
    met: dict[Any, None] = {}
    look(Renaming(*(_Asked(met) for _ in range(4))))
    return tuple(met)


def mentioned(value: Any, among: frozenset[str]) -> tuple[str, ...]:
    """Return the given names that occur in a value, in the order of occurrence."""
    return tuple(name for name in requested_keys(lambda renaming: renaming.value(value)) if name in among)


class Mentions(Generic[Where]):
    """An index of the places that mention each thing; a renaming changes only places that mention a moved thing."""

    def __init__(self, places: Iterable[tuple[Where, Callable[[Renaming], object]]]) -> None:
        self.places: dict[Any, dict[Where, None]] = {}
        for place, look in places:
            for thing in requested_keys(look):
                self.places.setdefault(thing, {})[place] = None

    def of(self, renaming: Renaming) -> list[Where]:
        """Return the places that mention a thing that a renaming moves, sorted."""
        moved = (thing for part in renaming.parts for thing in part)
        return sorted(set().union(*(self.places.get(thing, ()) for thing in moved)))
