"""Messages and bigActors between processes: acknowledged, delivered once, whoever is killed or cut off meanwhile."""

import time
from contextlib import ExitStack

import pytest
from company import EAST, WEST, WORLD, Cable, Station, peers_toml, running
from flown_processes import free_port, until

from bigactors.cli import main
from checker.reports.lanes import lanes_of
from semantics.behaviours.values import Text

pytestmark = pytest.mark.long

MISSION = (
    "mission post\n"
    + WORLD
    + """
BigActor op0 hosted_at gcs0 with_behavior { loop { react {
  case "go" => send "ping" to op1
  case "pong" => display("pong") } } }
BigActor op1 hosted_at gcs1 with_behavior { loop { react { case "ping" => send "pong" to op0 } } }
BigActor nomad hosted_at gcs0 with_behavior {
  react { case "travel" => skip }
  let word = "luggage"
  observe(CHILDREN(west0))
  migrate(gcs1)
  react { case seen => send ("from gcs1", word) to op0 }
  display(word)
  observe(CHILDREN(east0))
  react { case seen => display(seen) }
  migrate(gcs0)
  observe(HOSTED_AT(gcs0))
  react { case seen => display(seen) } }
environment { boat0 drifts among point (37.005, -8.605), point (37.005, -8.645)
              boat1 drifts among point (37.005, -8.605), point (37.005, -8.645)
              says "go" to op0 at most 20 times
              says "travel" to nomad at most once }
"""
)
RECEIVED = '⟨rcv_msg : {}, react("{}")⟩'


TIMED = MISSION + "scheduler fcfs\ncontrol timed\ntiming { agents react within 5 s }\n"


@pytest.fixture
def two(tmp_path, request):
    """Two stations, and the cables between them."""
    mission = tmp_path / "post.mission"
    mission.write_text(getattr(request, "param", MISSION))
    ports = {name: free_port() for name in ("gcs0", "gcs1")}
    with ExitStack() as stack:
        cables = {name: Cable(port) for name, port in ports.items()}
        for cable in cables.values():
            stack.callback(cable.close)
        stations = []
        for name, own in ports.items():
            reached = {other: cables[other].port if other != name else own for other in ports}
            peers = tmp_path / f"{name}.toml"
            peers.write_text(peers_toml(reached, listen=(name, own), hosts={"gcs1": ["gcs2"]}))
            stations.append(Station(tmp_path, name, peers, mission))
        with running(stations):
            yield stations, cables


def say(station, agent, message):
    return main(["say", agent, message, "--socket", str(station.socket)])


def received(station, agent, message):
    return station.steps().count(RECEIVED.format(agent, message))


def go(station, times):
    for _ in range(times):
        assert say(station, "op0", "go") == 0


def test_each_message_arrives_once_though_both_are_killed_and_the_link_is_cut(two):
    (gcs0, gcs1), cables = two
    until(lambda: gcs0.socket.exists() and gcs1.socket.exists())
    assert say(gcs1, "op0", "go") == 2  # it runs at gcs0, and is told there
    go(gcs0, 3)
    until(lambda: received(gcs0, "op0", "pong") == 3)

    gcs1.kill()
    go(gcs0, 3)
    gcs1.resume()
    until(lambda: received(gcs0, "op0", "pong") == 6)

    for cable in cables.values():
        cable.joined = False
    go(gcs0, 3)
    until(lambda: gcs0.steps().count("⟨leave : op1, gcs1⟩") == 9)
    gcs0.kill()
    gcs0.resume()
    until(lambda: gcs0.trace() is not None)
    for cable in cables.values():
        cable.joined = True
    until(lambda: received(gcs0, "op0", "pong") == 9)
    time.sleep(2.5)  # what would come twice has come by now
    assert received(gcs1, "op1", "ping") == 9
    assert received(gcs0, "op0", "pong") == 9
    assert gcs1.steps().count("⟨enter : op1, gcs0⟩") == 9
    assert main(["replay", str(gcs0.recording)]) == 0


@pytest.mark.parametrize("two", [TIMED], indirect=True)
def test_a_message_that_was_long_on_its_way_makes_the_reaction_to_it_late_where_it_arrives(two):
    (gcs0, gcs1), cables = two
    late = 'react("ping")⟩ takes longer than 5 s; the mission says: agents react within 5 s'
    until(lambda: gcs0.socket.exists() and gcs1.socket.exists())
    go(gcs0, 1)
    until(lambda: received(gcs0, "op0", "pong") == 1)
    assert "takes longer" not in gcs0.said + gcs1.said
    for cable in cables.values():
        cable.joined = False
    go(gcs0, 1)
    until(lambda: gcs0.steps().count("⟨leave : op1, gcs1⟩") == 2)
    time.sleep(8.0)
    assert "takes longer" not in gcs0.said + gcs1.said
    for cable in cables.values():
        cable.joined = True
    until(lambda: late in gcs1.said)
    until(lambda: f"at gcs1: ⟨rcv_msg : op1, {late}" in gcs0.said)


def test_a_bigactor_goes_to_another_station_with_what_it_carries_and_comes_home(two, capsys):
    (gcs0, gcs1), _ = two
    until(lambda: gcs0.socket.exists() and gcs1.socket.exists())
    gcs0.see(boat0=WEST)
    gcs1.see(boat1=EAST)
    until(
        lambda: all(
            each.places("boat0", "boat1") == {"boat0": "west0", "boat1": "east0"} for each in (gcs0, gcs1)
        )
    )
    assert say(gcs0, "nomad", "travel") == 0
    until(lambda: "⟨enter : nomad, gcs1⟩" in gcs0.steps() and "{nomad, op0}" in gcs0.said)
    assert "nomad: luggage" in gcs1.said
    assert "nomad: {boat1, east0}" in gcs1.said
    assert "⟨migrate : MGR(nomad, gcs1)⟩" in gcs0.steps()
    assert gcs0.steps().count("⟨leave : nomad, gcs1⟩") == gcs1.steps().count("⟨enter : nomad, gcs0⟩") == 1
    assert gcs1.steps().count("⟨leave : nomad, gcs0⟩") == gcs0.steps().count("⟨enter : nomad, gcs1⟩") == 1
    trace = gcs1.trace()
    assert "nomad" in lanes_of(trace.configurations, [step.label for step in trace.steps]).names
    assert gcs0.trace().configurations[-1].alpha.mailbox("op0") == ((Text("from gcs1"), Text("luggage")),)
    capsys.readouterr()
    assert main(["show", "--trace", str(gcs1.recording), "--lanes"]) == 0
    assert "enter" in capsys.readouterr().out
