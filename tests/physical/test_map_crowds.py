"""Crowded maps: what is written and drawn over what, counted on the geometry that is drawn."""

import random
from functools import cache
from itertools import combinations

import pytest
from scale import IS_WHOLE, crossed

from physical import box, point
from physical.drawing import MapEntity, composed
from physical.map_crowds import fanned, folded
from physical.map_labels import RINGS, Box
from physical.map_marks import RADIUS

SIZES = ((420.0, 340.0), (548.0, 378.0))
"""Of a map beside a bigraph, and of one on a page."""


def crowd(size, seed):
    """Return places in rows, stations, and movers on their channels, every fourth of them in one spot."""
    chance = random.Random(seed)
    places, stations = size // 9, max(1, size // 12)

    def anywhere():
        return point(36.9 + chance.random() * 0.2, -8.8 + chance.random() * 0.28)

    crowded = anywhere()
    found = [
        MapEntity(f"area{n}", "Location", box((s + 0.04, w + 0.06), (s, w)), place=True)
        for n in range(places)
        for s, w in [(36.9 + 0.05 * (n // 4), -8.8 + 0.07 * (n % 4))]
    ]
    found += [
        MapEntity(f"gcs{n}", "Station", anywhere(), channels=(f"control:gcs{n}",)) for n in range(stations)
    ]
    for number in range(size - len(found)):
        kind = ("UAV", "Vessel", "Drifter")[number % 3]
        channels = () if kind == "Drifter" else (f"control:gcs{number % stations}",)
        spot = crowded if number % 4 == 0 else anywhere()
        found.append(MapEntity(f"{kind.lower()}{number}", kind, spot, channels=channels))
    return sorted(found, key=lambda entity: entity.name)


def grid(side):
    """Return the cells of a patrol, and a UAV in each corner."""
    cells = [
        MapEntity(f"cell{n}", "Cell", box((s + 0.001, w + 0.001), (s, w)), place=True)
        for n in range(side * side)
        for s, w in [(n // side * 0.002, n % side * 0.002)]
    ]
    ends = (0.0005, (side - 1) * 0.002 + 0.0005)
    uavs = [MapEntity(f"uav{n}", "UAV", point(ends[n // 2], ends[n % 2])) for n in range(4)]
    return sorted([*cells, *uavs], key=lambda entity: entity.name)


WORLDS = {f"crowd of 36, {seed}": crowd(36, seed) for seed in range(3)}
WORLDS |= {f"crowd of 100, {seed}": crowd(100, seed) for seed in range(3 if IS_WHOLE else 1)}
WORLDS |= {f"grid of {side} by {side}": grid(side) for side in (6, 10)}


of_worlds = crossed(list(WORLDS), dict(zip(("beside", "page"), SIZES, strict=True)))


@cache
def drawn(name, size):
    return composed(WORLDS[name], size, {}, ((), ()), ())


@of_worlds
def test_no_name_lies_over_another_or_over_a_marker(name, variation):
    size, (_, writing) = variation, drawn(name, variation)
    written = [*writing.boxes.values(), writing.scale, *(box for box, _, _ in writing.notes)]
    assert [pair for pair in combinations(written, 2) if pair[0].shared(pair[1]) > 0] == []
    assert [label for label in written if any(label.shared(marker) > 0 for marker in writing.markers)] == []
    assert all(
        Box(0, 0, *size).grown(1e-6).shared(label) == pytest.approx(label.width * label.height)
        for label in written
    )


@of_worlds
def test_every_marker_has_its_name_beside_it(name, variation):
    scene, writing = drawn(name, variation)
    unnamed = [each for each in writing.unnamed if not scene.is_polygon(each)]
    assert len(unnamed) <= (2 if len(WORLDS[name]) > 99 else 0)  # a note names them
    for each, label in writing.boxes.items():
        (x, y), (wide, high) = label.nearest(writing.wanted[each].at), writing.wanted[each].clearance
        to_x, to_y = abs(x - writing.wanted[each].at[0]), abs(y - writing.wanted[each].at[1])
        assert to_x <= wide + RINGS[-1] + 0.01
        assert to_y <= high + RINGS[-1] + 0.01
    if name.startswith("crowd of 36"):  # every name is written or counted
        counted = {each for names in scene.members.values() for each in names}
        assert counted | set(writing.boxes) == {entity.name for entity in WORLDS[name]}


def test_twelve_that_are_alike_in_one_spot_are_one_marker_that_says_so():
    uavs = [MapEntity(f"uav{n}", "UAV", point(37, -8.7)) for n in range(2, 14)]
    entities = sorted(
        [MapEntity("gcs0", "Station", point(37.002, -8.702)), *uavs], key=lambda entity: entity.name
    )
    scene, writing = composed(entities, SIZES[0], {}, ((), ()), ())
    written = {name: [line.text for line in lines] for name, lines in writing.blocks.items()}
    assert written == {"gcs0": ["gcs0"], "uav2": ["UAV ×12"]}
    assert scene.members == {"uav2": tuple(f"uav{n}" for n in range(2, 14))}


def test_what_is_in_a_place_is_not_folded_with_what_is_beside_it():
    within = [MapEntity(f"uav{n}", "UAV", point(37, -8.7)) for n in range(4)]
    beside = [MapEntity(f"uav{n}", "UAV", point(37, -8.709)) for n in range(4, 9)]
    place = MapEntity("sea0", "Location", box((37.1, -8.705), (36.9, -8.6)), place=True)
    scene, _ = composed([place, *within, *beside], SIZES[0], {}, ((), ()), ())
    assert sorted(map(len, scene.members.values())) == [4, 5]


def test_what_has_just_changed_is_not_folded():
    uavs = [MapEntity(f"uav{n:02}", "UAV", point(37, -8.7)) for n in range(12)]
    _, writing = composed(uavs, SIZES[0], {}, ({"uav03"}, ()), ())
    assert {line.text for lines in writing.blocks.values() for line in lines} == {"UAV ×11", "uav03"}


@pytest.mark.parametrize("count", [2, 3])
def test_few_in_one_spot_are_fanned_out(count):
    spots = list(fanned({f"uav{n}": (50.0, 50.0) for n in range(count)}).values())
    assert all(abs(a[0] - b[0]) + abs(a[1] - b[1]) >= 2 * RADIUS for a, b in combinations(spots, 2))
    assert all(abs(x - 50) <= 14 and abs(y - 50) <= 14 for x, y in spots)


def test_what_lies_apart_stays_where_it_is():
    spots = {"a": (0.0, 0.0), "b": (9.0, 0.0), "c": (0.0, 30.0)}
    assert fanned(spots) == spots
    assert folded(spots, dict.fromkeys(spots, "UAV"), 100.0) == (spots, {})


def test_a_place_whose_name_has_no_room_is_counted_in_a_note():
    _, writing = composed(grid(14), SIZES[0], {}, ((), ()), ())
    assert set(writing.unnamed) == {f"cell{n}" for n in range(196)} - set(writing.boxes)
    ((_, lines, names),) = writing.notes
    assert [line.text for line in lines] == [f"no room to name: Cell ×{len(names)}"]
    assert names == writing.unnamed
