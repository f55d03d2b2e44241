"""Folding of declarations for particular arguments into one with parameters.

`fun big b(n) = K(n);` replaces the declarations of `b(1)` and `b(2)`; BigraphER reads only that form. Each difference
between the declarations must be an argument, or an argument plus or minus a constant.
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
    """Two declarations have a difference that is no function of an argument."""


def folded(given: Iterable[Given], taken: Iterable[str] = ()) -> list[Given]:
    """Return the declarations; those of one name become one with parameters if possible. `taken` are names in use."""
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
    """The fold of several values into one with parameters."""

    def __init__(self, names: Sequence[str], columns: Sequence[Sequence[Any]]) -> None:
        self.names, self.columns = names, columns

    def of(self, several: Sequence[Any]) -> Any:
        """Return the common form of several values, with parameters where they differ."""
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
        """Return the parameter with these values, or a parameter plus or minus a constant."""
        for name, column in zip(self.names, self.columns, strict=True):
            if list(column) == list(values) and type(column[0]) is type(values[0]):
                return Variable(name)
        for name, column in zip(self.names, self.columns, strict=True):
            shift = _shift(column, values)
            if shift:
                return Arithmetic(Variable(name), (("+" if shift > 0 else "-", Literal(abs(shift))),))
        raise _Different


def _shift(column: Sequence[Value], values: Sequence[Value | None]) -> int | None:
    """Return the common difference between integers and their counterparts; None if there is none."""
    found = {
        after - before if isinstance(before, int) and isinstance(after, int) else None
        for before, after in zip(column, values, strict=True)
    }
    return found.pop() if len(found) == 1 else None
