"""The base of all nodes of the syntax tree: a frozen value with its place in the text."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, fields
from typing import TypeVar, dataclass_transform


@dataclass(frozen=True, slots=True, order=True)
class Span:
    """A range of the mission's text: offsets in characters, `end` excluded."""

    start: int
    end: int

    def to(self, other: Span) -> Span:
        """Return the span from the start of this one to the end of `other`."""
        return Span(self.start, other.end)


NOWHERE = Span(0, 0)


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Node:
    """A piece of syntax. Two nodes are equal if their contents are, wherever they are in the text."""

    span: Span = field(default=NOWHERE, compare=False, repr=False, kw_only=True)

    def _said(self) -> dict[str, object]:
        return {each.name: getattr(self, each.name) for each in fields(self) if each.compare}

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Node) and type(self) is type(other) and self._said() == other._said()

    def __hash__(self) -> int:
        return hash(tuple(self._said().values()))

    def __repr__(self) -> str:
        said = self._said()
        shown = ", ".join(f"{name}=%r" for name in said) % tuple(said.values())
        return f"{type(self).__name__}({shown})"


N = TypeVar("N", bound=Node)


@dataclass_transform(frozen_default=True, field_specifiers=(field,))
def node(cls: type[N]) -> type[N]:
    """Make a class a class of nodes: a frozen dataclass without generated methods, which are slow to compile."""
    return dataclass(frozen=True, slots=True, eq=False, repr=False)(cls)


@node
class Name(Node):
    """`uav0`, `control:gcs0`.

    A name of an entity, a kind, a channel or a variable, by context.
    """

    text: str


def parts(node: Node) -> Iterator[Node]:
    """Yield the child nodes of `node`, in the order of its fields."""
    for spec in fields(node):
        value = getattr(node, spec.name)
        if isinstance(value, Node):
            yield value
        elif isinstance(value, tuple):
            yield from (item for item in value if isinstance(item, Node))


def walk(node: Node) -> Iterator[Node]:
    """Yield `node` and its descendants, parents before their parts."""
    waiting = [node]
    while waiting:
        current = waiting.pop()
        yield current
        waiting.extend(reversed(tuple(parts(current))))
