"""Regions beside an oracle that flies: vehicles really move along random runs, and claims are held to where they are.

The oracle knows no regions. A vehicle flies shortest lines from where it really is: to some point of each place of its
VIA, to some point of its destination, and after the commit on to the waypoint. It may be anywhere on its way whenever
it is looked at. Where the mission says `strays`, it flies from waypoint to waypoint, and is off its line by up to that.
"""

import math
import random

import pytest
from pyproj import Geod
from scale import IS_WHOLE, long_ones

from physical import contains, distance, point, waypoint
from semantics.behaviours.reaction_rules import moved
from semantics.properties.property import watching
from semantics.properties.propositions import holds
from semantics.properties.region_atoms import ApartFrom, PossiblyIn, SurelyIn, WithinRangeOf
from semantics.state.physical_model import Carried, InTransit, Placed
from semantics.state.requests import FLY
from semantics.successors import successors
from specs.elaboration import read_mission

EARTH = Geod(ellps="WGS84")

SIGNATURE = """
signature {
  kind Area contains Area, Spot, UAV, Vessel, Station
  kind Spot contains UAV
  kind UAV driven
  kind Vessel driven carries UAV
  kind Station
}
control timed
"""


def text_of(seed):
    """Return a mission with a dented and a drifting place, a vessel, and UAVs that fly by places and by the vessel."""
    draw = random.Random(seed)
    ways = ["bay0", "hook0", "east0", "spot0", "ship0"]

    def flight():
        to = draw.choice(ways)
        via = draw.sample(
            [each for each in ("east0", "hook0", "spot0") if each != to], draw.choice([0, 0, 1, 2])
        )
        return f"control(MOVE_HOST_TO {to}{' VIA ' + ', '.join(via) if via else ''})"

    strays = draw.choice(
        ["", "UAV strays at most 40 m", "UAV strays at most 40 m\n  Vessel strays at most 90 m"]
    )
    more = draw.choice(["", "spot0 drifts among point (37.03, -8.55), point (37.06, -8.58)", "uav0 vanishes"])
    sails = draw.choice(["", "control(MOVE_HOST_TO east0)", "control(MOVE_HOST_TO hook0)"])
    return f"""{SIGNATURE}
world {{
  bay0: Area = box (37.02, -8.6) (37.0, -8.63)
  hook0: Area = polygon (37.05, -8.66) (37.05, -8.62) (37.04, -8.62) (37.04, -8.65) (37.02, -8.65) (37.02, -8.66)
  cove0: Area = circle (37.01, -8.615) radius 300 m
  east0: Area = circle (37.03, -8.52) radius 900 m
  spot0: Spot = circle (37.03, -8.55) radius 200 m
  uav0: UAV = point (37.004, -8.604)
  uav1: UAV = point (37.047, -8.655)
  ship0: Vessel = point (37.008, -8.625)
  gcs0: Station = point (37.03, -8.6)
}}
BigActor a hosted_at uav0 with_behavior {{ {flight()} {flight()} {flight()} }}
BigActor b hosted_at uav1 with_behavior {{ {flight()} {flight()} }}
BigActor s hosted_at ship0 with_behavior {{ {sails} }}
environment {{
  {strays}
  {more}
}}
check {{ invariant "p": uav0 at least 1 m from uav1 }}
"""


class Oracle:
    """Where each vehicle really is."""

    def __init__(self, c, draw):
        self.draw = draw
        self.strays = c.setting.strays
        self.spots = {}
        self.ways = {}
        for name, kind in c.setting.kinds.items():
            if kind in ("UAV", "Vessel"):
                self.spots[name] = self.ways[name] = self.at(c, name)
        self.ahead = {name: [] for name in self.spots}
        self.ends = {}
        self.flown = set()

    def at(self, c, name):
        position = c.structure.physical.position(name)
        return None if position is None else waypoint(position.geometry).vertices[0]

    def step(self, before, after):
        """Move on by one transition of the calculus, and then by a random part of each way."""
        for name in self.spots:
            self.change(name, before.structure.physical.placement(name), after)
        for name in sorted(self.spots, key=lambda each: each != "ship0"):
            self.fly(name, after)

    def change(self, name, was, after):
        now = after.structure.physical.placement(name)
        if now == was:
            return
        if isinstance(now, InTransit):
            if isinstance(was, Carried):
                self.ways[name] = self.spots[was.by]
            (plan,) = {
                (*each.request.reaction.via, to)
                for each in after.eta.all()
                if isinstance(each.request, FLY)
                for node, to in moved(each.request.reaction, each.request.match)
                if (node, to) == (name, now.to)
            }
            self.ahead[name] = list(plan)
            self.flown.add(name)
            self.ends = {key: end for key, end in self.ends.items() if key[0] != name}
        elif isinstance(now, Placed) and isinstance(was, InTransit):
            arrived = self.at(after, name) if name in self.strays else self.end(name, was.to, after)
            self.ways[name] = arrived
            self.ahead[name] = [None]
        elif isinstance(now, Placed) and isinstance(was, Carried):
            self.ways[name] = self.spots[was.by]
            self.ahead[name] = []
            self.flown.discard(name)

    def end(self, name, place, c):
        """Return the point of a place to which a vehicle flies; another one when the place has moved."""
        if place in self.spots:
            return self.spots[place]
        at = c.structure.physical.position(place)
        if name in self.strays:
            return self.at(c, place)
        key = (name, place, at)
        if key not in self.ends:
            self.ends[key] = somewhere_in(at.geometry, self.draw)
        return self.ends[key]

    def fly(self, name, c):
        placement = c.structure.physical.placement(name)
        if placement is None:
            self.spots[name] = None
            return
        if isinstance(placement, Carried):
            self.spots[name] = self.ways[name] = self.spots[placement.by]
            return
        while self.ahead[name] and self.draw.random() < 0.7:
            to = self.ahead[name][0]
            end = self.at(c, name) if to is None else self.end(name, to, c)
            if self.draw.random() < 0.4 and len(self.ahead[name]) > 1:
                self.ways[name], _ = end, self.ahead[name].pop(0)
            else:
                self.ways[name] = between(self.ways[name], end, self.draw.random())
                break
        here = self.ways[name]
        if self.draw.random() < 0.8 and name in self.strays and name in self.flown:
            here = off(here, self.draw.uniform(0, 360), self.draw.random() * self.strays[name])
        self.spots[name] = here


def between(one, other, share):
    azimuth, _, metres = EARTH.inv(one[1], one[0], other[1], other[0])
    return off(one, azimuth, share * metres)


def off(here, azimuth, metres):
    longitude, latitude, _ = EARTH.fwd(here[1], here[0], azimuth, metres)
    return latitude, longitude


def somewhere_in(geometry, draw):
    if geometry.is_point:
        return geometry.vertices[0]
    norths, easts = zip(*geometry.vertices, strict=True)
    while True:
        found = draw.uniform(min(norths), max(norths)), draw.uniform(min(easts), max(easts))
        if contains(geometry, point(*found)):
            return found


def told_apart(c, oracle, draw):
    """Yield the atoms whose truth value contradicts where the vehicles are."""
    placed = {name: point(*spot) for name, spot in oracle.spots.items() if spot is not None} | {
        "gcs0": c.structure.physical.position("gcs0").geometry
    }
    for name in set(placed) - {"gcs0"}:
        for place in ("bay0", "hook0", "cove0", "east0", "spot0"):
            inside = contains(c.structure.physical.position(place).geometry, placed[name])
            if inside and not holds(PossiblyIn(name, place), c):
                yield PossiblyIn(name, place)
            if not inside and holds(SurelyIn(name, place), c):
                yield SurelyIn(name, place)
        for other in set(placed) - {name}:
            metres = distance(placed[name], placed[other])
            near, far = (
                ApartFrom(name, other, metres + draw.choice([0.02, 5, 100])),
                WithinRangeOf(name, other, max(metres - draw.choice([0.02, 5, 100]), 0.01)),
            )
            yield from (atom for atom in (near, far) if metres > 0.01 and holds(atom, c))


@pytest.mark.parametrize("seed", range(60) if IS_WHOLE else (3, *long_ones(8, 38)))
def test_no_claim_contradicts_where_the_vehicles_are(seed):
    mission = read_mission(text_of(seed))
    initial, draw = watching(mission.initial, mission.properties), random.Random(seed)
    for _ in range(6):
        c, oracle = initial, Oracle(initial, draw)
        for _ in range(30):
            assert list(told_apart(c, oracle, draw)) == [], f"{text_of(seed)}\n{oracle.spots}\n{c}"
            steps = sorted(successors(c), key=lambda each: str(each.label))
            if not steps:
                break
            before, c = c, draw.choice(steps).target
            oracle.step(before, c)
            for _ in range(3):
                assert list(told_apart(c, oracle, draw)) == [], f"{text_of(seed)}\n{oracle.spots}\n{c}"
                oracle.step(c, c)
    assert math.isfinite(oracle.spots["ship0"][0])
