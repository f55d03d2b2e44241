"""Propositions about one configuration."""

import operator
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, overload

from semantics.behaviours.process_conversion import waits
from semantics.behaviours.program import VariableOf
from semantics.behaviours.values import Value, show
from semantics.properties.region_atoms import ApartFrom, PossiblyIn, RegionAtom, SurelyIn, WithinRangeOf
from semantics.state.agents import Store, code_cell, is_over, store_cell
from semantics.state.configuration import Configuration
from semantics.state.signature import REGION, Name

# --- atoms ----------------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Inside:
    """`x in y`: y is x's parent, or (unless `directly`) one of the places around it; in L, or `actually` in A(P)."""

    node: Name
    place: Name
    actually: bool = False
    directly: bool = False

    def __str__(self) -> str:
        return f"{_mode(self.actually)}{self.node} {'directly ' if self.directly else ''}in {self.place}"


@dataclass(frozen=True, slots=True)
class LinkedWith:
    """`x linked y`: x is on the link y, or shares a link with the node y; in L, or `actually` in A(P)."""

    node: Name
    other: Name
    actually: bool = False

    def __str__(self) -> str:
        return f"{_mode(self.actually)}{self.node} linked {self.other}"


@dataclass(frozen=True, slots=True)
class Present:
    """`present x`: x has an image in P."""

    entity: Name

    def __str__(self) -> str:
        return f"present {self.entity}"


@dataclass(frozen=True, slots=True)
class Exists:
    """`present a`: there is a bigActor a, declared or spawned so far.

    Attributes:
        agent: The bigActor.
        implied: Whether a quantifier added the atom, for a bigActor that may not exist yet, and not the mission's text.
    """

    agent: Name
    implied: bool = False

    def __str__(self) -> str:
        return f"present {self.agent}"


@dataclass(frozen=True, slots=True)
class Known:
    """`known x`: x is a node of L."""

    node: Name

    def __str__(self) -> str:
        return f"known {self.node}"


@dataclass(frozen=True, slots=True)
class HasPending:
    """`pending CTR a`: a has such a request in η; without the word, any request."""

    agent: Name
    request: str | None = None

    def __str__(self) -> str:
        return f"pending {self.request + ' ' if self.request else ''}{self.agent}"


@dataclass(frozen=True, slots=True)
class Ended:
    """`ended a`: a has no code left to run."""

    agent: Name

    def __str__(self) -> str:
        return f"ended {self.agent}"


@dataclass(frozen=True, slots=True)
class Waiting:
    """`waiting a`: a is at a react."""

    agent: Name

    def __str__(self) -> str:
        return f"waiting {self.agent}"


@dataclass(frozen=True, slots=True)
class HostedAt:
    """`a hosted_at x`."""

    agent: Name
    node: Name

    def __str__(self) -> str:
        return f"{self.agent} hosted_at {self.node}"


@dataclass(frozen=True, slots=True)
class VariableIs:
    """`a.x == v`, `a.x < v` and so on: a comparison of a's variable x with a value.

    Attributes:
        variable: The variable.
        value: The value that it is compared with.
        operator: The operator.
        unbound: The truth value if the variable has no value, or none that can be compared. An unbound variable neither
            violates nor fulfils a property, so this depends on the polarity of the comparison in the formula.
    """

    variable: VariableOf
    value: Value
    operator: str = "=="
    unbound: bool = False

    def __str__(self) -> str:
        return f"{self.variable} {self.operator} {show(self.value)}"


@dataclass(frozen=True, slots=True)
class IsBound:
    """`bound a.x`: a has given its variable x a value."""

    variable: VariableOf

    def __str__(self) -> str:
        return f"bound {self.variable}"


@dataclass(frozen=True, slots=True)
class Always:
    """`true` or `false`."""

    value: bool

    def __str__(self) -> str:
        return "true" if self.value else "false"


@dataclass(frozen=True, slots=True)
class Same:
    """`x == y` below a quantifier that is not expanded; an instance of x and y decides it."""

    name: Name
    other: Name

    def __str__(self) -> str:
        return f"{self.name} == {self.other}"


# --- connectives ----------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Not:
    """`not f`."""

    formula: "Proposition"

    def __str__(self) -> str:
        return f"not {_nested(self.formula)}"


@dataclass(frozen=True, slots=True)
class And:
    """`f and g and ...`."""

    formulas: "Formulas"

    def __str__(self) -> str:
        if isinstance(self.formulas, Instances):
            return f"forall {self.formulas}"
        return " and ".join(map(_nested, self.formulas)) or "true"


@dataclass(frozen=True, slots=True)
class Or:
    """`f or g or ...`."""

    formulas: "Formulas"

    def __str__(self) -> str:
        if isinstance(self.formulas, Instances):
            return f"exists {self.formulas}"
        return " or ".join(map(_nested, self.formulas)) or "false"


Atom = (
    Inside
    | RegionAtom
    | LinkedWith
    | Present
    | Exists
    | Known
    | HasPending
    | Ended
    | Waiting
    | HostedAt
    | VariableIs
    | IsBound
    | Always
    | Same
)
Proposition = Atom | Not | And | Or


# --- quantifiers that are not expanded --------------------------------------------------------------------------


@dataclass(frozen=True)
class Range:
    """The range of a quantified name.

    Attributes:
        variable: The name, as the author wrote it.
        kind: The kind or collection that it ranges over, as the author wrote it.
        names: The names in the range, sorted.
    """

    variable: str
    kind: str
    names: tuple[Name, ...]

    @cached_property
    def members(self) -> frozenset[Name]:
        """The names, as a set for lookups."""
        return frozenset(self.names)


@dataclass(frozen=True, slots=True)
class Instances(Sequence["Proposition"]):
    """The instances of a quantified formula, each created on demand.

    Attributes:
        variable: The quantified name in `body`; it begins with a question mark, as no name of a mission does.
        range: Its range.
        body: The quantified formula.
        anchor: An atom `x in v` about the quantified v that decides the instances in which it is false: to true below
            `forall`, to false below `exists`. So only instances for places around x need be evaluated.
        are_kept: Whether created instances are kept; those of long formulas are created each time.
        made: The instances that are kept.
    """

    variable: Name
    range: Range
    body: "Proposition"
    anchor: Inside | None = None
    are_kept: bool = True
    made: "dict[Name, Proposition]" = field(default_factory=dict, init=False, repr=False, compare=False)

    @staticmethod
    def of(
        variable: Name, range_: Range, body: "Proposition", *, every: bool, are_kept: bool = True
    ) -> "Instances":
        """Return the instances of `forall` or `exists`, with their anchor if there is one."""
        unknown = {variable, *_quantified_in(body)}
        places = (
            each for each in _written_atoms(body) if isinstance(each, Inside) and each.place == variable
        )
        anchors = (each for each in places if each.node not in unknown and _without(body, each) is every)
        return Instances(variable, range_, body, next(anchors, None), are_kept)

    def of_name(self, name: Name) -> "Proposition":
        """Return the instance for a name."""
        found = self.made.get(name) or instance(self.body, self.variable, name)
        if self.are_kept:
            self.made[name] = found
        return found

    def worth_asking(self, c: Configuration) -> "Iterable[Proposition]":
        """Return the instances that may decide the formula in a configuration."""
        if self.anchor is None:
            return self
        around = places_around(c, self.anchor.node, actually=self.anchor.actually)
        return [self.of_name(place) for place in around if place in self.range.members]

    def with_(self, variable: Name, name: Name) -> "Instances":
        """Return the instances with another quantified name replaced."""
        anchor = None if self.anchor is None else instance(self.anchor, variable, name)
        assert anchor is None or isinstance(anchor, Inside)
        return Instances(
            self.variable, self.range, instance(self.body, variable, name), anchor, self.are_kept
        )

    def __len__(self) -> int:
        return len(self.range.names)

    def __iter__(self) -> "Iterator[Proposition]":
        return map(self.of_name, self.range.names)

    @overload
    def __getitem__(self, rank: int) -> "Proposition": ...

    @overload
    def __getitem__(self, rank: slice) -> "Sequence[Proposition]": ...

    def __getitem__(self, rank: int | slice) -> "Proposition | Sequence[Proposition]":
        names = self.range.names[rank]
        return self.of_name(names) if isinstance(names, str) else tuple(map(self.of_name, names))

    def __str__(self) -> str:
        body = re.sub(rf"{re.escape(self.variable)}\b", self.range.variable, str(self.body))
        return f"{self.range.variable}: {self.range.kind} . {body}"


Formulas = tuple["Proposition", ...] | Instances


def is_variable(name: Name) -> bool:
    """Whether a name is a quantified one."""
    return name.startswith("?")


def instance(formula: "Proposition", variable: Name, name: Name) -> "Proposition":
    """Return a proposition with a quantified name replaced by another name."""
    match formula:
        case Not(inner):
            return Not(instance(inner, variable, name))
        case And(parts) | Or(parts):
            if isinstance(parts, Instances):
                return type(formula)(parts.with_(variable, name))
            return type(formula)(tuple(instance(part, variable, name) for part in parts))
        case Always() | VariableIs() | IsBound():
            return formula
    make: Callable[..., Proposition] = type(formula)
    atom = make(*(name if part == variable else part for part in _members(formula)))
    if isinstance(atom, Same) and not (is_variable(atom.name) or is_variable(atom.other)):
        return Always(atom.name == atom.other)
    return atom


def _members(atom: Any) -> list[Any]:
    return [getattr(atom, each) for each in atom.__slots__]


def atoms_of(formula: "Proposition") -> "Iterator[Atom]":
    """Yield the atoms of a formula except `true` and `false`; of a quantifier, those of its instances, once each."""
    for atom in _written_atoms(formula, of_instances=True):
        if not isinstance(atom, Same):
            yield atom


def _written_atoms(formula: "Proposition", *, of_instances: bool = False) -> "Iterator[Atom]":
    match formula:
        case Not(inner):
            yield from _written_atoms(inner, of_instances=of_instances)
        case And(parts) | Or(parts) if isinstance(parts, Instances):
            within = _written_atoms(parts.body, of_instances=of_instances)
            yield from _each_instance(within, parts) if of_instances else within
        case And(parts) | Or(parts):
            for part in parts:
                yield from _written_atoms(part, of_instances=of_instances)
        case Always():
            return
        case _:
            yield formula


def _quantified_in(formula: "Proposition") -> "Iterator[Name]":
    match formula:
        case Not(inner):
            yield from _quantified_in(inner)
        case And(parts) | Or(parts) if isinstance(parts, Instances):
            yield parts.variable
            yield from _quantified_in(parts.body)
        case And(parts) | Or(parts):
            for part in parts:
                yield from _quantified_in(part)


def _each_instance(atoms: "Iterable[Atom]", instances: Instances) -> "Iterator[Atom]":
    for atom in dict.fromkeys(atoms):
        if isinstance(atom, Same) or instances.variable not in _members(atom):
            yield atom
            continue
        for name in instances.range.names:
            found = instance(atom, instances.variable, name)
            assert isinstance(found, Atom)
            yield found


def _without(formula: "Proposition", atom: "Atom") -> bool | None:
    """Return the truth value of a formula in which one atom is false, None if it depends on other atoms."""
    match formula:
        case Not(inner):
            said = _without(inner, atom)
            return None if said is None else not said
        case And(parts) | Or(parts):
            among = (parts.body,) if isinstance(parts, Instances) else parts
            said_each = {_without(part, atom) for part in among}
            decides = isinstance(formula, Or)
            if decides in said_each:
                return decides
            return None if None in said_each else not decides
        case Always(value):
            return value
        case _:
            return False if formula == atom else None


def _mode(actually: bool) -> str:
    return "actually " if actually else ""


def _nested(formula: Proposition) -> str:
    return f"({formula})" if isinstance(formula, And | Or) else str(formula)


ORDERS: Mapping[str, Callable[[int, int], bool]] = {
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}
"""The comparisons of numbers; other values cannot be ordered."""

# --- truth ----------------------------------------------------------------------------------------------------


def holds(formula: Proposition, c: Configuration) -> bool:
    """Whether a proposition is true of a configuration."""
    match formula:
        case Not(inner):
            return not holds(inner, c)
        case And(parts):
            return all(holds(part, c) for part in _worth_asking(parts, c))
        case Or(parts):
            return any(holds(part, c) for part in _worth_asking(parts, c))
        case _:
            return _TRUTH[type(formula)](formula, c)


def counterexample_names(formula: Proposition, c: Configuration) -> tuple[tuple[str, Name], ...]:
    """Return a counterexample to a false proposition: the names at which its `forall` quantifiers over entities fail.

    Returns:
        The name for each quantified variable, the outermost first; names below `not` and `exists` are left out.
    """
    match formula:
        case And(Instances(range=among) as parts):
            name = next(name for name in among.names if not holds(parts.of_name(name), c))
            return ((among.variable, name), *counterexample_names(parts.of_name(name), c))
        case And(parts):
            return counterexample_names(next(part for part in parts if not holds(part, c)), c)
        case Or(parts) if not isinstance(parts, Instances):
            return next(filter(None, (counterexample_names(part, c) for part in parts)), ())
    return ()


def _worth_asking(parts: Formulas, c: Configuration) -> Iterable[Proposition]:
    return parts.worth_asking(c) if isinstance(parts, Instances) else parts


def _inside(atom: Inside, c: Configuration) -> bool:
    around = places_around(c, atom.node, actually=atom.actually)
    return next(around, None) == atom.place if atom.directly else atom.place in around


def places_around(c: Configuration, node: Name, *, actually: bool) -> Iterator[Name]:
    """Yield the places around a node in A(P) or in L, the innermost first."""
    return _actual_places(c, node) if actually else _believed_places(c, node)


def _believed_places(c: Configuration, node: Name) -> Iterator[Name]:
    if node in c.structure.logical:
        yield from c.structure.logical.ancestors(node)
        yield REGION


def _actual_places(c: Configuration, node: Name) -> Iterator[Name]:
    while node != REGION and node in c.structure.physical:
        node = c.structure.physical.abstract_parent(node)
        yield node


def _linked(atom: LinkedWith, c: Configuration) -> bool:
    model = c.structure.physical if atom.actually else c.structure.logical
    links = set(model.links(atom.node)) if atom.node in model else set()
    if atom.other in c.setting.kinds:
        return atom.other in model and not links.isdisjoint(model.links(atom.other))
    return atom.other in links


def _pending(atom: HasPending, c: Configuration) -> bool:
    pending = (each.request for each in c.eta.of(atom.agent))
    return any(atom.request in (None, type(request).__name__) for request in pending)


def _is_agent(c: Configuration, agent: Name) -> bool:
    return agent in c.alpha


def _about_variable(atom: VariableIs | IsBound, c: Configuration) -> bool:
    """Whether an atom about a variable is true.

    Raises:
        ValueError: The configuration's setting does not keep the variable.
    """
    variable = atom.variable
    if variable not in c.setting.program.watched:
        raise ValueError(
            f"'{variable}' is dropped once no statement reads it any more: begin with watching(initial, properties)"
        )
    return c.test(store_cell(variable.agent), is_true_of, atom)


def _about_region(atom: RegionAtom, c: Configuration) -> bool:
    from semantics.regions.region_truth import is_true  # noqa: PLC0415 - few missions have such atoms; geometry takes its time to load

    return is_true(atom, c)


def is_true_of(store: Store | None, atom: VariableIs | IsBound) -> bool:
    """Whether an atom about a variable is true of the store that keeps it; a question about a cell."""
    held = dict(store or ()).get(atom.variable.key)
    if isinstance(atom, IsBound):
        return held is not None
    if held is None:
        return atom.unbound
    if atom.operator == "==":
        return type(held) is type(atom.value) and held == atom.value
    if isinstance(held, int) and isinstance(atom.value, int):
        return ORDERS[atom.operator](held, atom.value)
    return atom.unbound


_TRUTH: dict[type, Callable[[Any, Configuration], bool]] = {
    Inside: _inside,
    LinkedWith: _linked,
    **dict.fromkeys((PossiblyIn, SurelyIn, ApartFrom, WithinRangeOf), _about_region),
    HasPending: lambda atom, c: _is_agent(c, atom.agent) and _pending(atom, c),
    VariableIs: _about_variable,
    IsBound: _about_variable,
    Present: lambda atom, c: atom.entity in c.structure.physical,
    Exists: lambda atom, c: _is_agent(c, atom.agent),
    Known: lambda atom, c: atom.node in c.structure.logical,
    Ended: lambda atom, c: _is_agent(c, atom.agent) and c.test(code_cell(atom.agent), is_over),
    Waiting: lambda atom, c: (
        _is_agent(c, atom.agent) and c.test(code_cell(atom.agent), waits, c.setting.program)
    ),
    HostedAt: lambda atom, c: _is_agent(c, atom.agent) and c.alpha.host(atom.agent) == atom.node,
    Always: lambda atom, _: atom.value,
}
