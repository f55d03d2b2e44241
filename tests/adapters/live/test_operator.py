"""An operator's orders over the socket, obeyed by simulated vehicles, recorded, and kept in a resumed run."""

import asyncio
import itertools
import re
import signal
from functools import partial
from pathlib import Path

import jsonschema
import pytest
from audited import flown_in
from flown_processes import SIMULATOR, free_port, rules, started, until
from live_missions import LIVE, TOUR, verify
from worlds import ROUND

from adapters.live.operator_socket import acknowledge, fates, give_back, order, say
from adapters.live.overrides import StandingOrder
from adapters.plugin import Hold
from adapters.recording.mcap_files import RecordingError
from adapters.recording.recording_reader import read_recording
from adapters.recording.schemas import SCHEMAS
from adapters.simulated import Kind, Vehicle
from bigactors.cli import main
from bigactors.mission_lookup import open_mission
from bigactors.recordings import mission_of, open_recording, resume, trace_of

pytestmark = pytest.mark.long

SOCKET = Path("s")
MISSION = (
    "mission tour\n"
    + TOUR
    + """
BigActor a hosted_at uav0 with_behavior {
  control(MOVE_HOST_TO east0)
  observe(CHILDREN(PARENT(HOST)))
  react { case obs => display(obs) }
}
BigActor op hosted_at gcs0 with_behavior { loop { react { case "status" => display("well") } } }
environment { says "status" to op at most 2 times }
"""
)
KINDS = [
    pytest.param(kind, modes, id=kind.name.lower())
    for kind, modes in (
        (Kind.PLANE, ("LOITER", "RTL")),
        (Kind.COPTER, ("BRAKE", "RTL")),
        (Kind.ROVER, ("HOLD", "RTL")),
    )
]


@pytest.fixture
def flying(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return partial(flown_in, tmp_path, ROUND)


def told(path, topic, member):
    try:
        return [message.data[member] for message in read_recording(path).of(topic)]
    except (RecordingError, FileNotFoundError):
        return []  # it has only just begun


def modes_in(path):
    return told(path, "status", "mode")


async def comes(what):
    while not what():
        await asyncio.sleep(0.5)


def mode(vehicle):
    return vehicle.kind.profile.mode_name(vehicle.mode)


@pytest.mark.parametrize(("kind", "modes"), KINDS)
def test_a_vehicle_holds_and_returns_as_ordered_and_flies_on_once_given_back(flying, kind, modes):
    seen = []

    async def operator(_flight, _simulator, witness):
        await comes(lambda: "command" in witness.rules and witness.vehicle.flies)
        await asyncio.sleep(10.0)
        for what in ("hold", "return"):
            assert await order(SOCKET, what, "uav0", "Ana") == ("", {}, ())
            await comes(lambda: [each.kind for each in witness.findings].count("confirmed") > 2 * len(seen))
            seen.append(mode(witness.vehicle))
            assert await order(SOCKET, what, "uav0", "Ana") == ("", {}, ())  # twice does no harm
            await asyncio.sleep(20.0)
        assert await order(SOCKET, "hold", "uav7", "Ana") == (
            "there is no vehicle 'uav7'; there are uav0",
            {},
            (),
        )
        assert await acknowledge(SOCKET, 1, "Ben") == ""
        assert await acknowledge(SOCKET, 99, "Ben") == "there is no finding 99; there are 8"
        assert await say(SOCKET, "nobody", "x", "Ben") != ""
        await asyncio.sleep(60.0)
        assert witness.rules.count("commit") == 0
        assert (await give_back(SOCKET, "uav0", by="Ana")).refusal == ""

    flown = flying(Vehicle(kind, (37.0, -8.6, 20.0)), foe=operator, seconds=3000)
    assert flown.ended
    assert tuple(seen) == modes
    recording = open_recording("r.mcap")
    for message in recording.messages:
        jsonschema.validate(message.data, SCHEMAS[message.topic][1])
    orders = [message.data for message in recording.of("orders")]
    assert [(each["order"], each["vehicle"], each["by"], bool(each["refusal"])) for each in orders] == [
        ("hold", "uav0", "Ana", False),
        ("hold", "uav0", "Ana", False),
        ("return", "uav0", "Ana", False),
        ("return", "uav0", "Ana", False),
        ("hold", "uav7", "Ana", True),
    ]
    told = {message.data["request"]: message.data["command"] for message in recording.of("commands")}
    reported = {
        m.data["request"] for m in recording.of("reports") if m.data["report"] in ("Accepted", "Arrived")
    }
    for each, command in zip(orders[:4], ("Hold", "Hold", "Return", "Return"), strict=True):
        assert told[each["requests"]["uav0"]] == command
        assert each["requests"]["uav0"] in reported
    assert [message.data for message in recording.of("acknowledged")] == [{"finding": 1, "by": "Ben"}]
    assert recording.of("sayings")[0].data["by"] == "Ben"
    assert recording.of("given_back")[0].data["by"] == "Ana"
    states = recording.of("status")
    assert {*modes} <= {message.data["mode"] for message in states}
    assert all(after.time - before.time > 0.9 for before, after in itertools.pairwise(states))
    assert "Throttle armed" in {message.data["text"] for message in recording.of("said")}
    assert main(["replay", "r.mcap"]) == 0


def test_a_run_that_is_not_given_back_ends_held_and_is_resumed_so(flying):
    async def operator(_flight, _simulator, witness):
        await comes(lambda: witness.vehicle.flies)
        assert await order(SOCKET, "hold", None, "Ana") == ("", {}, ())

    flown = flying(Vehicle(Kind.PLANE, (37.0, -8.6, 20.0)), foe=operator, seconds=300)
    assert not flown.ended
    found = resume("r.mcap", open_mission("flown.mission", LIVE))
    assert flown.ending.state.overrides.taken == {"uav0": "held by the operator (Ana)"}
    assert found.taken == {"uav0": "ordered to hold by the operator (Ana), not confirmed yet"}
    (_request,) = found.standing_orders
    assert found.standing_orders == {"uav0": StandingOrder(Hold("operator-2", "uav0"), "Ana")}


def test_a_killed_run_holds_its_vehicle_still_when_it_is_resumed_and_ends_once_it_is_given_back(
    tmp_path, capsys
):
    mission, verdict = tmp_path / "tour.mission", tmp_path / "tour.verdict.json"
    mission.write_text(MISSION)
    verify(mission, verdict)
    port, first, second = free_port(), tmp_path / "first.mcap", tmp_path / "second.mcap"
    socket = ["--socket", str(tmp_path / "s")]
    line = ["-m", "bigactors", "run", str(mission), "--vehicle", f"uav0=udp:127.0.0.1:{port}", *socket]

    with started("-c", SIMULATOR, f"udpout:127.0.0.1:{port}", "40"):
        with started(*line, "--record", str(first)) as run:
            until(lambda: "command" in rules(first))
            assert main(["say", "op", "status", *socket]) == 0
            assert main(["say", "op", "nonsense", *socket]) == 2
            assert main(["hold", "uav0", "--by", "Ana", *socket]) == 0
            until(lambda: modes_in(first)[-1:] == ["BRAKE"])
            assert main(["status", *socket]) == 0
            run.send_signal(signal.SIGKILL)
            run.wait()
        assert read_recording(first).torn
        assert "commit" not in rules(first)
        with started(*line, "--resume", str(first), "--record", str(second), "--for", "110") as run:
            until(lambda: "Arrived" in told(second, "reports", "report"))
            until(lambda: len(modes_in(second)) > 2)
            assert set(modes_in(second)) == {"BRAKE"}
            assert "TakenOver" not in told(second, "reports", "report")
            assert main(["give-back", "uav0", "--by", "Ana", *socket]) == 0
            until(lambda: "commit" in rules(second))
            assert main(["say", "op", "status", *socket]) == 0
            run.send_signal(signal.SIGINT)
            assert "commit" in run.communicate(timeout=120)[0]
    recording = open_recording(str(second))
    trace = trace_of(recording, mission_of(recording))
    assert trace.configurations[-1].structure.logical.parent("uav0") == "east0"
    assert main(["replay", str(second)]) == 0
    out = capsys.readouterr().out
    assert "ordered to hold: uav0" in out
    assert "uav0 held by the operator (Ana)\n" in out
    does = r"held by the operator \(Ana\), has not arrived in east0, BRAKE(, disarmed)?, battery"
    held = re.search(rf"^vehicles\n  uav0 {does}", out, re.M)
    assert held is not None, out
    assert "requests\n  FLY(a, MOVE_HOST_TO east0)\npermitted messages\n  op status (1 time more)\n" in out
    assert told(second, "orders", "by") == ["Ana"]


def test_what_a_vehicle_under_a_foreign_authority_refuses_it_does_once_it_obeys_us_again(flying):
    refusal = "it obeys system 252, not gcs0: its SYSID_MYGCS is 252, and gcs0 has 255"
    refused = ("refused", f"refuses to hold, as the operator (Ana) ordered: {refusal}")
    came = []

    async def becomes(fate):
        while (became := (await fates(SOCKET))["uav0"])[0] != fate:
            await asyncio.sleep(0.5)
        came.append(became)

    async def operator(_flight, _simulator, witness):
        await comes(lambda: "command" in witness.rules and witness.vehicle.flies)
        witness.vehicle.parameters["SYSID_MYGCS"] = 252.0
        await comes(lambda: "refused" in witness.kinds())  # the fallback, since the authority was lost
        assert await order(SOCKET, "hold", "uav0", "Ana") == ("", {}, ())
        await becomes("refused")
        witness.vehicle.parameters["SYSID_MYGCS"] = 255.0
        await becomes("confirmed")

    copter = Vehicle(Kind.COPTER, (37.0, -8.6, 20.0), enforce=False)
    flown = flying(copter, foe=operator, seconds=300)
    assert came == [refused, ("confirmed", "held by the operator (Ana)")]
    assert flown.ending.state.overrides.taken == {"uav0": "held by the operator (Ana)"}
    assert mode(flown.vehicle) == "BRAKE"
