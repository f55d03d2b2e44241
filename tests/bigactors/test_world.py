import json
from collections import Counter
from pathlib import Path

import pytest
from geojson import collection, feature
from shapely.geometry import shape

from physical import point, write_plan, write_waypoints
from semantics.state import physical_model
from semantics.state.physical_model import encloses

pytestmark = pytest.mark.usefixtures("missions")

NMEA = Path(__file__).parents[2] / "specs" / "missions" / "harbour_watch.nmea"


def square(west, south, east, north):
    return [[[west, south], [east, south], [east, north], [west, north], [west, south]]]


def write(path, *features):
    path.write_text(collection(*features), encoding="utf-8")


@pytest.fixture
def harbour(missions):
    write_harbour(missions)
    return missions


def write_harbour(folder):
    write(
        folder / "harbour.geojson",
        feature("harbour0", "Harbour", square(0, 0, 10, 10)),
        feature("berth0", "Berth", square(1, 1, 2, 2)),
        feature("tug0", "Vessel", [1.5, 1.5], channels=["vhf"]),
        feature("crate0", "Crate", [1.5, 1.5], carried_by="tug0"),
        feature("buoy0", "Buoy", [20, 20]),
    )


@pytest.mark.usefixtures("harbour")
def test_the_bigraph_of_a_world_is_printed(done):
    out = done("world", "harbour.geojson")
    names = [line.lstrip("│├└─ ").split(":")[0] for line in out.splitlines()[:6]]
    assert names == ["region 0", "buoy0", "harbour0", "berth0", "tug0", "crate0"]
    assert out.splitlines()[6:] == ["vhf ─ tug0", "5 entities: 1 Berth, 1 Buoy, 1 Crate, 1 Harbour, 1 Vessel"]


def test_it_is_drawn_if_asked(harbour, bigactors):
    code, _, err = bigactors("world", "harbour.geojson", "--output", "world.svg")
    assert (code, err) == (0, "picture written to world.svg\n")
    assert (harbour / "world.svg").read_text(encoding="utf-8").startswith("<svg ")


@pytest.mark.usefixtures("harbour")
@pytest.mark.parametrize(
    ("option", "kept"),
    [
        ("--within=15,15,25,25", "\n1 entity: 1 Buoy (4 others not of these kinds or not within)\n"),
        ("--within=-15,15,25,25", "entity: 1 Buoy"),
        ("--within=-10,170,10,-170", "\n0 entities"),  # across the antimeridian
        ("--kinds=Berth, Harbour", "\n2 entities: 1 Berth, 1 Harbour (3 others"),
    ],
)
def test_only_a_box_and_some_kinds_are_kept(bigactors, option, kept):
    code, out, _ = bigactors("world", "harbour.geojson", option)
    assert (code, kept in out) == (0, True)


def test_a_recording_is_accounted_for(done):
    pytest.importorskip("pyais")
    out = done("world", str(NMEA))
    assert f"{NMEA}: 224 sentences and other lines: " in out
    assert f"{NMEA}: 1 x checksum wrong, not read" in out
    assert f"{NMEA}: 78 positions: 10 stations\n{NMEA}: 68 x position of a station with a newer one" in out


@pytest.mark.usefixtures("harbour")
def test_a_recording_and_a_map_make_one_world(done):
    pytest.importorskip("pyais")
    out = done("world", "harbour.geojson", str(NMEA), "--kinds", "Harbour,Vessel")
    assert "1 Harbour, 9 Vessel" in out


def test_a_time_before_the_recording_shows_nobody(bigactors):
    pytest.importorskip("pyais")
    code, out, err = bigactors("world", str(NMEA), "--at", "1999-01-01T00:00:00Z")
    assert code == 0
    assert "\n0 entities\n" in out
    assert "it runs from 2020-04-07T21:40:33Z to 2020-04-07T21:42:30Z" in err


def test_many_places_are_not_compared_pair_by_pair(missions, bigactors, monkeypatch):
    asked = Counter()

    def counting(*pair):
        asked["encloses"] += 1
        return encloses(*pair)

    monkeypatch.setattr(physical_model, "encloses", counting)
    cells = [
        feature(f"c_{i}_{j}", "Cell", square(i + 0.1, j + 0.1, i + 0.9, j + 0.9))
        for i in range(40)
        for j in range(40)
    ]
    vessels = [feature(f"v{i}", "Vessel", [i + 0.5, i + 0.5]) for i in range(40)]
    write(missions / "grid.geojson", *cells, *vessels, feature("sea", "Sea", square(-1, -1, 41, 41)))
    code, out, err = bigactors("world", "grid.geojson")
    assert (code, err) == (0, "")
    assert "│  └─ v39: Vessel" in out or "   └─ v39: Vessel" in out
    assert asked["encloses"] < 5 * 1641


def test_what_is_not_read_of_a_plan_is_told_by_kind(missions, done):
    plan = json.loads(write_plan([point(1.5, 1.2)], 100.0))
    plan["rallyPoints"]["points"] = [[1, 2, 3], [1, 2, 4]]
    plan["mission"]["items"].append({"type": "ComplexItem", "complexItemType": "StructureScan"})
    (missions / "way.plan").write_text(json.dumps(plan))
    out = done("world", "way.plan")
    assert "way.plan: 5 items: 1 home, 1 waypoint\n" in out
    assert "way.plan: 1 x complex item StructureScan, not read\nway.plan: 2 x rally point, not read\n" in out


def test_places_that_do_not_nest_are_warned_of(missions, bigactors):
    write(
        missions / "overlap.geojson",
        feature("a", "Place", square(0, 0, 2, 2)),
        feature("b", "Place", square(1, 1, 3, 3)),
    )
    code, _, err = bigactors("world", "overlap.geojson")
    assert code == 0
    assert "warning: a and b partly overlap" in err


@pytest.mark.parametrize(
    ("name", "write_file"), [("way.plan", write_plan), ("way.waypoints", write_waypoints)]
)
def test_the_points_of_a_plan_or_waypoint_file_are_read_as_places(harbour, done, name, write_file):
    (harbour / name).write_text(write_file([point(1.5, 1.2), point(30, 30)], 100.0))
    out = done("world", "harbour.geojson", name)
    assert "3 Waypoint" in out
    berth = out[out.index("berth0") :]
    assert "waypoint1" in berth[: berth.index("buoy0") if "buoy0" in berth else None]


@pytest.mark.parametrize(
    ("features", "said"),
    [
        ([feature("a", "Place", [0, 95]), feature("b", "Place", [0, 96])], "feature 2 (b)"),
        ([feature("a", "Crate", [0, 0], carried_by="b")], "a is carried by 'b', which is not there"),
        (
            [feature("a", "Crate", [0, 0], carried_by="b"), feature("b", "Crate", [0, 0], carried_by="a")],
            "a is carried by itself",
        ),
        ([feature("region", "Place", [0, 0])], "an entity is called 'region'"),
    ],
)
def test_a_world_that_makes_no_sense_is_told(missions, refused, features, said):
    write(missions / "world.geojson", *features)
    assert said in refused("world", "world.geojson")


def test_a_world_is_written_for_other_programs(missions, bigactors):
    turning_right = [list(reversed(square(179, 0, 180, 1)[0]))]
    across = {
        "type": "MultiPolygon",
        "coordinates": [square(179, 10, 180, 11), square(-180, 10, -179, 11)],
    }
    write(
        missions / "sea.geojson",
        feature("box0", "Place", turning_right),
        {**feature("box1", "Place", square(0, 0, 1, 1)), "geometry": across},
        feature("buoy0", "Buoy", [20, 20]),
    )
    code, out, err = bigactors("world", "sea.geojson", "--output", "world.geojson")
    assert (code, err) == (0, "3 features written to world.geojson\n")
    written = json.loads((missions / "world.geojson").read_text(encoding="utf-8"))
    shapes = {each["properties"]["name"]: shape(each["geometry"]) for each in written["features"]}
    assert shapes["box0"].exterior.is_ccw
    assert [each.bounds for each in shapes["box1"].geoms] == [(179, 10, 180, 11), (-180, 10, -179, 11)]
    assert all(each.exterior.is_ccw for each in shapes["box1"].geoms)
    assert bigactors("world", "world.geojson")[1] == out
