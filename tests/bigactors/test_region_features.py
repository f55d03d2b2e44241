"""`check --output geojson:FILE`: the regions of flights as RFC 7946 has them."""

import json
from itertools import pairwise

import pytest
import shapely
from pyproj import Geod
from shapely.geometry import shape

pytestmark = pytest.mark.usefixtures("missions")

WGS84 = Geod(ellps="WGS84")
OCEAN = """\
signature {
  kind Location contains UAV
  kind UAV driven
}
world {
  west0: Location = circle (10, 179.8) radius 2 km
  east0: Location = circle (10.2, -179.8) radius 2 km
  mine0: Location = circle (10.1, 180) radius 1 km
  uav0: UAV = point (10, 179.8) altitude 80 m to 120 m
}
BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO east0) }
environment { uav0 strays at most 50 m  uav0 arrives }
control timed
check { invariant "clear": not possibly uav0 in mine0 }
"""


@pytest.fixture
def features_of(bigactors, tmp_path):
    """Check missions; return the features, which keep the rules of RFC 7946."""

    def run(*words):
        path = tmp_path / "regions.geojson"
        bigactors("check", *words, "--output", f"geojson:{path}", "--no-traces")
        collection = json.loads(path.read_text())
        assert list(collection) == ["type", "features", "complete", "notes"]  # §6.1 allows more members
        assert collection["complete"]
        assert collection["type"] == "FeatureCollection"
        for feature in collection["features"]:
            assert set(feature) == {"type", "geometry", "properties"}
            assert_valid(feature["geometry"])
        return collection["features"]

    return run


def assert_valid(geometry):
    """Hold a geometry to §3.1 of the RFC, and to shapely's rules of validity."""
    assert set(geometry) == {"type", "coordinates"}
    made = shape(geometry)
    assert made.is_valid
    assert not made.is_empty
    west, south, east, north = made.bounds
    assert -180 <= west <= east <= 180
    assert -90 <= south <= north <= 90
    for part in shapely.get_parts(made):
        lines = [part.exterior, *part.interiors] if part.geom_type == "Polygon" else [part]
        assert all(abs(there[0] - here[0]) < 180 for line in lines for here, there in pairwise(line.coords))
        if part.geom_type == "Polygon":
            assert shapely.is_ccw(part.exterior)  # the right-hand rule
            assert not any(map(shapely.is_ccw, part.interiors))
            assert all(line.is_closed and len(line.coords) >= 4 for line in lines)


def of_sort(features, sort):
    return [each for each in features if each["properties"]["feature"] == sort]


def test_each_leg_is_a_feature_with_its_ends_and_its_margin(features_of):
    regions = of_sort(features_of("corridor"), "region")
    (leg,) = (each for each in regions if each["properties"]["name"] == "uav0 from northGate0 to east0")
    assert leg["properties"] == {
        "mission": "corridor",
        "feature": "region",
        "name": "uav0 from northGate0 to east0",
        "entity": "uav0",
        "kind": "leg",
        "between": ["northGate0", "east0"],
        "altitude": None,
        "margin_m": 60.0,
    }
    assert {each["properties"]["kind"] for each in regions} == {"leg", "rest", "placed"}
    _, _, metres = WGS84.inv(-8.6, 37.125, -8.56, 37.105)
    area, _ = WGS84.geometry_area_perimeter(shape(leg["geometry"]))
    assert area == pytest.approx(2 * 60 * metres + 3.1416 * 60**2, rel=0.002)


def test_places_that_properties_name_are_features(features_of):
    places = of_sort(features_of("corridor"), "place")
    assert [(each["properties"]["name"], each["properties"]["properties"]) for each in places] == [
        ("area0", ["never outside"]),
        ("prison0", ["never over the prison"]),
    ]


def test_a_violation_has_its_regions_its_breach_and_the_nearest_points(features_of):
    features = features_of("broken_range_of_radio")
    (breach,) = of_sort(features, "breach")
    (reach,) = of_sort(features, "range")
    (line,) = of_sort(features, "nearest points")
    (region,) = of_sort(features, "violating region")
    assert shape(region["geometry"]).contains(shape(breach["geometry"]).representative_point())
    assert not shape(reach["geometry"]).contains(shape(breach["geometry"]).representative_point())
    (first, last) = line["geometry"]["coordinates"]
    _, _, metres = WGS84.inv(*first, *last)
    assert line["properties"]["name"] == "9,879 m, not 6 km"
    assert metres == pytest.approx(9_879, abs=2)


def test_a_region_across_the_antimeridian_is_cut(features_of, tmp_path):
    path = tmp_path / "ocean.mission"
    path.write_text(OCEAN)
    features = features_of(str(path))
    (leg,) = (each for each in of_sort(features, "region") if each["properties"]["kind"] == "leg")
    assert leg["geometry"]["type"] == "MultiPolygon"
    assert leg["properties"]["altitude"] == [80.0, 120.0]
    whole = shape(leg["geometry"])
    azimuth, _, metres = WGS84.inv(179.8, 10, -179.8, 10.2)
    for share in (0.1, 0.49, 0.51, 0.9):
        east, north, _ = WGS84.fwd(179.8, 10, azimuth, share * metres)
        assert whole.contains(shapely.Point(east, north))
    (place,) = of_sort(features, "place")
    assert place["geometry"]["type"] == "MultiPolygon"
    assert of_sort(features, "breach")


def test_the_table_of_ways_is_printed_only_if_it_is_asked_for(bigactors, tmp_path):
    _, out, _ = bigactors("check", "crossing", "--output", f"geojson:{tmp_path / 'a.geojson'}")
    assert "least distance" not in out


@pytest.mark.parametrize(
    ("words", "note"),
    [
        (("oil_spill",), "oil_spill: with 'control atomic' nothing is under way"),
        (("crossing", "--reduce", "por"), "crossing: reduced by por, the check has left configurations out"),
        (("crossing", "--max-configurations", "2"), "crossing: stopped at the limit of 2 configurations"),
        (("nowhere",), "nowhere: there is no such file"),
    ],
)
def test_a_document_that_lacks_regions_says_so(bigactors, tmp_path, words, note):
    path = tmp_path / "a.geojson"
    bigactors("check", *words, "--output", f"geojson:{path}")
    collection = json.loads(path.read_text())
    assert not collection["complete"]
    assert any(each.startswith(note) for each in collection["notes"])
