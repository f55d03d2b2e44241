"""The mission's file: read and saved as it is, never over another program's text, and never outside its folder."""

import json
from base64 import b64encode

import pytest

from bigactors.mistakes import Mistake
from bigactors.studio.mission_file import Overwritten, begin_mission, keep_places, read_mission, save_mission

POINT = {"type": "Point", "coordinates": [-8.6, 37.0]}
BUOY = {"type": "Feature", "properties": {"name": "b", "kind": "Buoy"}, "geometry": POINT}
GEOJSON = json.dumps({"type": "FeatureCollection", "features": [BUOY]}).encode()


def test_line_ends_of_the_file_stay(tmp_path):
    path = tmp_path / "m.mission"
    path.write_bytes(b"mission m\r\n")
    saved = read_mission(path)
    assert saved.text == "mission m\n"
    assert save_mission(path, "mission n\n", saved.digest) == read_mission(path)
    assert path.read_bytes() == b"mission n\r\n"


def test_a_text_is_not_saved_over_what_the_page_does_not_know(tmp_path):
    path = tmp_path / "m.mission"
    path.write_text("one\n", encoding="utf-8")
    known = read_mission(path)
    path.write_text("theirs\n", encoding="utf-8")
    with pytest.raises(Overwritten):
        save_mission(path, "mine\n", known.digest)
    assert path.read_text(encoding="utf-8") == "theirs\n"


def test_a_mission_begins_in_an_empty_file(tmp_path):
    path = tmp_path / "patrol.mission"
    path.write_text(" \n", encoding="utf-8")
    assert begin_mission(tmp_path, "patrol", "") == path
    assert "\nmission patrol\n" in path.read_text(encoding="utf-8")


def test_a_mission_begins_from_the_template_or_a_shipped_one_with_its_recording(tmp_path):
    path = begin_mission(tmp_path, "patrol", "")
    assert "\nmission patrol\n" in path.read_text(encoding="utf-8")
    begin_mission(tmp_path, "port.mission", "harbour_watch")
    assert sorted(each.name for each in tmp_path.iterdir()) == [
        "harbour_watch.nmea",
        "patrol.mission",
        "port.mission",
    ]
    with pytest.raises(Mistake, match="it exists already, and is left as it is"):
        begin_mission(tmp_path, "patrol", "oil_spill")
    with pytest.raises(Mistake, match="no mission that ships is called nothing"):
        begin_mission(tmp_path, "other", "nothing")


@pytest.mark.parametrize("name", ["../up.geojson", ".hidden.geojson", "a/b.plan", "text.txt", ""])
def test_a_dropped_file_leaves_the_folder_under_no_name(tmp_path, name):
    with pytest.raises(Mistake, match="is no file of places"):
        keep_places(tmp_path, name, b64encode(GEOJSON).decode())
    assert list(tmp_path.iterdir()) == []


def test_a_dropped_file_is_kept_if_it_has_places_and_replaces_no_other(tmp_path):
    kept = b64encode(GEOJSON).decode()
    assert keep_places(tmp_path, "b.geojson", kept) == keep_places(tmp_path, "b.geojson", kept) == "b.geojson"
    assert (tmp_path / "b.geojson").read_bytes() == GEOJSON
    with pytest.raises(Mistake, match="another file beside the mission has this name"):
        keep_places(tmp_path, "b.geojson", b64encode(GEOJSON + b" ").decode())
    with pytest.raises(Mistake, match=r"c\.geojson: the text is not JSON"):
        keep_places(tmp_path, "c.geojson", b64encode(b"{").decode())
    with pytest.raises(Mistake, match="the file has not arrived whole"):
        keep_places(tmp_path, "d.geojson", "?")
    assert not (tmp_path / "c.geojson").exists()
