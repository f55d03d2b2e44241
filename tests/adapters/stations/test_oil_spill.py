"""The paper's oil spill, verified and flown by three stations: what one sees all know, and each has its part.

gcs0 runs the pilot and the tower and has a link to the UAV; gcs1 runs the shore, has a link of its own, and is told of
spills; gcs2 runs nobody and hears the drifters. The UAV obeys, and answers, only the station that has the authority.
"""

from functools import cache
from math import cos, hypot, radians
from operator import itemgetter

import pytest
from company import Station, peers_toml, running
from flown_processes import free_port, until
from water import AIRFIELD, SEARCH, SPILL, Water, drifted

from adapters.recording.recording_reader import read_recording
from bigactors.cli import main
from physical import contains, point
from semantics.state.abstraction import as_it_is

pytestmark = pytest.mark.long

MISSION = "spill_watch"
IDS = {"gcs0": 255, "gcs1": 254, "gcs2": 253}
DRIFTERS = {"drifter0": 263999001, "drifter1": 263999002}
LATE = 3.0
"""Seconds that something takes from the UAV into a recording, at the most; on a busy machine, too."""

EARLY = 0.5
"""Seconds that whom it obeys may be written down later than a station hears it: when it moves next."""

DONE = {
    "⟨commit : FLY(pilot, MOVE_HOST_TO searchArea0)⟩": lambda moment: contains(SEARCH, moment.point),
    "⟨commit : FLY(pilot, MOVE_HOST_TO oilSpill0)⟩": lambda moment: contains(SPILL, moment.point),
    "⟨actuate : CTR(tower, HAND uav0 TO gcs1)⟩": lambda moment: moment.authority == IDS["gcs1"],
    "⟨commit : FLY(shore, MOVE uav0 TO airfield0)⟩": lambda moment: contains(AIRFIELD, moment.point),
}
"""What was true of the UAV when a step was committed."""


def test_the_oil_spill_is_flown_by_three_stations_and_each_recording_replays_equal(tmp_path):
    """One test: all is asked of one flight of less than a minute."""
    stations, water = flown(tmp_path)
    assert water.answers == [b"1 taken\n"]
    assert_each_did_its_part(stations)
    assert_all_saw_what_one_of_them_saw(stations)
    assert_one_heard_each_and_told_the_others(stations)
    assert_nothing_was_committed_that_the_uav_did_not_do(stations, water)
    assert_all_had_the_uav_where_it_really_was(stations, water)
    assert_each_recording_replays_equal(stations)


def flown(folder):
    """Fly it; return the stations, ended, and what was really there."""
    verdict = str(folder / "verdict.json")
    assert main(["check", "--no-traces", "--control", "timed", "--verdict", verdict, MISSION]) == 0
    peers = folder / "peers.toml"
    peers.write_text(peers_toml({name: free_port() for name in IDS}, hosts={"gcs0": ["uav0"]}))
    vehicle, ais, camera = free_port(), free_port(), free_port()
    link = ("--vehicle", f"uav0=udpout:127.0.0.1:{vehicle}")
    names = (f"--name=mmsi:{mmsi}={drifter}" for drifter, mmsi in DRIFTERS.items())
    has = {
        "gcs0": link,
        "gcs1": (*link, f"--feed=detections=http:{camera}"),
        "gcs2": (f"--feed=ais=udp:{ais}", *names),
    }
    stations = [Station(folder, name, peers, MISSION, "--verdict", verdict, *has[name]) for name in IDS]
    with Water(vehicle, ais, camera).going_on() as water, running(stations):
        until(lambda: has_shown(stations, "pilot: {"), 120)
        assert main(["say", "tower", "handover", "--socket", str(stations[0].socket)]) == 0
        until(lambda: has_shown(stations, "shore: {airfield0, gcs0, uav0}"), 120)
        until(lambda: all(whole(station) == HOME for station in stations))
        for station in stations:
            station.interrupt()
    return stations, water


HOME = {
    "uav0": ("airfield0", ("control:gcs1",)),
    "oilSpill0": ("searchArea0", ()),
    "drifter0": ("searchArea0", ()),
    "drifter1": ("oilSpill0", ()),
    "gcs0": ("airfield0", ("control:gcs0", "internet")),
    "gcs1": ("shore0", ("control:gcs1", "internet")),
    "gcs2": ("shore0", ("control:gcs2", "internet")),
}


def has_shown(stations, text):
    """Tell whether an agent has displayed something, where all is as the mission says."""
    said = "".join(station.said for station in stations)
    assert "broken assumption" not in said, said
    return text in said


def whole(station):
    """Return where a station has everything, and on which channels, in A(P); None where its L says otherwise."""
    trace = station.trace()
    if trace is None:
        return None
    structure = as_it_is(trace.configurations[-1]).structure.logical
    model = trace.configurations[-1].structure.logical
    shown, believed = (
        {name: (of.parent(name), of.links(name)) for name in HOME if name in of} for of in (structure, model)
    )
    return shown if shown == believed else None


def read(station, topic):
    """Return what a station has recorded under a topic, with the times."""
    return [(message.time, message.data) for message in recorded(station.recording).of(topic)]


@cache
def recorded(path):
    """Return a recording that has ended."""
    return read_recording(path, arrivals=True)


def labels(station, *rules):
    return [
        (time, step["label"]) for time, step in read(station, "steps") if step["label"][1:].startswith(rules)
    ]


def assert_each_did_its_part(stations):
    done = {each.name: labels(each, "command", "commit", "actuate", "leave", "enter") for each in stations}
    in_all = [step for steps in done.values() for step in steps]
    assert [label for _, label in sorted(in_all, key=itemgetter(0))] == [
        "⟨command : CTR(pilot, MOVE_HOST_TO searchArea0)⟩",
        "⟨commit : FLY(pilot, MOVE_HOST_TO searchArea0)⟩",
        "⟨command : CTR(pilot, MOVE_HOST_TO oilSpill0)⟩",
        "⟨commit : FLY(pilot, MOVE_HOST_TO oilSpill0)⟩",
        "⟨actuate : CTR(tower, HAND uav0 TO gcs1)⟩",
        "⟨leave : shore, gcs1⟩",
        "⟨enter : shore, gcs0⟩",
        "⟨command : CTR(shore, MOVE uav0 TO airfield0)⟩",
        "⟨commit : FLY(shore, MOVE uav0 TO airfield0)⟩",
    ]
    assert [len(done[name]) for name in IDS] == [6, 3, 0]
    ordered = {each.name: [data for _, data in read(each, "commands")] for each in stations}
    told = {  # an order whose place has moved is given again, under the same number
        name: list({data["request"]: data["command"] for data in commands}.values())
        for name, commands in ordered.items()
    }
    assert told == {"gcs0": ["GoTo", "GoTo", "HandOver"], "gcs1": ["GoTo"], "gcs2": []}
    for station in stations:
        assert read(station, "findings") == []


def assert_all_saw_what_one_of_them_saw(stations):
    """What a station did itself is no news to it; all else comes to each, in the order in which it was."""
    there, home = (
        [f"sent to {place}", f"seen in {seen}"]
        for place, seen in (("oilSpill0", "oilSpill0, searchArea0"), ("airfield0", "airfield0"))
    )
    search = ["sent to searchArea0", "seen in searchArea0"]
    handed = ["off control:gcs0", "on control:gcs1"]
    news = {"gcs0": ([], home), "gcs1": (handed, search + there), "gcs2": (handed, search + there + home)}
    for station in stations:
        seen = [label[len("⟨env : ") : -1] for _, label in labels(station, "env")]
        assert {"oilSpill0 appears in searchArea0", "drifter1 is seen in oilSpill0, searchArea0"} < set(seen)
        uav = [each.removeprefix("uav0 is ") for each in seen if each.startswith("uav0")]
        channels, moves = news[station.name]
        assert [each for each in uav if "control:" in each] == channels
        assert [each for each in uav if "control:" not in each] == moves
    assert "pilot: {drifter1, oilSpill0, uav0}" in stations[0].said


def assert_one_heard_each_and_told_the_others(stations):
    feeds = {"oilSpill0": "gcs1", "drifter0": "gcs2", "drifter1": "gcs2"}
    for station in stations:
        heard = read(station, "arrivals")
        for entity, by in feeds.items():
            plugins = {data["plugin"] for _, data in heard if data["entity"] == entity}
            assert len(plugins) == 1
            assert (plugins == {"stations"}) == (station.name != by)
        for drifter, mmsi in DRIFTERS.items():
            (last,) = [data["ring"] for _, data in heard if data["entity"] == drifter][-1]
            assert last == pytest.approx([degrees * 1e7 for degrees in drifted(mmsi)], abs=20)


def assert_each_recording_replays_equal(stations):
    for station in stations:
        recording = read_recording(station.recording)
        assert recording.run["verified"]
        assert recording.run["station"]["here"] == station.name
        assert not recording.torn
        assert len(station.trace()) == len(recording.of("steps"))
        assert whole(station) == HOME
        assert main(["replay", str(station.recording)]) == 0


def assert_nothing_was_committed_that_the_uav_did_not_do(stations, water):
    for station in stations:
        for time, label in labels(station, "commit", "actuate"):
            early = EARLY if "actuate" in label else 0.0
            assert any(map(DONE[label], water.between(time - LATE, time + early))), label


def assert_all_had_the_uav_where_it_really_was(stations, water):
    for station in stations:
        positions = [data for _, data in read(station, "arrivals") if data["entity"] == "uav0"]
        assert len(positions) > 100
        for data in (*positions[:: len(positions) // 100], positions[-1]):
            at = [number / 1e7 for number in data["ring"][0]]
            time = data["time"]
            truth = water.between(time - LATE, time)
            assert min(metres(at, moment.at) for moment in truth) < 1, (station.name, data)
        assert contains(AIRFIELD, point(*at))
    last = water.track[-1]
    assert contains(AIRFIELD, last.point)
    assert last.authority == IDS["gcs1"]


def metres(one, other):
    north, east = (111_194.9 * (a - b) for a, b in zip(one, other, strict=True))
    return hypot(north, east * cos(radians(one[0])))
