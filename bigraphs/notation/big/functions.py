"""One declaration with parameters for several that are given for values: `fun big b(n) = K(n);` for `b(1)` and `b(2)`.

BigraphER reads the first alone. What differs between the given ones has to follow from their arguments: it is one of
them, or one of them and a number.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, TypeVar

from bigraphs.notation.big.declarations import BigDeclaration, ReactDeclaration
from bigraphs.notation.big.syntax import Arithmetic, Literal, Negated, ValueExpression, Variable
from bigraphs.records import WHERE, Record
from bigraphs.system import Value

Given = TypeVar("Given", BigDeclaration, ReactDeclaration)
_Record = TypeVar("_Record", bound=Record)


class _Different(Exception):
    """Two declarations differ where no argument says why."""


def folded(given: Iterable[Given], taken: Iterable[str] = ()) -> list[Given]:
    """Return declarations, those of one name as one with parameters if that is possible; `taken` are names in use."""
    groups: dict[str, list[Given]] = {}
    for each in given:
        groups.setdefault(each.name, []).append(each)
    used = frozenset(taken)
    return [each for group in groups.values() for each in _as_one(group, used)]


def _as_one(group: Sequence[Given], taken: frozenset[str]) -> Sequence[Given]:
    arguments = [tuple(map(_value, each.arguments)) for each in group]
    if not all(arguments) or any(value is None for values in arguments for value in values):
        return group
    columns = list(zip(*arguments, strict=False))
    if len({len(values) for values in arguments}) > 1 or any(
        len(set(map(type, column))) > 1 for column in columns
    ):
        return group
    names = [_fresh(f"p{place}", taken) for place in range(len(columns))]
    try:
        body: Given = _Folding(names, columns).of([changed(each, arguments=()) for each in group])
    except _Different:
        return group
    return [changed(body, parameters=tuple(names))]


def _fresh(name: str, taken: frozenset[str]) -> str:
    while name in taken:
        name += "'"
    return name


def _value(expression: ValueExpression) -> Value | None:
    """Return the value of a literal, with or without a sign."""
    match expression:
        case Literal(value):
            return value
        case Negated(Literal(int() | float() as value)):
            return -value
        case _:
            return None


def changed(record: _Record, **fields: Any) -> _Record:
    """Return a record with other values of some fields."""
    values = {name: getattr(record, name) for name in record.__match_args__} | fields
    return type(record)(**values)


class _Folding:
    """Several values on their way to one that has parameters in it."""

    def __init__(self, names: Sequence[str], columns: Sequence[Sequence[Any]]) -> None:
        self.names, self.columns = names, columns

    def of(self, several: Sequence[Any]) -> Any:
        """Return what several values have in common, and parameters where they differ."""
        first = several[0]
        if all(type(each) is type(first) and each == first for each in several):
            return first
        if all(isinstance(each, Literal | Negated) for each in several):
            return self.parameter([_value(each) for each in several])
        if len(set(map(type, several))) > 1:
            raise _Different
        if isinstance(first, tuple):
            if len(set(map(len, several))) > 1:
                raise _Different
            return tuple(self.of(each) for each in zip(*several, strict=True))
        if isinstance(first, Record):
            names = [name for name in first.__match_args__ if name != WHERE]
            return changed(
                first, **{name: self.of([getattr(each, name) for each in several]) for name in names}
            )
        raise _Different

    def parameter(self, values: Sequence[Value | None]) -> ValueExpression:
        """Return the parameter that has these values, or that has them less a number."""
        for name, column in zip(self.names, self.columns, strict=True):
            if list(column) == list(values) and type(column[0]) is type(values[0]):
                return Variable(name)
        for name, column in zip(self.names, self.columns, strict=True):
            shift = _shift(column, values)
            if shift:
                return Arithmetic(Variable(name), (("+" if shift > 0 else "-", Literal(abs(shift))),))
        raise _Different


def _shift(column: Sequence[Value], values: Sequence[Value | None]) -> int | None:
    """Return by how much each of some whole numbers exceeds its own; None if that is not the same for all."""
    found = {
        after - before if isinstance(before, int) and isinstance(after, int) else None
        for before, after in zip(column, values, strict=True)
    }
    return found.pop() if len(found) == 1 else None
