"""A drift within a place reaches what the drift among very many of its placements reaches, cargo included."""

import random
from functools import cache

import pytest
from elaborating import elaborated, told
from scale import IS_WHOLE, seeds

from checker import Engine, check, explore
from physical import centroid, contains, point
from physical.placement import translate_to
from semantics.state.physical_model import InTransit, Placed

SIGNATURE = """
signature {
  kind Place contains Spill, Drifter, Vessel, UAV
  kind Spill contains Drifter, UAV
  kind Vessel carries Drifter, UAV
  kind UAV driven carries Drifter
  kind Drifter
}
"""
STEP = 0.004
"""Degrees between the listed placements: borders of places are halfway between two of them, or farther."""


def spot(north, east):
    return f"point ({STEP * north:.4f}, {STEP * east:.4f})"


def square(north, east, height, width):
    """A box whose borders keep half a step from the placements that are listed."""
    south, west = STEP * (north - 0.5), STEP * (east - 0.5)
    return f"box ({south:.4f}, {west:.4f}) ({south + STEP * height:.4f}, {west + STEP * width:.4f})"


def world(draw):
    """A sea of 8 by 8 placements, up to three spills in it, a shore, a vessel that drifts, and what it carries."""
    spills = [
        square(*at, draw.choice([1, 2]), draw.choice([1, 2]))
        for at in draw.sample([(0, 1), (1, 5), (4, 1), (5, 5)], draw.randint(1, 3))
    ]
    drum = draw.choice(["", "= circle (0.1, 0.1) radius 200 m ", "= circle (0.1, 0.1) radius 300 m "])
    vessel = draw.choice([spot(3, 3), spot(3, 3), "circle (0.012, 0.012) radius 60 m"])
    uav = draw.choice([f"= {spot(20, 20)}", "carried by v0", f"= {spot(20, 3)}"])
    moving = draw.random() < 0.3
    lines = [
        f"sea: Place = {square(-1, -1, 10, 10)}",
        f"shore: Place = {square(18, 0, 6, 8)}",
        *(f"s{i}: Spill = {each}" for i, each in enumerate(spills)),
        f"v0: Vessel = {vessel}",
        f"d0: Drifter {drum}carried by v0",
        f"u0: UAV {uav}",
    ]
    clauses = [f"s0 drifts among {square(2, 3, 2, 2)}, {square(18, 1, 2, 2)}"] if moving else []
    return lines, clauses


def orders(draw, host):
    places = ["sea", "shore", "s0"]
    steps = [
        f"control(PUT d0 IN {draw.choice([*places, 'u0'])})",
        f"control(MOVE u0 TO {draw.choice([*places, 'v0'])})",
        f"observe(CHILDREN({draw.choice(places)})) react {{ case o => skip }}",
        "observe(PARENT(HOST)) react { case o => skip }",
    ]
    return f"BigActor {'ab'[host == 'u0']} hosted_at {host} with_behavior {{ {' '.join(draw.sample(steps, 2))} }}"


def mission(draw):
    lines, clauses = world(draw)
    programs = "\n".join(orders(draw, host) for host in draw.sample(["v0", "u0"], draw.randint(1, 2)))
    control = draw.choice(["atomic", "timed"])

    def text(drift):
        entries = "\n  ".join(lines)
        environment = "\n  ".join([*clauses, drift])
        return (
            f"{SIGNATURE}\nworld {{\n  {entries}\n}}\n{programs}\n"
            f"environment {{\n  {environment}\n}}\ncontrol {control}"
        )

    return text


def listing(draw, exact):
    """The same drift, among the representatives of its faces and many placements that were chosen without them."""
    (drift,) = (each for each in exact.setting.environment if getattr(each, "within", False))
    by = 2 if IS_WHOLE else 3
    chosen = {point(STEP * north, STEP * east) for north in range(0, 8, by) for east in range(1, 8, by)}
    many = range(15 if IS_WHOLE else 5)
    chosen |= {point(draw.uniform(-0.4, 7.4) * STEP, draw.uniform(-0.4, 7.4) * STEP) for _ in many}
    physical = exact.initial.structure.physical
    here, sea = (physical.position(name).geometry for name in ("v0", "sea"))
    chosen = {each for each in chosen if contains(sea, translate_to(here, each))}
    spots = chosen | {centroid(each.geometry) for each in drift.placements}
    at = ("point ({}, {})".format(*each.vertices[0]) for each in sorted(spots - {centroid(here)}))
    return "v0 drifts among " + ", ".join(at)


def seen(mission):
    """All that is reachable, with relations in the place of positions."""
    known, word, found = {}, cache(repr), set()
    for c in explore(mission.initial, engine=Engine.FAST).configurations:
        placements = tuple(item for item in c.state.items() if item[0][0] == "placement")
        if placements not in known:
            known[placements] = relations(c)
        others = frozenset(word(item) for item in c.state.items() if item[0][0] != "placement")
        found.add((others, known[placements]))
    return found


def relations(c):
    physical, where = c.structure.physical, []
    for name in sorted(c.setting.kinds):
        at = physical.placement(name)
        if isinstance(at, Placed | InTransit):
            aboard = at.to if isinstance(at, InTransit) else ""
        else:
            aboard = None if at is None else at.by
        kinds = c.setting.containers(c.setting.kind(name))
        inside = tuple(place for place in kinds if physical.contains(place, name))
        exactly = at if name not in ("v0", "d0", "u0") else None
        where.append((name, type(at).__name__, aboard, inside, physical.abstract_parent(name), exactly))
    return tuple(where)


@seeds(60, 5)
def test_a_drift_within_a_place_reaches_what_a_drift_among_its_placements_reaches(seed):
    draw = random.Random(seed)
    text = mission(draw)
    exact = elaborated(text("v0 drifts within sea"))
    listed = elaborated(text(listing(draw, exact)))
    assert seen(exact) >= seen(listed)
    assert seen(exact) <= seen(listed)


# --- refused where it would not be exact ----------------------------------------------------------------------------


CARGO = """
signature {
  kind Place contains Vessel, Boom, Drifter
  kind Boom contains Drifter
  kind Fence driven contains Drifter
  kind Vessel carries Drifter, Boom
  kind Drifter
}
world {
  sea: Place = box (0.0, 0.0) (0.1, 0.1)
  v0: Vessel = point (0.05, 0.05)
  d0: Drifter CARRIED
  x0: OTHER
}
environment { v0 drifts within sea }
"""


BOOM = "Boom = circle (0.05, 0.05) radius 50 m carried by v0"
FENCE = "Fence = circle (0.2, 0.2) radius 50 m"
DENTED = "= polygon (0.01, 0.01) (0.01, 0.03) (0.015, 0.015) (0.03, 0.01) carried by v0"


@pytest.mark.parametrize(
    ("drifter", "other", "reason"),
    [
        ("= point (0.2, 0.3)", BOOM, "'x0', which it may carry, may contain 'd0' once it is put down"),
        ("carried by v0", FENCE, "'x0', which may contain 'd0' from aboard, moves too"),
        (
            DENTED,
            "Vessel = point (0.2, 0.2)",
            "an entity that drifts within a place, and its cargo, is a point or convex: faces are known for those only",
        ),
    ],
)
def test_a_drift_is_refused_where_what_stands_there_would_tell_infinitely_many_placements_apart(
    drifter, other, reason
):
    found = told(CARGO.replace("CARRIED", drifter).replace("OTHER", other))
    assert [message for _, message, _ in found] == [reason]


def test_what_can_never_be_aboard_cuts_nothing():
    never = CARGO.replace("CARRIED", "= point (0.2, 0.3)").replace("OTHER", BOOM.partition(" carried")[0])
    (drift,) = elaborated(never).setting.environment
    assert len(drift.placements) == 1


# --- time -----------------------------------------------------------------------------------------------------------

BARGE = """
signature {
  kind Bay contains Boat, Pad, UAV
  kind Boat carries Pad
  kind Pad carries UAV
  kind UAV driven
}
world {
  bay0: Bay = box (0.0, 0.0) (0.1, 0.1)
  bay1: Bay = box (0.0, 0.2) (0.1, 0.3)
  boat0: Boat = point (0.05, 0.05) linked wifi
  pad0: Pad carried by boat0
  uav0: UAV = point (0.05, 0.25) linked wifi
}
BigActor b hosted_at boat0 with_behavior {
  control(PUT pad0 IN bay0)
  observe(PARENT(pad0))
  react { case o => skip }
  send "there" to a
}
BigActor a hosted_at uav0 with_behavior { react { case "there" => control(MOVE_HOST_TO pad0) } }
environment { boat0 drifts within bay0 uav0 arrives }
timing { UAV flies at 20 m/s }
control timed
check { time "arrives": actually uav0 in pad0 }
"""


@pytest.mark.parametrize("engine", [Engine.REFERENCE, Engine.FAST])
def test_nothing_is_known_of_a_flight_to_what_was_put_down_by_what_drifts(engine):
    report = check(elaborated(BARGE), engine=engine)
    assert report.verdicts["arrives"].note.startswith("at 0:00 at the earliest")
