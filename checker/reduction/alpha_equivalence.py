"""The correspondence between two agents or entities: the names and variables at equal positions of their texts."""

from dataclasses import dataclass, field, fields, is_dataclass
from typing import Any

from semantics.behaviours.expressions import Literal, Variable
from semantics.behaviours.patterns import Anything, Exactly
from semantics.behaviours.statements import Assign, ChooseFrom, For, ForEach, Spawn
from semantics.behaviours.values import show
from semantics.state.configuration import Configuration
from semantics.state.signature import Name

VARIABLES = {
    (Variable, "name"),
    (Assign, "variable"),
    (For, "rest"),
    (ForEach, "variable"),
    (ForEach, "rest"),
    (ChooseFrom, "variable"),
    (Anything, "variable"),
}
"""The members of statements, expressions and patterns that are names of variables."""

UNLIKE_TEXTS = "their texts differ"


class Unlike(Exception):
    """Two agents or entities are not interchangeable; the message has the reason."""


@dataclass
class Pairing:
    """A correspondence between two sides: names, statements, variables."""

    c: Configuration
    names: dict[str, str] = field(default_factory=dict)
    numbers: dict[int, int] = field(default_factory=dict)
    variables: dict[str, str] = field(default_factory=dict)

    def agents(self, one: Name, other: Name) -> None:
        """Pair two agents with their hosts, their programs, and the names in these."""
        self.pair(self.names, one, other)
        self.pair(self.names, self.c.alpha.host(one), self.c.alpha.host(other))
        self.unify(self.c.alpha.code(one), self.c.alpha.code(other))

    def pair(self, known: dict[Any, Any], one: Any, other: Any) -> bool:
        """Record that one thing corresponds to another; return whether that is new."""
        if one == other or known.get(one) == other:
            return False
        if one in known or one in known.values() or other in known or other in known.values():
            raise Unlike(f"'{one}' and '{other}' stand for each other in one place and not in another")
        known[one] = other
        return True

    def unify(self, one: Any, other: Any) -> None:
        """Pair two pieces of text part by part."""
        if type(one) is not type(other):
            raise Unlike(UNLIKE_TEXTS)
        if isinstance(one, tuple | frozenset):
            self.unify_all(one, other)
        elif isinstance(one, bool) or not isinstance(one, int):
            self.unify_parts(one, other)
        elif self.pair(self.numbers, one, other):
            statements = self.c.setting.program.statements
            self.unify(statements[one], statements[other])

    def unify_all(self, one: Any, other: Any) -> None:
        """Pair the members of two tuples, in order."""
        if len(one) != len(other):
            raise Unlike(UNLIKE_TEXTS)
        ordered = zip(one, other, strict=True) if isinstance(one, tuple) else ()
        for each in ordered:
            self.unify(*each)

    def unify_parts(self, one: Any, other: Any) -> None:
        """Pair the members of two statements, expressions or patterns."""
        if isinstance(one, Literal | Exactly):
            self.unify_values(one.value, other.value)
        elif is_dataclass(one):
            for member in fields(one):
                first, second = getattr(one, member.name), getattr(other, member.name)
                if (type(one), member.name) in VARIABLES and None not in (first, second):
                    self.pair(self.variables, first, second)
                elif isinstance(one, Spawn) and member.name == "name":
                    self.unify_values(first, second)
                else:
                    self.unify(first, second)
        elif one != other:
            raise Unlike(UNLIKE_TEXTS)

    def unify_values(self, one: Any, other: Any) -> None:
        """Pair two constants: names that may be exchanged, or equal values."""
        if isinstance(one, tuple) and isinstance(other, tuple) and len(one) == len(other):
            for each in zip(one, other, strict=True):
                self.unify_values(*each)
        elif isinstance(one, str) and isinstance(other, str) and {one, other} <= self.movable():
            self.pair(self.names, one, other)
        elif type(one) is not type(other) or one != other:
            raise Unlike(f"the text of one has {show(one)} where the other's has {show(other)}")

    def movable(self) -> frozenset[Name]:
        """Return the names that may be exchanged: of agents and of entities."""
        return frozenset((*self.c.alpha.names(), *self.c.setting.kinds))
