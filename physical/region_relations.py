"""The four relations over regions, and the nearest points of two.

In doubt `possibly_in` is true and the others are false. The doubt is 0.5 m where both regions lie within 500 km of
their common middle, and 5 m within 1,000 km. Places and entities at certain positions compare exactly.

Raises RegionError where two regions reach farther and their bounds do not decide, or where one covers a pole.
"""

from __future__ import annotations

from typing import NamedTuple

from physical.mission_regions import Located
from physical.shape import Geometry


class Nearest(NamedTuple):
    """The nearest points of two regions, on the ground.

    Attributes:
        metres: Their distance: never more than that of any two points of the regions.
        first: The point of the first region.
        second: The point of the second one.
        gap: The metres of altitude between the two parts; 0 if their bands meet.
    """

    metres: float
    first: Geometry
    second: Geometry
    gap: float = 0.0


def possibly_in(u: Located, place: Located) -> bool:
    """Whether u may be in a place: a point of its region is an interior point of the place's, or it carries u."""
    raise NotImplementedError


def possible_point(u: Located, place: Located) -> Geometry | None:
    """Return a point of u's region that is in a place, or next to it; None if there is none, or it carries u."""
    raise NotImplementedError


def surely_in(u: Located, place: Located) -> bool:
    """Whether u is present, and all of its region is in a certain place and in its band; or the place carries u."""
    raise NotImplementedError


def at_least(u: Located, v: Located, metres: float, up: float | None = None) -> bool:
    """Whether no point of u's region is nearer than `metres` to one of v's.

    Parts whose bands are `up` metres apart or more are apart too (`metres` if `up` is None). It is true if one is
    absent, and false if both have one outermost carrier.
    """
    raise NotImplementedError


def within(u: Located, v: Located, metres: float) -> bool:
    """Whether both are present, and no point of u's region is farther than `metres` from any of v's.

    Of a certain v, the nearest point counts.
    """
    raise NotImplementedError


def nearest(u: Located, v: Located) -> Nearest | None:
    """Return the nearest points of two regions; None if one is absent, or both have one outermost carrier."""
    raise NotImplementedError
