"""Variables: each binding gets a unique name in the program; printing shows the part before '#'."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from semantics.behaviours.values import Value


@dataclass(slots=True)
class Variables:
    """The names given so far in a mission."""

    taken: dict[str, int] = field(default_factory=dict)
    hidden: int = 0

    def fresh(self, name: str) -> str:
        """Return a name for one more binding of `name`.

        >>> variables = Variables()
        >>> variables.fresh("obs"), variables.fresh("obs")
        ('obs', 'obs#2')
        """
        number = self.taken.get(name, 0) + 1
        self.taken[name] = number
        return name if number == 1 else f"{name}#{number}"

    def rest(self) -> str:
        """Return a name for the remaining members of a `for`."""
        self.hidden += 1
        return f"#{self.hidden}"


@dataclass(slots=True)
class Scope:
    """The names bound in a block, and in the blocks around it.

    Attributes:
        around: The scope of the enclosing block.
        bound: The unique names of variables.
        constants: Names with one value in the whole body; a variable of that name hides it.
    """

    around: Scope | None = None
    bound: dict[str, str] = field(default_factory=dict)
    constants: Mapping[str, Value] = field(default_factory=dict)

    def inner(self) -> Scope:
        """Return the scope of a block inside."""
        return Scope(self, constants=self.constants)

    def find(self, name: str) -> str | None:
        """Return the unique name of a variable."""
        scope: Scope | None = self
        while scope is not None:
            if name in scope.bound:
                return scope.bound[name]
            scope = scope.around
        return None

    @property
    def fixed(self) -> dict[str, Value]:
        """The constants that no variable hides."""
        return {name: value for name, value in self.constants.items() if self.find(name) is None}

    def names(self) -> Iterator[str]:
        """Yield the names of constants and variables."""
        yield from self.constants
        scope: Scope | None = self
        while scope is not None:
            yield from scope.bound
            scope = scope.around
