"""`bigactors console` and `run --console`: real processes, a simulated copter, and an operator at a websocket."""

import asyncio
import os
import signal
import socket
import ssl
import sys
import time
import urllib.error
import urllib.request
from argparse import Namespace
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

import pytest
from certificates import Authority
from console_clients import HELLO, client
from consoles import begun, free_port, link_of

from adapters.recording.recording_reader import read_recording
from bigactors.cli import main
from bigactors.commands.console import PORT
from bigactors.commands.run import console_beside
from bigactors.mistakes import Mistake

MISSION = """
mission tour
signature {
  kind Location contains Location, UAV, Station
  kind UAV driven
  kind Station
}
world {
  west0: Location = box (37.02, -8.64) (37.00, -8.66)
  east0: Location = box (37.02, -8.62) (37.00, -8.64)
  gcs0: Station = point (37.05, -8.63) linked control:gcs0
  uav0: UAV = point (37.01, -8.65) linked control:gcs0
}
BigActor a hosted_at uav0 with_behavior {
  control(MOVE_HOST_TO east0)
}
BigActor op hosted_at gcs0 with_behavior { loop { react { case "status" => display("well") } } }
environment {
  uav0 arrives
  says "status" to op at most 2 times
}
live { on broken assumption: continue }
"""
SIMULATOR = """
import sys
from adapters.simulated import Kind, Simulator, Vehicle, run
run(Simulator(sys.argv[1], [Vehicle(Kind.COPTER, (37.01, -8.65, 20.0), fault=sys.argv[3])]).run(), float(sys.argv[2]))
"""


@pytest.fixture(scope="module")
def flown(tmp_path_factory):
    """Return the recording of a short run that nothing was heard in."""
    folder = tmp_path_factory.mktemp("flown")
    mission, recording = folder / "tour.mission", folder / "run.mcap"
    mission.write_text(MISSION)
    with begun("-c", SIMULATOR, f"udpout:127.0.0.1:{(port := free_port(socket.SOCK_DGRAM))}", "20", ""):
        line = ["run", str(mission), "--unverified", f"--vehicle=uav0=udp:127.0.0.1:{port}", "--for=1"]
        assert main([*line, f"--record={recording}", f"--socket={folder / 's'}"]) == 3
    return recording


# --- a recording


@pytest.fixture
def usual_port():
    """Return the usual port, which somebody listens at."""
    with ExitStack() as stack:
        with suppress(OSError):  # somebody does
            stack.enter_context(socket.create_server(("127.0.0.1", PORT)))
        yield PORT


def test_a_recording_is_served_until_it_is_interrupted_at_another_port_where_the_usual_is_taken(
    flown, usual_port
):
    with begun("-m", "bigactors", "console", flown) as process:
        said, address = process.stdout.readline(), link_of(process, "watch").partition("#")[0]
        assert said == f"port {usual_port} is taken: the console listens at another one\n"
        with urllib.request.urlopen(address) as answer:
            assert "<title>" in answer.read().decode()
        process.send_signal(signal.SIGINT)
        assert process.wait(60) == 0
        assert "to act" not in process.stdout.read()


def test_a_port_that_was_asked_for_and_is_not_free_is_a_mistake(flown, capsys):
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        assert main(["console", str(flown), "--listen", str(port)]) == 2
    assert f"127.0.0.1:{port}" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("more", "says"),
    [
        (["--listen=0.0.0.0:0"], "--tls"),
        (["--listen=station.example:0"], "--tls"),
        (["--listen=here"], "not [HOST:]PORT"),
        (["--socket=s"], "--follow"),
        (["--tiles=none.pmtiles"], "none.pmtiles"),
        (["--tiles=words.pmtiles"], "no map in PMTiles"),
        (["--tls", "words.pmtiles", "words.pmtiles"], "no certificate"),
    ],
)
def test_what_cannot_be_served_is_a_mistake_that_says_why(flown, tmp_path, monkeypatch, capsys, more, says):
    monkeypatch.chdir(tmp_path)
    Path("words.pmtiles").write_text("words")
    assert main(["console", str(flown), *more]) == 2
    assert says in capsys.readouterr().err


@pytest.mark.parametrize("content", [None, b"", b"words", b"\x89MCAP0\r\n"])
def test_what_is_no_recording_is_a_mistake(tmp_path, capsys, content):
    path = tmp_path / "run.mcap"
    if content is not None:
        path.write_bytes(content)
    assert main(["console", str(path)]) == 2
    assert str(path) in capsys.readouterr().err


def test_with_a_certificate_it_is_served_by_https_also_before_there_is_a_recording(tmp_path):
    later, authority = tmp_path / "later.mcap", Authority(tmp_path, "authority")
    authority.sign("localhost", "console")
    more = ("--follow", "--tls", tmp_path / "console.pem", tmp_path / "console.key", "--listen=localhost:0")
    with begun("-m", "bigactors", "console", later, *more) as process:
        waits = f"{later} is not there yet: the console waits for the run that writes it\n"
        assert process.stdout.readline() == waits
        link = link_of(process, "watch")
        assert link.startswith("https://localhost:")
        trusting = ssl.create_default_context(cafile=str(authority.path))
        with urllib.request.urlopen(link, context=trusting) as answer:
            assert answer.status == 200
        with pytest.raises((urllib.error.URLError, ConnectionError)):
            urllib.request.urlopen(link.replace("https", "http"))


# --- a run


@contextmanager
def flying(folder, *more, at_once=True, fault=""):
    """Fly the mission with a console, the copter with a fault; yield the process."""
    more = (*more, "--at-once") if at_once else more
    (folder / "tour.mission").write_text(MISSION)
    port = free_port(socket.SOCK_DGRAM)
    line = ["-m", "bigactors", "run", folder / "tour.mission", f"--vehicle=uav0=udp:127.0.0.1:{port}"]
    line += ["--unverified", "--console", f"127.0.0.1:{free_port()}", "--socket", folder / "s", *more]
    with begun("-c", SIMULATOR, f"udpout:127.0.0.1:{port}", "40", fault), begun(*line) as process:
        yield process


async def operate(link, does):
    """Let somebody operate a console."""
    address, _, token = link.partition("/#token=")
    async with client(address, hello=HELLO | {"token": token}) as ana:
        await ana.until(bool)
        await does(ana)


def fate(state, what):
    return [each["state"] for each in state.get("actions", {}).values() if what in each["what"]]


def children(pid):
    found = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    return [int(each) for each in found]


def words_of(pid):
    return Path(f"/proc/{pid}/cmdline").read_text().split("\0")


def console_of(run):
    """Return the process of a run's console, and the recording that it reads."""
    console, words = next(
        (each, words) for each in children(run.pid) if "console" in (words := words_of(each))
    )
    return console, Path(next(word for word in words if word.endswith(".mcap")))


def niceness_of(process):
    """Return how much a process gives way within its session, and its session to the others where a system has that."""
    session = Path(f"/proc/{process}/autogroup")
    among = {int(session.read_text().split()[-1])} if session.exists() else set()
    return among | {os.getpriority(os.PRIO_PROCESS, process)}


def test_an_operator_acts_and_sees_what_becomes_of_it_and_the_run_outlives_its_console(tmp_path):
    async def does(ana):
        await ana.until(lambda state: state["vehicles"]["uav0"]["order"] is not None)
        assert (ana.state["clock"]["live"], ana.state["clock"]["rate"]) == (True, 1.0)
        assert await ana.act(say={"agent": "op", "message": "status"}) == ""
        await ana.until(lambda state: [each["left"] for each in state["sayings"].values()] == [1])
        assert "permitted now" in await ana.act(say={"agent": "op", "message": "land"})
        assert await ana.act(note={"text": "a boat crosses"}) == ""
        await ana.until(lambda state: "confirmed" in fate(state, "note"))
        assert await ana.act(note={"text": " "}) == "the note is empty"
        assert await ana.act(order={"order": "hold", "vehicle": ["uav0"]}) == ""
        await ana.until(lambda state: "confirmed" in fate(state, "hold"))
        card = ana.state["vehicles"]["uav0"]
        assert "Ana" in card["taken"]
        assert {each["by"] for each in ana.state["actions"].values()} == {"Ana"}
        assert card["altitude"] == pytest.approx(card["height"] + 20.0, abs=25.0)
        assert await ana.act(give_back={"vehicle": "uav0"}) == ""
        await ana.until(lambda state: state["vehicles"]["uav0"]["taken"] is None)
        await ana.until(lambda state: state["vehicles"]["uav0"]["believed"] == "east0")

    with flying(tmp_path) as process:
        asyncio.run(operate(link_of(process), does))
        console, recording = console_of(process)
        assert niceness_of(console) == {os.getpriority(os.PRIO_PROCESS, process.pid) + 5}
        told = read_recording(recording)
        assert [message.data["by"] for message in told.of("orders")] == ["Ana"]
        assert [message.data["by"] for message in told.of("given_back")] == ["Ana"]
        assert [message.data for message in told.of("notes")] == [{"text": "a boat crosses", "by": "Ana"}]
        os.kill(console, signal.SIGKILL)
        assert any("the run goes on without it" in line for line in process.stdout)
        process.send_signal(signal.SIGINT)
        assert process.wait(60) == 3
    assert not recording.parent.exists()


def test_beside_a_console_nothing_is_commanded_before_somebody_presses_start(tmp_path):
    async def does(ana):
        await ana.until(lambda state: state["preflight"].get("state") == "ready")
        assert all(each["done"] for each in ana.state["preflight"]["items"])
        (uav0,) = [each for each in ana.state["preflight"]["items"] if "vehicle" in each]
        assert (uav0["what"], uav0["fence"]) == (
            "uav0 is heard",
            "not on board: it is sent before the first flight",
        )
        await ana.until(lambda state: "PreArm: no compass" in str(state["preflight"]["items"]))
        ready = ana.state["clock"]["now"]
        await ana.until(lambda state: state["clock"]["now"] > ready + 1.0)
        assert ana.state["vehicles"]["uav0"]["order"] is None
        assert "has not begun" in await ana.act(say={"agent": "op", "message": "status"})
        assert await ana.act(start=True) == ""
        await ana.until(lambda state: state["vehicles"]["uav0"]["order"] is not None)
        assert (ana.state["preflight"]["state"], ana.state["preflight"]["by"]) == ("begun", "Ana")
        assert await ana.act(start=True) == "the run has started already"

    with flying(tmp_path, "--record", tmp_path / "run.mcap", at_once=False, fault="no compass") as process:
        link = link_of(process)
        assert process.stdout.readline().startswith("console, to watch:")
        assert "press Start" in process.stdout.readline()
        asyncio.run(operate(link, does))
        process.send_signal(signal.SIGINT)
        assert process.wait(60) == 3
    told = read_recording(tmp_path / "run.mcap")
    (begun_at,) = [each.time for each in told.of("preflight") if each.data["state"] == "begun"]
    assert all(each.time >= begun_at - 0.5 for each in told.of("commands"))


def line_of(folder, *more):
    """Return the line of a run of whose vehicle nothing is heard."""
    (folder / "tour.mission").write_text(MISSION)
    vehicle = f"--vehicle=uav0=udp:127.0.0.1:{free_port(socket.SOCK_DGRAM)}"
    line = ["run", folder / "tour.mission", vehicle, "--unverified", "--wait=0.5", *more]
    return [*map(str, line), f"--socket={folder / 's'}", f"--record={folder / 'run.mcap'}"]


def test_a_run_that_did_not_begin_leaves_no_recording_to_stop_the_next_one(tmp_path, capsys):
    for _ in range(2):
        assert main(line_of(tmp_path)) == 2
        assert "nothing was heard of uav0" in "".join(capsys.readouterr())
        assert not (tmp_path / "run.mcap").exists()
    (tmp_path / "run.mcap").write_bytes(b"another's")
    assert main(line_of(tmp_path)) == 2
    assert "there is a file already" in "".join(capsys.readouterr())
    assert (tmp_path / "run.mcap").read_bytes() == b"another's"


def test_a_run_whose_console_does_not_start_commands_nothing(tmp_path):
    with socket.create_server(("127.0.0.1", 0)) as taken:
        place = f"127.0.0.1:{taken.getsockname()[1]}"
        line = line_of(tmp_path, "--at-once", "--console", place)
        with begun("-m", "bigactors", *line) as process:
            assert "the console does not start" in process.stdout.read()
            assert process.wait(60) == 2
    assert not (tmp_path / "run.mcap").exists()


def test_a_console_that_closes_its_output_without_a_link_has_not_started_though_it_lives_on(
    tmp_path, monkeypatch
):
    silent = [sys.executable, "-c", "import os, time; os.close(1); time.sleep(60)"]
    monkeypatch.setattr(console_beside, "_line", lambda *_: silent)
    options = Namespace(console=("127.0.0.1", 0))
    with (
        pytest.raises(Mistake, match="the console does not start"),
        console_beside.console_beside(options, tmp_path / "run.mcap", tmp_path / "s"),
    ):
        pytest.fail("the run has begun")


def test_a_console_says_that_its_run_was_killed_and_ends_with_it(tmp_path):
    async def does(ana):
        await ana.until(lambda state: state["vehicles"]["uav0"]["order"] is not None)
        process.kill()
        await ana.until(lambda state: state["clock"]["ended"] is not None)
        assert ana.state["clock"]["ended"].startswith("the run ended without a message")
        await ana.until(lambda state: state["vehicles"]["uav0"]["word"] == "unknown")

    with flying(tmp_path, "--record", tmp_path / "run.mcap") as process:
        assert "console: it starts beside the run; its links follow\n" in process.stdout
        link = link_of(process)
        asyncio.run(operate(link, does))
        process.wait()
        while is_served(link):
            time.sleep(0.1)


def is_served(link):
    with suppress(urllib.error.URLError, ConnectionError), urllib.request.urlopen(link.partition("#")[0]):
        return True
    return False
