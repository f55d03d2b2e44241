"""The signature, the world and the initial beliefs."""

from __future__ import annotations

from dataclasses import field
from typing import TypeAlias

from specs.syntax.expressions import TextLiteral
from specs.syntax.nodes import Name, Node, node

# --- geometry


@node
class Length(Node):
    """`400 m`, `1.5 km`: metres or kilometres."""

    value: float
    unit: str

    @property
    def metres(self) -> float:
        """The length in metres."""
        return self.value * 1000 if self.unit == "km" else self.value


@node
class Coordinate(Node):
    """`(37.04, -8.59)`, or `(37°02'24"N, 8°35.4'W)`.

    Latitude, then longitude, in degrees (WGS 84); minutes and seconds may be left out, the letter may not.

    Attributes:
        latitude: In degrees, positive in the north.
        longitude: In degrees, positive in the east.
        written: The text of each angle that is written with its letter; else empty.
    """

    latitude: float
    longitude: float
    written: tuple[str, str] = field(default=("", ""), compare=False, repr=False)


@node
class Point(Node):
    """`point (37.08, -8.55)`: one position."""

    position: Coordinate


@node
class Box(Node):
    """`box (37.04, -8.59) (36.94, -8.79)`: two opposite corners, as in the paper's Example 1."""

    first: Coordinate
    second: Coordinate


@node
class Polygon(Node):
    """`polygon (37.10, -8.60) (37.10, -8.50) (37.06, -8.50)`.

    The corners in order. The last is joined to the first.
    """

    corners: tuple[Coordinate, ...]


@node
class Circle(Node):
    """`circle (37.00, -8.70) radius 400 m`: a centre and a radius."""

    centre: Coordinate
    radius: Length


Geometry: TypeAlias = Point | Box | Polygon | Circle


@node
class AltitudeBand(Node):
    """`altitude 100 m to 300 m`, or `altitude 100 m` for a single altitude."""

    lowest: Length
    highest: Length


@node
class Placement(Node):
    """`circle (37.00, -8.70) radius 400 m altitude 0 m to 50 m`.

    The place of an entity. The altitude is optional.
    """

    geometry: Geometry
    altitude: AltitudeBand | None = None


# --- signature


@node
class Kind(Node):
    """`kind Vessel driven carries Drifter, Station contains Person passive`.

    A kind of node. `contains` lists the kinds that may be inside it, `carries` the kinds that it may carry. `driven`
    means that control actions can move it. No reaction applies inside a `passive` kind. All clauses are optional, in
    any order.
    """

    name: Name
    contains: tuple[Name, ...] = ()
    carries: tuple[Name, ...] = ()
    driven: bool = False
    passive: bool = False


@node
class Signature(Node):
    """`signature { kind ... }`, `signature standard` or `signature standard { kind ... }`: the kinds of nodes.

    `standard` declares the kinds of the paper, as shown below; a further declaration of one of them extends it.
    """

    kinds: tuple[Kind, ...]
    standard: bool = False


# --- world


@node
class Entity(Node):
    """`uav0: UAV = point (37.08, -8.55) altitude 90 m to 300 m linked control:gcs0, wifi`.

    Everything after the kind is optional. `drifter0: Drifter carried by vessel0` is on a carrier. `ghost0: UAV absent`
    is not in the world at first.
    """

    name: Name
    kind: Name
    placement: Placement | None = None
    carrier: Name | None = None
    channels: tuple[Name, ...] = ()
    absent: bool = False


@node
class ChannelDeclaration(Node):
    """`channel wifi`: a channel without members."""

    name: Name


@node
class Keep(Node):
    """`BaseStation as Station`, or `Vessel` for `Vessel as Vessel`.

    Keep a kind of the file, as a kind of the mission. `Waypoint as Location radius 50 m` turns points into circles, so
    that they are places.
    """

    recorded: Name
    kind: Name
    radius: Length | None = None


@node
class FromSource(Node):
    """`from "workum.nmea" at "2020-04-07T21:42:00Z" within box (53.1, 5.3) (52.9, 5.5) limit 12`.

    Entities from a file beside the mission: places (GeoJSON, a waypoint file, a plan) or an AIS recording. The time, an
    area and the largest number of entities are optional. So is a prefix of the names: `from "survey.plan" as survey`
    has `survey_waypoint1`. A selection of kinds is `keep Vessel, BaseStation as Station` or `keep Waypoint as Location
    radius 50 m`.
    """

    file: TextLiteral
    prefix: Name | None = None
    time: TextLiteral | None = None
    within: Geometry | None = None
    keep: tuple[Keep, ...] = ()
    limit: int | None = None


WorldEntry: TypeAlias = Entity | ChannelDeclaration | FromSource


@node
class World(Node):
    """`world { ... }`: places, entities, channels and the files they come from."""

    entries: tuple[WorldEntry, ...]


# --- believes


@node
class BelievedIn(Node):
    """`uav0 in searchArea0`, or `uav0 in region` if its place is unknown."""

    entity: Name
    place: Name | None


@node
class BelievedUnknown(Node):
    """`oilSpill0 unknown`: not in L."""

    entity: Name


@node
class BelievedLinked(Node):
    """`uav0 linked control:gcs0, wifi`: exactly these links; `uav0 unlinked` for none."""

    entity: Name
    channels: tuple[Name, ...]


Belief: TypeAlias = BelievedIn | BelievedUnknown | BelievedLinked


@node
class Believes(Node):
    """`believes { ... }`: the differences of the initial L from A(P)."""

    beliefs: tuple[Belief, ...]
