"""Two conflicting operational intents of ASTM F3548-21 as a mission: the pair that InterUSS publishes for Kentland.

The standard compares 4-D volumes: two intents conflict if their outlines, altitudes and times meet. The mission flies
inside these volumes. So its flights conform, and they can only come near each other where the volumes conflict.
"""

from dataclasses import dataclass

import pytest
import shapely
from elaborating import elaborated

from checker.check import check
from checker.verdicts import Outcome

FIRST = """(37.19330, -80.59314) (37.19027, -80.59429) (37.18527, -80.59005) (37.18372, -80.58472)
    (37.18697, -80.58073) (37.19118, -80.57796) (37.19736, -80.56931) (37.19893, -80.57104) (37.19764, -80.57674)
    (37.19466, -80.58236) (37.19637, -80.58570)"""
SECOND = """(37.19060, -80.57755) (37.19549, -80.57106) (37.19907, -80.56533) (37.19958, -80.56598)
    (37.19672, -80.57147) (37.19116, -80.57856)"""
SOUTH, BEND, NORTH = (37.1911, -80.5777), (37.1958, -80.5714), (37.1991, -80.5658)


@dataclass(frozen=True)
class Intent:
    """The second intent: its altitudes in metres, its times in seconds, and how far north it is moved in degrees."""

    low: float = 480.0
    high: float = 540.0
    start: int = 320
    end: int = 640
    north: float = 0.0

    def moved(self, spot):
        return f"({spot[0] + self.north:.5f}, {spot[1]})"

    @property
    def outline(self):
        return [(a + self.north, b) for a, b in vertices(SECOND)]


def vertices(text):
    numbers = [float(each) for each in text.replace("(", " ").replace(")", " ").replace(",", " ").split()]
    return list(zip(numbers[::2], numbers[1::2], strict=True))


def conflict(second):
    """Whether the standard calls the two intents conflicting; the first is at 474 to 560 m from 3 to 8 minutes."""
    outlines = shapely.Polygon(vertices(FIRST)).intersects(shapely.Polygon(second.outline))
    return (
        outlines
        and second.low <= 560.0
        and second.high >= 474.0
        and second.start <= 480
        and second.end >= 180
    )


def mission(second):
    outline = " ".join(second.moved(each) for each in vertices(SECOND))
    band = f"altitude {second.low} m to {second.high} m"
    return f"""mission kentland
signature {{
  kind Volume
  kind Pad contains UAV
  kind UAV driven
}}
world {{
  intent0: Volume = polygon {FIRST} altitude 474 m to 560 m
  intent1: Volume = polygon {outline} {band}
  north0: Pad = circle (37.1967, -80.5717) radius 25 m
  bend0: Pad = circle (37.1925, -80.5795) radius 25 m
  west0: Pad = circle (37.1905, -80.584) radius 25 m
  south1: Pad = circle {second.moved(SOUTH)} radius 15 m
  bend1: Pad = circle {second.moved(BEND)} radius 15 m
  north1: Pad = circle {second.moved(NORTH)} radius 15 m
  uav0: UAV = point (37.1967, -80.5717) altitude 474 m to 560 m
  uav1: UAV = point {second.moved(SOUTH)} {band}
}}
BigActor first hosted_at uav0 with_behavior {{
  react {{ after 3 min => control(MOVE_HOST_TO bend0) }}
  control(MOVE_HOST_TO west0)
}}
BigActor second hosted_at uav1 with_behavior {{
  react {{ after {second.start} s => control(MOVE_HOST_TO north1 VIA bend1) }}
}}
control timed
timing {{
  tick 10 s
  UAV flies at 6 m/s to 9 m/s
  agents react within 10 s
}}
check {{
  invariant "conforms": surely uav0 in intent0 and surely uav1 in intent1
  invariant "apart": uav0 at least 100 m or 30 m up from uav1
  within 8 min "first is over": actually uav0 in west0
  within {second.end} s "second is over": actually uav1 in north1
}}
"""


@pytest.mark.parametrize(
    "second",
    [
        pytest.param(Intent(), id="as published"),
        pytest.param(Intent(low=600.0, high=660.0), id="40 m above the first"),
        pytest.param(Intent(start=490, end=810), id="after the first"),
        pytest.param(Intent(north=0.02), id="2 km to the north"),
    ],
)
def test_flights_inside_two_intents_come_near_each_other_only_if_the_intents_conflict(second):
    outcomes = {each.property.name: each.outcome for each in check(elaborated(mission(second))).verdicts}
    assert (outcomes.pop("apart") is Outcome.VIOLATED) == conflict(second)
    assert set(outcomes.values()) == {Outcome.HOLDS}, outcomes
