"""What a recording has for other programs, held to Foxglove's own schemas."""

import json
import re
from collections import Counter
from datetime import UTC, datetime
from importlib import import_module

import jsonschema
import pytest
from google.protobuf.json_format import ParseDict
from live_missions import EAST, WEST, mission
from test_recording import FLIGHT, HEADER, fly

from adapters.live.batch import GivingBack, Ordering, Saying
from adapters.plugin import StatusText
from adapters.recording.foxglove import FIX, GEOJSON, LOG, MOST_ENTITIES, Showing
from adapters.recording.recording_reader import read_recording
from adapters.recording.schemas import SCHEMAS
from adapters.recording.writing import Recorder
from bigactors.mission_lookup import fixed_places
from physical import box, read_geojson
from semantics.live_policy import Fallback

make_reader = import_module("mcap.reader").make_reader
FENCE = box((36.5, -9), (37.5, -8)).ring


def theirs(schema):
    """Return the class that Foxglove has for a schema."""
    name = schema.removeprefix("foxglove.")
    return getattr(import_module(f"foxglove_schemas_protobuf.{name}_pb2"), name)


def judged(schema, data):
    """Return a message as Foxglove's definition has it, which refuses members and types that it does not know."""
    stamp = data.get("timestamp")
    if stamp is not None:  # protobuf's JSON writes a time as a text
        text = f"{datetime.fromtimestamp(stamp['sec'], UTC):%Y-%m-%dT%H:%M:%S}.{stamp['nsec']:09}Z"
        data = data | {"timestamp": text}
    return ParseDict(data, theirs(schema)())


def shown(path):
    """Return what a file has for other programs, read by MCAP's own reader."""
    with path.open("rb") as file:
        found = [
            (channel.topic, schema, json.loads(message.data))
            for schema, channel, message in make_reader(file, validate_crcs=True).iter_messages()
            if channel.topic.startswith("/")
        ]
    for _, schema, data in found:
        jsonschema.validate(data, json.loads(schema.data))
        judged(schema.name, data)
    return [(topic, schema.name, data) for topic, schema, data in found]


@pytest.fixture(scope="module")
def flown(tmp_path_factory):
    path = tmp_path_factory.mktemp("foxglove") / "run.mcap"
    flight = mission(FLIGHT)
    header = HEADER | {"fences": {"uav0": FENCE, "uav1": FENCE}}
    recorder = Recorder(path, header, 0.0, flight.setting.kinds, fixed_places(flight))
    run = fly(recorder)
    for number, severity in enumerate((0, 4, 6, 7)):
        recorder.report(StatusText("uav0", 2.0, f"text {number}", severity), 2.0)
    words = [Ordering(Fallback.HOLD, "uav9", "Ana"), Saying("a", "go", "Ben"), GivingBack("uav0", "", "")]
    for word in words:
        recorder.turn(run.turn(3.0, sayings=[word]), 3.0, lambda _: ())
    recorder.close("done", 4.0)
    return path, flight


def test_a_recording_has_foxgloves_messages_beside_its_own(flown):
    found = shown(flown[0])
    assert Counter((topic, schema) for topic, schema, _ in found) == {
        ("/places", "foxglove.GeoJSON"): 1,
        ("/uav0/fix", "foxglove.LocationFix"): 3,
        ("/boat0/fix", "foxglove.LocationFix"): 1,
        ("/ais/others/fix", "foxglove.LocationFix"): 1,
        ("/log", "foxglove.Log"): sum(topic == "/log" for topic, _, _ in found),
    }
    fixes = [data for topic, _, data in found if topic == "/uav0/fix"]
    assert [(fix["latitude"], fix["longitude"]) for fix in fixes][::2] == [WEST, EAST]
    assert [fix["timestamp"] for fix in fixes] == [{"sec": sec, "nsec": 0} for sec in range(3)]
    assert {(fix["frame_id"], fix["position_covariance_type"]) for fix in fixes} == {("uav0", 0)}


def test_places_and_fences_are_written_once(flown):
    path, flight = flown
    ((_, _, data),) = [each for each in shown(path) if each[0] == "/places"]
    places = read_geojson(data["geojson"])
    assert {each.entity for each in places} == {*flight.fixed, "fence of uav0, uav1"}
    assert next(each.geometry.ring for each in places if each.kind == "Fence") == FENCE


def test_the_log_has_levels_and_says_who_said_what(flown):
    lines = [
        (data["level"], data["name"], data["message"])
        for topic, _, data in shown(flown[0])
        if topic == "/log"
    ]
    assert lines[0] == (3, "", "tour.mission begins; nothing was verified of this run")
    assert [line for line in lines if "text" in line[2]] == [
        (5, "uav0", "text 0"),
        (3, "uav0", "text 1"),
        (2, "uav0", "text 2"),
        (1, "uav0", "text 3"),
    ]
    assert (2, "uav0", "GoTo east0 (a-1)") in lines
    assert any(re.match(r"ordered to hold by Ana; refused: there is no vehicle", line[2]) for line in lines)
    assert any(line[1:2] == ("a",) and "the message 'go' by Ben" in line[2] for line in lines)
    assert lines[-1] == (2, "", "the run ends: done")


def test_what_other_programs_read_is_no_message_of_ours(flown):
    assert all(
        not message.topic.startswith("/") for message in read_recording(flown[0], arrivals=True).messages
    )


@pytest.mark.parametrize("schema", [FIX, GEOJSON, LOG], ids=lambda schema: schema[0])
def test_our_schemas_have_members_of_theirs(schema):
    name, ours = schema
    assert set(ours["properties"]) <= {field.name for field in theirs(name).DESCRIPTOR.fields}


def positions(showing, *arrivals):
    """Return the topics of what is shown of arrivals, and when."""
    return [
        (each.topic, time)
        for time, entity, ring in arrivals
        for each in showing.of("arrivals", time, {"plugin": "p", "entity": entity, "kind": "K", "ring": ring})
    ]


def test_positions_are_a_second_apart_at_the_least():
    at = [[370000000, -86000000]]
    told = [(k / 10, "uav0", at) for k in range(31)]
    assert positions(Showing(["uav0"]), *told) == [("/uav0/fix", float(k)) for k in range(4)]


def test_a_place_is_written_again_only_when_it_changes():
    ring, other = box((37, -8.6), (36.9, -8.7)).ring, box((37, -8.6), (36.9, -8.8)).ring
    told = [(0.0, "spill", ring), (5.0, "spill", [list(each) for each in ring]), (9.0, "spill", other)]
    assert positions(Showing(["spill"]), *told) == [("/spill/area", 0.0), ("/spill/area", 9.0)]


def test_a_place_that_is_gone_is_drawn_no_more():
    showing, ring = Showing(["spill"]), box((37, -8.6), (36.9, -8.7)).ring
    positions(showing, (0.0, "spill", ring))
    gone = {"plugin": "p", "entity": "spill", "gone": True}
    (empty,) = showing.of("arrivals", 5.0, gone)
    assert json.loads(empty.data["geojson"])["features"] == []
    assert not list(showing.of("arrivals", 9.0, gone))


def test_a_file_has_room_for_so_many_topics():
    names = [f"n{k:05}" for k in range(MOST_ENTITIES + 5)]
    told = [(0.0, name, [[0, 0]]) for name in names]
    topics = Counter(topic for topic, _ in positions(Showing(names), *told))
    assert len(topics) == MOST_ENTITIES + 1
    assert topics["/p/others/fix"] == 5


@pytest.mark.parametrize("time", [-1e300, -1.0, 0.9999999999, 4e9, 1e300])
def test_a_time_that_a_sender_made_up_is_still_a_time(time):
    data = {"plugin": "p", "entity": "uav0", "ring": [[0, 0]], "time": time}
    (fix,) = Showing(["uav0"]).of("arrivals", 1.0, data)
    judged("foxglove.LocationFix", fix.data)


def types(schema):
    """Yield the types of a schema, of arrays with those of their items."""
    yield schema["type"]
    for part in schema.get("properties", {}).values():
        yield from (("number",) if "oneOf" in part else types(part))
    if schema["type"] == "array":
        assert schema["items"]["type"] != "array"
        yield from types(schema["items"])


def test_every_topic_has_a_schema_that_other_programs_know(flown):
    """Lichtblick shows no topic in whose schema something is null, has no type, or is an array of arrays."""
    with flown[0].open("rb") as file:
        schemas = {
            schema.name: json.loads(schema.data)
            for schema in make_reader(file).get_summary().schemas.values()
        }
    assert {name for name, _ in (*SCHEMAS.values(), FIX, GEOJSON, LOG)} == set(schemas)
    for schema in schemas.values():
        assert set(types(schema)) <= {"object", "array", "string", "number", "integer", "boolean"}
    assert "oneOf" in schemas["foxglove.Log"]["properties"]["level"]
    assert "ring" not in schemas["bigactors.arrival/1"]["properties"]
    assert schemas["bigactors.order/1"]["properties"]["order"]["enum"] == ["hold", "return"]
