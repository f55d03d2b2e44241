"""BigraphER's notation as syntax: one class for each thing that can be written; `offset` is where it was."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypeAlias


@dataclass(frozen=True, slots=True)
class Ref:
    """The bigraph of that name."""

    name: str
    offset: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class Number:
    """`1`, the empty region, or `0`, nothing at all."""

    value: int
    offset: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class Ion:
    """A node with a site in it, or none if its control is atomic."""

    control: str
    links: tuple[str, ...] = ()
    offset: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class Nest:
    """An ion with something in it."""

    ion: Ion
    inside: Expression

    @property
    def offset(self) -> int:
        """Return where its first part was."""
        return self.ion.offset


@dataclass(frozen=True, slots=True)
class Identity:
    """`id`, `id(n)`, `id{x}`, `id(n, {x})`."""

    width: int = 1
    names: tuple[str, ...] = ()
    offset: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class Placed:
    """`([{0, 1}, {0}], 2)`: for each site the regions it is in, and the number of regions.

    `merge(n)` and `split(n)` are read as such.
    """

    parents: tuple[tuple[int, ...], ...]
    regions: int
    offset: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class Close:
    """`/x`, or `/{x, y}`: names joined into one edge."""

    names: tuple[str, ...]
    offset: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class Substitute:
    """`y/{x, ...}`: names joined into one."""

    outer: str
    inner: tuple[str, ...]
    offset: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class NewNames:
    """`{x}`: idle names."""

    names: tuple[str, ...]
    offset: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class Wired:
    """Closures and substitutions before what they apply to, the last one first."""

    wires: tuple[Close | Substitute, ...]
    body: Expression

    @property
    def offset(self) -> int:
        """Return where its first part was."""
        return self.wires[0].offset


@dataclass(frozen=True, slots=True)
class Chain:
    """Operands with the operators between them, from the left; all bind alike."""

    first: Expression
    rest: tuple[tuple[str, Expression], ...]

    @property
    def offset(self) -> int:
        """Return where its first part was."""
        return self.first.offset


@dataclass(frozen=True, slots=True)
class Share:
    """`share what by placing in where`: each region of what is in several sites of where."""

    what: Expression
    by: Expression
    where: Expression
    offset: int = field(default=0, compare=False)


Wire: TypeAlias = Close | Substitute
Expression: TypeAlias = (
    Ref | Number | Ion | Nest | Identity | Placed | Wire | NewNames | Wired | Chain | Share
)


@dataclass(frozen=True, slots=True)
class ControlDeclaration:
    """`ctrl K = 1;` or `atomic ctrl K = 1;`."""

    name: str
    arity: int
    atomic: bool = False
    offset: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class BigDeclaration:
    """`big name = expression;`."""

    name: str
    body: Expression
    offset: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class ReactDeclaration:
    """`react name = redex --> reactum @ [sites];`, the instantiation map None if it is not written."""

    name: str
    redex: Expression
    reactum: Expression
    instantiation: tuple[int, ...] | None = None
    offset: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class PriorityClass:
    """Rules of one priority; instantaneous ones fire without a state between."""

    rules: tuple[str, ...]
    instantaneous: bool = False
    offset: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class System:
    """`begin brs ... end`."""

    init: str
    rules: tuple[PriorityClass, ...]
    predicates: tuple[str, ...] = ()
    offset: int = field(default=0, compare=False)


Declaration: TypeAlias = ControlDeclaration | BigDeclaration | ReactDeclaration


@dataclass(frozen=True, slots=True)
class Model:
    """A `.big` file as written."""

    declarations: tuple[Declaration, ...]
    system: System | None = None
