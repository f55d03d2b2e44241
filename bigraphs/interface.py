"""Interfaces: the sites, regions and names by which bigraphs compose."""

from __future__ import annotations

from dataclasses import dataclass

from bigraphs.errors import BigraphError


@dataclass(frozen=True, slots=True)
class Interface:
    """A width (the number of sites or regions) and a set of link names, sorted.

    >>> print(Interface(2, ("y", "x")))
    <2, {x, y}>
    """

    width: int = 0
    names: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if self.width < 0:
            raise BigraphError("interface", f"an interface cannot be {self.width} wide")
        object.__setattr__(self, "names", tuple(sorted(set(self.names))))

    def __mul__(self, other: Interface) -> Interface:
        """Return both interfaces side by side; raises BigraphError if they share a name."""
        shared = set(self.names) & set(other.names)
        if shared:
            raise BigraphError("interface", f"both sides have the name {', '.join(sorted(shared))}")
        return self | other

    def __or__(self, other: Interface) -> Interface:
        """Return both interfaces side by side; a shared name occurs once."""
        return Interface(self.width + other.width, self.names + other.names)

    def __str__(self) -> str:
        return f"<{self.width}, {{{', '.join(self.names)}}}>"
