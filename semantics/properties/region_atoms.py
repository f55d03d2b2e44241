"""Atoms about regions: all points where an entity may be while a configuration lasts, at rest and on its way.

Their truth is in `semantics.regions`; rules never read regions.
"""

from dataclasses import dataclass

from semantics.state.signature import Name


@dataclass(frozen=True, slots=True)
class PossiblyIn:
    """`possibly u in p`: u's region has an interior point of p, and their altitudes meet; or p carries u."""

    entity: Name
    place: Name

    def __str__(self) -> str:
        return f"possibly {self.entity} in {self.place}"


@dataclass(frozen=True, slots=True)
class SurelyIn:
    """`surely u in p`: u is there, and all of its region lies in p; or p carries u."""

    entity: Name
    place: Name

    def __str__(self) -> str:
        return f"surely {self.entity} in {self.place}"


@dataclass(frozen=True, slots=True)
class ApartFrom:
    """`u at least D from v`: no point of u's region is nearer than D to one of v's.

    Attributes:
        entity: The entity u.
        other: The entity v.
        distance: D in metres.
        height: The difference of altitudes in metres that suffices; None stands for D.
    """

    entity: Name
    other: Name
    distance: float
    height: float | None = None

    def __str__(self) -> str:
        height = "" if self.height is None else f" or {_length(self.height)} up"
        return f"{self.entity} at least {_length(self.distance)}{height} from {self.other}"


@dataclass(frozen=True, slots=True)
class WithinRangeOf:
    """`u within D of v`: both are there, and no point of u's region is farther than D (metres) from any of v's."""

    entity: Name
    other: Name
    distance: float

    def __str__(self) -> str:
        return f"{self.entity} within {_length(self.distance)} of {self.other}"


RegionAtom = PossiblyIn | SurelyIn | ApartFrom | WithinRangeOf


def operands(atom: RegionAtom) -> tuple[Name, Name]:
    """Return the two entities that an atom relates."""
    return (atom.entity, atom.place if isinstance(atom, PossiblyIn | SurelyIn) else atom.other)


def _length(metres: float) -> str:
    return f"{metres:g} m"
