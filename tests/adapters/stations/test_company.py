"""Three stations as processes over loopback: one is killed, one is cut off, and all come to one world."""

from contextlib import ExitStack

import pytest
from company import EAST, NOWHERE, WEST, WORLD, Cable, Station, agree, peers_toml, running
from flown_processes import free_port, until

from adapters.console.history import History
from adapters.recording.recording_reader import read_recording
from bigactors.commands.console.recorded_history import rules_of

pytestmark = pytest.mark.long

MISSION = (
    "mission company\n"
    + WORLD
    + """
BigActor op0 hosted_at gcs0 with_behavior { loop { react { case "ready" => skip } } }
environment { boat0 drifts among point (37.005, -8.605), point (37.005, -8.645)
              boat1 drifts among point (37.005, -8.605), point (37.005, -8.645)
              says "ready" to op0 at most once }
"""
)


@pytest.fixture
def three(tmp_path):
    """Three stations; all that goes to or from gcs2 goes over cables."""
    mission = tmp_path / "company.mission"
    mission.write_text(MISSION)
    ports = {name: free_port() for name in ("gcs0", "gcs1", "gcs2")}
    with ExitStack() as stack:
        cables = {}
        for name, port in ports.items():
            cables[name] = Cable(port)
            stack.callback(cables[name].close)
        stations = []
        for name, own in ports.items():
            reached = {
                other: cables[other].port if "gcs2" in (name, other) and name != other else port
                for other, port in ports.items()
            }
            peers = tmp_path / f"{name}.toml"
            peers.write_text(peers_toml(reached, listen=(name, own)))
            stations.append(Station(tmp_path, name, peers, mission))
        with running(stations):
            yield stations, cables


def a_console_reaches(station, what="reached"):
    """Return which stations a console that looks at one says to be reached, or to have the same L."""
    history = History(station.recording, rules_of)
    while history.read_on(1.0):
        pass
    return {name: each[what] for name, each in history.newest().sections["stations"].items()}


def test_all_come_to_one_world_though_one_is_killed_and_one_is_cut_off(three):
    stations, cables = three
    gcs0, gcs1, gcs2 = stations
    gcs0.see(boat0=WEST)
    gcs2.see(boat1=EAST)
    agree(stations, boat0="west0", boat1="east0")

    for cable in cables.values():
        cable.joined = False
    gcs1.kill()
    gcs0.see(boat0=EAST)
    gcs2.see(boat1=WEST)
    agree([gcs0], boat0="east0", boat1="east0")
    agree([gcs2], boat0="west0", boat1="west0")
    until(lambda: "gcs2 is not reached" in gcs0.said and "gcs1 is not reached" in gcs0.said)
    until(lambda: a_console_reaches(gcs0) == {"gcs0": None, "gcs1": False, "gcs2": False})

    gcs1.resume()
    agree([gcs1], boat0="east0", boat1="east0")
    for cable in cables.values():
        cable.joined = True
    agree(stations, boat0="east0", boat1="west0")
    until(lambda: "gcs2 is reached again" in gcs0.said)
    until(lambda: a_console_reaches(gcs0) == {"gcs0": None, "gcs1": True, "gcs2": True})

    gcs1.see(boat0=NOWHERE)
    agree(stations, boat0="region", boat1="west0")
    until(lambda: a_console_reaches(gcs0, "agrees") == {"gcs0": None, "gcs1": True, "gcs2": True})
    assert not any("differs from ours" in each.said for each in stations)
    assert read_recording(gcs1.recording).run["station"]["here"] == "gcs1"
