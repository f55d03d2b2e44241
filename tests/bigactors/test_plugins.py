"""From the options of `bigactors run` to its plugins: names, filters, fence, key, times."""

import stat
import subprocess
import sys
from contextlib import nullcontext

import pytest

from adapters.mavlink.signing import load
from adapters.naming import NameClash
from bigactors.arguments import parse_arguments
from bigactors.commands.run.connections import plugins_of
from bigactors.commands.run.geofence import fence_of
from bigactors.mission_lookup import open_mission
from bigactors.mistakes import Mistake
from physical import box, contains, point
from semantics.state.setting import Control, Scheduler
from specs.elaboration import Variation

LIVE = Variation(Scheduler.FCFS, Control.TIMED)
UAV = "--vehicle=uav0=udp:127.0.0.1:0"
HEAD = """
signature { kind Location contains Location, UAV kind UAV driven kind Drifter }
world {
"""


def plugins(*more, mission="spill_watch", vehicle=UAV):
    found, _ = plugins_of(parse_arguments(["run", mission, vehicle, *more]), open_mission(mission, LIVE))
    return found


@pytest.fixture
def mission(tmp_path):
    def write(*world):
        path = tmp_path / "m.mission"
        path.write_text(HEAD + "\n".join(world) + "\n}\n")
        return open_mission(str(path), LIVE)

    return write


# --- the fence ------------------------------------------------------------------------------------------


def test_the_fence_is_the_place_that_holds_all_places_where_vehicles_may_be(mission):
    found = mission(
        "sea0: Location = box (37.2, -8.5) (36.9, -8.8)",
        "bay0: Location = box (37.1, -8.6) (37.0, -8.7)",
        "uav0: UAV = point (37.05, -8.65)",
    )
    assert fence_of("world", found) == box((37.2, -8.5), (36.9, -8.8))
    assert fence_of("bay0", found) == box((37.1, -8.6), (37.0, -8.7))
    assert fence_of("none", found) is None


def test_without_such_a_place_it_is_a_box_half_a_kilometre_around_them(mission):
    found = mission(
        "west0: Location = box (37.1, -8.6) (37.0, -8.7)",
        "east0: Location = box (37.1, -8.4) (37.0, -8.5)",
        "uav0: UAV = point (37.2, -8.65)",
    )
    fence = fence_of("world", found)
    south, west = fence.vertices[0]
    north, east = fence.vertices[2]
    assert (south, west, north, east) == pytest.approx((36.9955, -8.7056, 37.2045, -8.3944), abs=2e-4)
    assert contains(fence, point(37.2, -8.65))


def test_the_fence_of_a_mission_holds_what_may_appear_in_it():
    found = open_mission("spill_watch", LIVE)
    assert contains(fence_of("world", found), box((37.0, -8.7), (37.006, -8.706)))


@pytest.mark.parametrize("word", ["uav0", "nowhere0", "drifter0"])
def test_what_is_no_place_with_a_border_is_no_fence(word):
    with pytest.raises(Mistake, match=f"'{word}' is no fence"):
        fence_of(word, open_mission("spill_watch", LIVE))


def test_each_vehicle_gets_the_fence_and_how_long_its_positions_count():
    (autopilot,) = plugins("--time-to-live=vehicles=12")
    craft = autopilot.pilot("uav0").craft
    assert craft.fence == fence_of("world", open_mission("spill_watch", LIVE))
    assert craft.time_to_live == 12.0


# --- who is who -----------------------------------------------------------------------------------------


def test_a_vehicle_is_known_by_what_the_table_says():
    assert plugins("--name=mavlink:3=uav0")[0].pilot("uav0").craft.system == 3
    assert plugins("--name=serial:2f003b=uav0")[0].pilot("uav0").craft.serial == "2F003B"


def test_vehicles_with_one_system_id_on_two_links_both_have_their_names(mission, tmp_path):
    mission(
        "sea0: Location = box (37.2, -8.5) (36.9, -8.8)",
        "uav0: UAV = point (37.05, -8.65)",
        "uav1: UAV = point (37.06, -8.65)",
    )
    more = ["--vehicle=uav1:1=udp:2", "--feed=detections=folder:."]
    *_, feed = plugins(*more, mission=str(tmp_path / "m.mission"), vehicle="--vehicle=uav0:1=udp:1")
    for name, holder in (("uav0", "mavlink:1"), ("uav1", "vehicle:uav1")):
        with pytest.raises(NameClash, match=f"as {holder} is"):
            feed._naming.name(f"name:{name}")


def test_a_port_of_many_digits_is_none():
    with pytest.raises(Mistake, match="is no port"):
        plugins(vehicle=f"--vehicle=uav0=udp:127.0.0.1:{'9' * 5_000}")


# --- feeds ----------------------------------------------------------------------------------------------


def test_of_ais_only_a_box_and_some_kinds_are_heard_and_for_how_long():
    more = ("--within=36,-9,38,-8", "--kinds=ais=Vessel", "--time-to-live=ais=90")
    _, feed = plugins("--feed=ais=udp:0", *more)
    assert (feed._area, feed._kinds, feed._time_to_live) == (box((36, -9), (38, -8)), {"Vessel"}, 90.0)


def test_detections_are_of_the_kinds_of_the_mission_that_nothing_drives():
    _, feed = plugins("--feed=detections=http:0")
    assert feed._kinds == {"Location", "OilSpill", "Drifter", "Station"}
    assert feed._listen.host == "127.0.0.1"


def test_who_listens_to_the_network_asks_for_a_token(tmp_path):
    (tmp_path / "token").write_text("sesame\n")
    _, feed = plugins("--feed=detections=http:0.0.0.0:0", f"--token={tmp_path / 'token'}")
    assert (feed._listen.host, feed._listen.token) == ("0.0.0.0", "sesame")
    (tmp_path / "token").write_text("two\nlines\n")
    with pytest.raises(Mistake, match="the token is not one line"):
        plugins("--feed=detections=http:0", f"--token={tmp_path / 'token'}")


NO_ENTITIES = ["region", "pilot", "OilSpill", "internet"]


@pytest.mark.parametrize(
    ("option", "seen", "kind", "clash"),
    [
        ("--within=36,-9,38,-8", "searchArea0", "Location", "as place:searchArea0 is"),
        ("--kinds=detections=Location", "searchArea0", "Location", None),  # where its kind is expected
        (
            "--kinds=detections=Station",
            "gcs0",
            "Station",
            "name:gcs0 would be called gcs0, as station:gcs0 is",
        ),
        (
            "--within=36,-9,38,-8",
            "oilSpill0",
            "Drifter",
            "oilSpill0 is of kind OilSpill in the mission, not Drifter",
        ),
        *(
            ("--within=36,-9,38,-8", name, "OilSpill", f"name:{name} would be called {name}, as ")
            for name in NO_ENTITIES
        ),
    ],
)
def test_what_is_detected_cannot_be_something_else_of_the_mission(option, seen, kind, clash):
    _, feed = plugins("--feed=detections=folder:.", option)
    with pytest.raises(NameClash, match=clash) if clash else nullcontext():
        assert feed._naming.name(f"name:{seen}", kind) == seen


@pytest.mark.parametrize("name", NO_ENTITIES)
def test_the_table_can_give_no_name_that_the_mission_has_as_no_entity(name):
    with pytest.raises(Mistake, match=f"mmsi:244660274 would be called {name}, as "):
        plugins(f"--name=mmsi:244660274={name}")


def test_the_table_says_which_transponder_a_station_has():
    _, feed = plugins("--feed=ais=udp:0", "--name=mmsi:244660274=gcs0")
    assert feed._naming.name("mmsi:244660274", "BaseStation") == "gcs0"


# --- keys -----------------------------------------------------------------------------------------------


def test_a_key_is_made_of_a_passphrase_and_shared_by_all_links(tmp_path):
    path = tmp_path / "key.json"
    make = [sys.executable, "-m", "adapters.mavlink.new_key", str(path)]
    subprocess.run(make, input="open sesame\n", text=True, check=True)
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    assert len(load(path).key) == 32
    again = subprocess.run(make, input="open sesame\n", text=True, check=False, capture_output=True)
    assert again.returncode == 2
    assert "is there already" in again.stderr
    (autopilot,) = plugins(f"--key={path}")
    assert autopilot._keeper.key == load(path).key
