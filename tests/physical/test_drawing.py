import os
import subprocess
import sys
from dataclasses import replace
from itertools import combinations
from pathlib import Path
from xml.etree import ElementTree

import pytest
import shapely

from physical import box, circle, point, polygon
from physical.drawing import LATITUDES, LONGITUDES, MapEntity, _flights, draw_map
from physical.map_labels import GAP, Box, Wanted, place_labels
from physical.map_scene import scene_of
from physical.map_style import darker, kind_colours, kind_shapes
from physical.map_view import (
    FAR,
    bounds,
    degrees_text,
    focus,
    plane_of,
    scale_length,
    tick_step,
    ticks,
    view_of,
)
from physical.map_writing import writing_of

SHEET = (420.0, 340.0)
SEARCH_AREA = box((37.04, -8.59), (36.94, -8.79))

OIL_SPILL = (
    MapEntity("searchArea0", "Location", SEARCH_AREA, place=True),
    MapEntity("oilSpill0", "OilSpill", circle((37.00, -8.70), 400)),
    MapEntity("uav0", "UAV", point(37.06, -8.55), channels=("control:gcs0",)),
    MapEntity("gcs0", "Station", point(37.07, -8.60), channels=("control:gcs0",)),
    MapEntity("gcs1", "Station", point(36.96, -8.84), channels=("control:gcs1", "network")),
    MapEntity("vessel0", "Vessel", point(36.98, -8.66), channels=("control:gcs1", "network")),
    MapEntity("drifter0", "Drifter", None, carried_by="vessel0"),
    MapEntity("drifter1", "Drifter", None, carried_by="vessel0"),
)

MARINA = (
    MapEntity(
        "marina",
        "Location",
        polygon([(52.969, 5.44), (52.9692, 5.446), (52.966, 5.447), (52.9655, 5.441)]),
        place=True,
    ),
    MapEntity("restricted", "Location", circle((52.9675, 5.4445), 60), place=True),
    MapEntity("uav0", "UAV", point(52.9699, 5.4465)),
    *(
        MapEntity(
            f"mmsi24466{number:04d}", "Vessel", point(52.9665 + number % 5 * 4e-4, 5.4415 + number * 4e-4)
        )
        for number in range(9)
    ),
)


SCENES = {"oil spill": OIL_SPILL, "marina": MARINA, "one entity": OIL_SPILL[2:3]}


def scene(entities, size=SHEET, within=()):
    return scene_of(sorted(entities, key=lambda entity: entity.name), size, {}, (), (), within)


def drawn(entities, **options):
    """Return the elements of a map by their tags."""
    canvas = draw_map(entities, (SHEET[0] + LATITUDES, SHEET[1] + LONGITUDES), **options)
    found = {}
    for element in ElementTree.fromstring(canvas.picture("map").svg).iter():
        found.setdefault(element.tag.rpartition("}")[2], []).append(element)
    return found


def texts_of(entities, **options):
    return {element.text for element in drawn(entities, **options)["text"]}


def degrees(entities):
    """Return the number of longitudes and of latitudes beside a map."""
    texts = texts_of(entities)
    return [
        sum(text.endswith(letters) or text == "0°" for text in texts)
        for letters in (("°E", "°W"), ("°N", "°S"))
    ]


@pytest.mark.parametrize("entities", SCENES.values(), ids=SCENES)
def test_nothing_is_written_over_anything_else(entities):
    writing = writing_of(scene(entities), [])
    written = [*writing.boxes.values(), writing.scale]
    assert all(one.shared(other) == 0 for one, other in combinations(written, 2))
    assert all(label.shared(marker) == 0 for label in written for marker in writing.markers)
    assert all(Box(0, 0, *SHEET).holds((label.left, label.bottom)) for label in written)
    assert all(Box(0, 0, *SHEET).holds((label.right, label.top)) for label in written)


@pytest.mark.parametrize("entities", SCENES.values(), ids=SCENES)
def test_every_entity_is_named(entities):
    assert {entity.name for entity in entities} <= texts_of(entities)


def test_labels_of_places_stand_in_them_where_there_is_room():
    here = scene(MARINA)
    label = writing_of(here, []).boxes["marina"]
    area = shapely.Polygon(here.outlines["marina"])
    assert area.contains(shapely.box(*label))


def test_the_order_of_entities_leaves_no_trace():
    forwards, backwards = (writing_of(scene(each), []) for each in (OIL_SPILL, OIL_SPILL[::-1]))
    assert forwards == backwards


def entity(name, at=None, kind="UAV", **more):
    return MapEntity(name, kind, at, **more)


FLYING = entity("uav0", point(37.06, -8.55), towards="searchArea0", destination=SEARCH_AREA)


def test_a_flight_goes_by_the_places_of_its_way():
    shore = [each for each in OIL_SPILL if each.name != "uav0"]
    gate = entity("gate0", point(37.05, -8.5), kind="Location", place=True)
    shown = scene([*shore, gate, replace(FLYING, via=(gate.geometry,))])
    (_, first), (_, last) = _flights(shown)
    assert first[2] == last[0] == shown.middle("gate0")
    assert len(list(_flights(scene([*shore, gate, FLYING])))) == 1


WRITTEN = {
    "who is absent": ([*OIL_SPILL, entity("uav7"), entity("uav8")], {"not in P: uav7, uav8"}),
    "what an absent carrier holds": ([entity("a", carried_by="b"), entity("b")], {"not in P: a, b"}),
    "carriers in a circle": ([entity("a", carried_by="b"), entity("b", carried_by="a")], {"not in P: a, b"}),
    "where a flight is bound for": ([OIL_SPILL[0], FLYING], {"uav0", "→ searchArea0"}),
    "the scale of an empty world": ([], {"100 m", "N"}),
    "a name that looks like a formula": ([entity("$x_0$", point(1, 1))], {"$x_0$"}),
    "who is at a pole": ([entity("uav0", point(90, 0)), entity("uav1", point(89.9, 90))], {"uav0", "uav1"}),
}


@pytest.mark.parametrize("what", WRITTEN)
def test_a_map_says(what):
    entities, expected = WRITTEN[what]
    assert expected <= texts_of(entities)


def test_cargo_is_named_with_its_carrier_at_any_depth():
    inner = MapEntity("egg", "Drifter", None, carried_by="drifter0")
    assert scene([*OIL_SPILL, inner]).cargo("vessel0") == [(0, "drifter0"), (1, "egg"), (0, "drifter1")]


def test_a_map_shows_its_coasts_and_says_how_exact_they_are():
    assert len(scene(OIL_SPILL).land) == 1
    assert {"N", "5 km", "coasts ± 1 km"} <= texts_of(OIL_SPILL)


def test_a_map_of_a_harbour_shows_no_coast_since_it_would_mislead():
    assert scene(MARINA).land == ()
    assert not any("coasts" in text for text in texts_of(MARINA))


def test_a_coast_across_the_antimeridian_lies_where_the_islands_are():
    taveuni = MapEntity("v", "Vessel", point(-16.85, -179.97))
    places = [taveuni, MapEntity("w", "Vessel", point(-16.2, 179.2))]
    here = scene(places)
    land = shapely.union_all([shapely.Polygon(rings[0]) for rings in here.land])
    assert land.contains(shapely.Point(here.middle("v")))


def test_a_far_entity_is_pointed_at_and_does_not_shrink_the_rest():
    far = MapEntity("farVessel", "Vessel", point(53.4, 6.2))
    near, both = scene(MARINA), scene([*MARINA, far])
    assert both.far == {"farVessel"}
    assert both.sheet.view.width == pytest.approx(near.sheet.view.width, rel=0.01)
    assert {"farVessel", "69 km away"} <= texts_of([*MARINA, far])


def test_a_map_shows_what_it_is_for_and_points_at_what_lies_beyond():
    within = tuple(each.geometry for each in OIL_SPILL if each.geometry)
    one, other = (scene(each, within=within).sheet.view for each in (OIL_SPILL, OIL_SPILL[:2]))
    assert one == other
    far = MapEntity("farVessel", "Vessel", point(38.4, -8.7))
    assert "farVessel" in texts_of([*OIL_SPILL, far], within=within)
    assert scene([*OIL_SPILL, far], within=within).sheet.view == one


def test_metres_are_as_long_to_the_north_as_to_the_east():
    sheet = scene([MapEntity("a", "Sea", box((70.1, 20.3), (70.0, 20.0)), place=True)]).sheet
    area = bounds(sheet.outline(box((70.1, 20.3), (70.0, 20.0))))
    metres_per_degree = 111_583.0, 38_290.0  # of latitude and longitude at 70.05 north
    expected = metres_per_degree[1] * 0.3 / (metres_per_degree[0] * 0.1)
    assert area.width / area.height == pytest.approx(expected, rel=0.01)


def test_a_world_across_the_antimeridian_is_in_one_piece():
    lagoon = MapEntity("lagoon", "Location", box((-17, 179.5), (-18, -179.2)), place=True)
    world = [lagoon, MapEntity("v", "Vessel", point(-17.2, -179.9))]
    assert scene(world).sheet.view.width < 400_000
    assert {"lagoon", "v", "179.5°E", "180.0°", "179.5°W"} <= texts_of(world)


def test_a_world_shifted_around_the_earth_looks_the_same():
    def shifted(by):
        return [MapEntity(f"v{n}", "Vessel", point(10 + n, (n + by + 180) % 360 - 180)) for n in range(5)]

    assert scene(shifted(0)).middle("v3") == pytest.approx(scene(shifted(178)).middle("v3"))


@pytest.mark.parametrize("metres", [500, 50_000])
def test_scale_and_ticks_suit_the_size(metres):
    span = metres / 111_000
    world = [MapEntity("a", "Sea", box((50, 8), (50 + span, 8 + span)), place=True)]
    assert all(2 <= count <= 6 for count in degrees(world))
    view = scene(world).sheet.view
    assert scale_length(view.width) * 2.5 <= view.width * 1.0001
    assert ({"100 m"} if metres == 500 else {"10 km"}) <= texts_of(world)


def test_ticks_are_round_and_few():
    assert ticks(36.91, 37.13, 4) == pytest.approx((37.0, 37.1))
    assert tick_step(0.22, 4) == 0.1
    assert degrees_text(36.94, 0.02, "NS") == "36.94°N"
    assert degrees_text(-8.79, 0.01, "EW") == "8.79°W"


def test_focus_keeps_everything_that_lies_together():
    near = [Box(x, 0, x + 1, 1) for x in range(8)]
    assert focus(near) == tuple(range(8))
    assert focus([*near, Box(9 * FAR * 100, 0, 9 * FAR * 100, 0)]) == tuple(range(8))
    assert focus([Box(0, 0, 0, 0), Box(1e6, 0, 1e6, 0)]) == (0, 1)


def test_a_view_has_the_aspect_of_its_sheet_and_holds_everything():
    view = view_of([Box(0, 0, 1000, 10_000)], 1.5)
    assert view.width / view.height == pytest.approx(1.5)
    assert view.top > 10_000
    assert view.bottom < 0


def test_a_plane_is_cut_where_the_earth_is_emptiest():
    assert plane_of([point(0, 170), point(0, -170)]).longitude == -180


def test_labels_make_room_for_each_other():
    crowded = [Wanted((100, 100), (40, 10), (5, 5)) for _ in range(12)]
    boxes = place_labels(crowded, [], [], Box(0, 0, 200, 200))
    assert all(one.grown(GAP - 1e-6).shared(other) == 0 for one, other in combinations(boxes, 2))


def test_labels_without_room_are_placed_all_the_same():
    assert len(place_labels([Wanted((5, 5), (40, 10))] * 3, [], [], Box(0, 0, 10, 10))) == 3


def test_labels_avoid_lines():
    (label,) = place_labels(
        [Wanted((100, 100), (40, 10), (5, 5))], [], [(120 + x, 100) for x in range(20)], Box(0, 0, 200, 200)
    )
    assert label.right < 100


def test_kinds_have_a_colour_and_a_shape_each():
    kinds = ["UAV", "Vessel", "Station", "Location", "OilSpill", "Net"]
    assert len(set(kind_colours(kinds).values())) == len(set(kind_shapes(kinds).values())) == len(kinds)
    assert len(kind_colours(f"k{n}" for n in range(40))) == 40
    assert darker("#ffffff") == "#999999"


def test_highlight_and_marks_add_strokes():
    plain, both = (
        sum(len(found) for tag, found in each.items() if tag in ("path", "circle"))
        for each in (
            drawn(OIL_SPILL),
            drawn(OIL_SPILL, highlight={"uav0", "oilSpill0"}, marked={"uav0", "drifter0"}),
        )
    )
    assert both == plain + 4


def test_long_names_stay_on_the_sheet():
    long = [MapEntity("n" * 300 + str(n), "UAV", None) for n in range(3)]
    assert all(len(text) < 150 for text in texts_of([*OIL_SPILL, *long]))


def test_pictures_are_the_same_under_two_hash_seeds():
    program = (
        "import sys; sys.path.insert(0, sys.argv[1]); import test_drawing; print(test_drawing.everything())"
    )
    seed = "2" if os.environ.get("PYTHONHASHSEED") == "1" else "1"
    there = subprocess.run(
        [sys.executable, "-c", program, str(Path(__file__).parent)],
        env={**os.environ, "PYTHONHASHSEED": seed},
        check=True,
        capture_output=True,
        text=True,
    )
    assert there.stdout.strip() == everything()


def everything():
    """Return a picture, as text."""
    names = {entity.name for entity in OIL_SPILL}
    return draw_map(set(OIL_SPILL), SHEET, highlight=names, marked=names).shapes


def test_channels_between_the_same_two_do_not_hide_each_other():
    both = ("control:gcs0", "network")
    world = [
        MapEntity("gcs0", "Station", point(1, 1), channels=both),
        MapEntity("u", "UAV", point(1, 2), channels=both),
    ]
    curves = [path.get("d") for path in drawn(world)["path"] if "Q" in path.get("d")]
    assert len(curves) == len(set(curves)) == 2
