import pytest

from bigactors.missions import canonical, digest_of, locate, open_mission, shipped_missions
from bigactors.mistakes import Mistake
from physical import circle
from specs.elaboration import Variation


def test_the_digest_is_of_the_text_and_of_what_the_files_say(missions):
    (missions / "a.geojson").write_text(FEATURES % 1)
    (missions / "with_file.mission").write_text(
        'signature { kind Boat driven }\nworld { from "a.geojson" }\ncheck { deadlock_freedom }\n'
    )
    first = digest_of(open_mission("with_file.mission", Variation()))
    assert first == digest_of(open_mission("with_file.mission", Variation()))
    (missions / "a.geojson").write_text(FEATURES % 2)
    assert digest_of(open_mission("with_file.mission", Variation())) != first
    assert digest_of(open_mission("holds.mission", Variation())) != digest_of(
        open_mission("race.mission", Variation())
    )


FEATURES = """{"type": "FeatureCollection", "features": [{"type": "Feature",
  "geometry": {"type": "Point", "coordinates": [%d, 3]}, "properties": {"name": "boat0", "kind": "Boat"}}]}"""


def test_the_digest_does_not_depend_on_where_the_mission_is(missions):
    (missions / "sub").mkdir()
    (missions / "sub" / "same.mission").write_text((missions / "holds.mission").read_text())
    assert digest_of(open_mission("sub/same.mission", Variation())) == digest_of(
        open_mission("holds.mission", Variation())
    )


def test_long_polygons_are_told_apart():
    assert canonical(circle((1, 1), 500)) != canonical(circle((1, 1), 501))


def test_a_file_goes_before_a_shipped_mission_of_its_name(missions):
    assert locate("oil_spill") == shipped_missions()["oil_spill"]
    (missions / "oil_spill").write_text("")
    assert str(locate("oil_spill")) == "oil_spill"


@pytest.mark.usefixtures("missions")
@pytest.mark.parametrize("word", ["", "no\0where", "x" * 5000, "no/such.mission"])
def test_what_is_no_mission_is_told(word):
    with pytest.raises(Mistake):
        locate(word)


def test_what_a_mission_takes_for_a_path_may_not_be_readable(missions, bigactors):
    path = missions / "big.mission"
    path.write_bytes(b"x" * 2_000_000)
    code, _, err = bigactors("check", "big.mission")
    assert code == 2
    assert "LS001" in err
