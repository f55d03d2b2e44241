"""Propositions about one configuration, and the properties made of them."""

import operator
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from semantics.behaviours.program import VariableOf
from semantics.behaviours.stepping import waits
from semantics.behaviours.values import Value, show
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
    """`present a`: there is a bigActor a, from the first or since it was spawned.

    Attributes:
        agent: Which.
        implied: Whether a quantifier says it, of a bigActor that may not be there yet, and not the mission.
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
    """`pending CTR a`: a has such a request in η; any request without the word."""

    agent: Name
    request: str | None = None

    def __str__(self) -> str:
        return f"pending {self.request + ' ' if self.request else ''}{self.agent}"


@dataclass(frozen=True, slots=True)
class Ended:
    """`ended a`: nothing is left of a to run."""

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
    """`a.x == v`, `a.x < v` and so on: how a's variable x compares with a value.

    Attributes:
        variable: Which.
        value: With what it is compared.
        operator: How.
        unbound: Whether it is true where the variable has no value, or none that can be compared so. What has no value
            neither violates nor fulfils a property, so that depends on where the comparison stands in it.
    """

    variable: VariableOf
    value: Value
    operator: str = "=="
    unbound: bool = False

    def __str__(self) -> str:
        return f"{self.variable} {self.operator} {show(self.value, frozenset())}"


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

    formulas: tuple["Proposition", ...]

    def __str__(self) -> str:
        return " and ".join(map(_nested, self.formulas)) or "true"


@dataclass(frozen=True, slots=True)
class Or:
    """`f or g or ...`."""

    formulas: tuple["Proposition", ...]

    def __str__(self) -> str:
        return " or ".join(map(_nested, self.formulas)) or "false"


Atom = (
    Inside
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
)
Proposition = Atom | Not | And | Or


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
"""The comparisons of numbers, and of nothing else."""

# --- truth ----------------------------------------------------------------------------------------------------


def holds(formula: Proposition, c: Configuration) -> bool:
    """Tell whether a proposition is true of a configuration."""
    match formula:
        case Not(inner):
            return not holds(inner, c)
        case And(parts):
            return all(holds(part, c) for part in parts)
        case Or(parts):
            return any(holds(part, c) for part in parts)
        case _:
            return _TRUTH[type(formula)](formula, c)


def _inside(atom: Inside, c: Configuration) -> bool:
    around = _actual_places(c, atom.node) if atom.actually else _believed_places(c, atom.node)
    return next(around, None) == atom.place if atom.directly else atom.place in around


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
    """Tell whether an atom about a variable is true.

    Raises:
        ValueError: The configuration is one of a setting that forgets the variable.
    """
    variable = atom.variable
    if variable not in c.setting.program.watched:
        raise ValueError(
            f"'{variable}' is forgotten once nobody reads it any more: begin with watching(initial, properties)"
        )
    return c.test(store_cell(variable.agent), is_true_of, atom)


def is_true_of(store: Store | None, atom: VariableIs | IsBound) -> bool:
    """Ask whether an atom about a variable is true of the store in which it is kept."""
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


# --- properties -----------------------------------------------------------------------------------------------
