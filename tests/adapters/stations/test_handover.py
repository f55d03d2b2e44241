"""Example 2 of the paper with stations as processes: `uav0` is handed from gcs0 to gcs1, and both see where it is."""

import pytest
from company import WORLD, Station, peers_toml, running
from flown_processes import SIMULATOR, free_port, started, until

from adapters.console.history import History
from adapters.recording.recording_reader import read_recording
from bigactors.cli import main
from bigactors.commands.console.recorded_history import rules_of
from checker.reports.lanes import lanes_of

pytestmark = pytest.mark.long

MISSION = (
    "mission handover\n"
    + WORLD.replace("live { on broken assumption: continue }", "")
    .replace("  boat0: Vessel = point (37.03, -8.63)\n", "")
    .replace(
        "  boat1: Vessel = point (37.03, -8.64)\n", "  uav0: UAV = point (37.01, -8.65) linked control:gcs0\n"
    )
    + """
BigActor op0 hosted_at gcs0 with_behavior { loop { react {
  case "handover" => control(HAND uav0 TO gcs1)
                     observe(LINKED_TO_HOST)
                     react { case view => send "yours" to op1 }
  case "where" => observe(PARENT(uav0))
                  react { case view => display(view) } } } }
BigActor op1 hosted_at gcs1 with_behavior {
  react { case "yours" => skip }
  observe(LINKED_TO_HOST)
  react { case view => display(view) }
  control(MOVE uav0 TO east0)
  observe(CHILDREN(east0))
  react { case view => display(view) }
  control(HAND uav0 TO gcs0)
}
environment { says "handover" to op0 at most once
              says "where" to op0 at most 9 times }
check { local_consistency
        race_freedom }
"""
)


@pytest.fixture
def stations(tmp_path):
    """Two stations that both hear the vehicle over a link of their own, and one that hears it from them alone."""
    mission = tmp_path / "handover.mission"
    mission.write_text(MISSION)
    assert (
        main(["check", "--no-traces", "--control", "timed", "--verdict", str(tmp_path / "v"), str(mission)])
        == 0
    )
    ports = {name: free_port() for name in ("gcs0", "gcs1", "gcs2")}
    peers = tmp_path / "peers.toml"
    peers.write_text(peers_toml(ports))
    vehicle = free_port()
    rest = ["--verdict", str(tmp_path / "v")]
    more = [*rest, "--vehicle", f"uav0=udpout:127.0.0.1:{vehicle}"]
    found = [Station(tmp_path, name, peers, mission, *(more if name != "gcs2" else rest)) for name in ports]
    with started("-c", SIMULATOR, f"udp:127.0.0.1:{vehicle}", "30", "obeys all"), running(found):
        yield found


def as_a_console_has_it(station):
    """Return the configuration to which a console comes that reads a station's recording."""
    history = History(station.recording, rules_of)
    while history.read_on(1.0):
        pass
    return history.facts.standing.configuration


def test_both_stations_show_where_the_uav_is_before_during_and_after(stations):
    gcs0, gcs1, gcs2 = stations
    until(lambda: all("handover begins" in each.said for each in stations))
    assert all(each.places("uav0") == {"uav0": "west0"} for each in stations)
    assert all(each.links("uav0") == ("control:gcs0",) for each in stations)
    assert main(["say", "op0", "handover", "--socket", str(gcs0.socket)]) == 0

    until(lambda: all(each.links("uav0") == ("control:gcs1",) for each in stations))
    assert "⟨actuate : CTR(op0, HAND uav0 TO gcs1)⟩" in gcs0.steps()
    until(lambda: "op1: {gcs0, gcs1, gcs2, uav0}" in gcs1.said)
    until(lambda: "⟨command : CTR(op1, MOVE uav0 TO east0)⟩" in gcs1.steps())
    until(lambda: "⟨env : uav0 is sent to east0⟩" in gcs0.steps())
    until(lambda: "⟨commit : FLY(op1, MOVE uav0 TO east0)⟩" in gcs1.steps())
    for each in (gcs0, gcs2):  # by its steps: a busy machine may look only after the UAV has flown on
        until(lambda each=each: "⟨env : uav0 is seen in east0⟩" in each.steps())
    until(lambda: "op1: {east0, uav0}" in gcs1.said)
    # Back again, which is no identity though gcs1 has seen the UAV on both authorities.
    until(lambda: all(each.links("uav0") == ("control:gcs0",) for each in stations))
    told = [message.data for message in read_recording(gcs1.recording).of("commands")]
    assert [(each["leave"], each["join"]) for each in told if each["command"] == "HandOver"] == [
        ("control:gcs1", "control:gcs0")
    ]
    assert "broken assumption" not in gcs0.said + gcs1.said + gcs2.said
    for each in (gcs0, gcs2):  # what it passes over on its way is nobody's observation
        assert [label for label in each.steps() if " seen in " in label] == ["⟨env : uav0 is seen in east0⟩"]

    for each in stations:
        trace = each.trace()
        assert "environment" in lanes_of(trace.configurations, [step.label for step in trace.steps]).names
        until(lambda each=each: as_a_console_has_it(each) == each.trace().configurations[-1])
        assert main(["replay", str(each.recording)]) == 0
