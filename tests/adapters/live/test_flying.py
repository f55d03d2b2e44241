"""Verified missions flown by simulated vehicles over real sockets, in virtual time: what `bigactors run` does."""

import asyncio

import pytest

from adapters.simulated import Disturbance, Kind, Simulator, Vehicle, run
from bigactors.arguments import parse_arguments
from bigactors.cli import main
from bigactors.commands.run import fly, prepare, record
from bigactors.mistakes import Mistake
from bigactors.recordings import open_recording, trace_of
from bigactors.watchers import Terminal

AIRFIELD = (37.147, -8.582, 20.0)


@pytest.fixture
def verified(tmp_path, monkeypatch):
    """A folder with a verdict on a mission that ships."""

    def check(name, *more):
        monkeypatch.chdir(tmp_path)
        verdict = str(tmp_path / f"{name}.verdict.json")
        assert main(["check", "--no-traces", "--control", "timed", "--verdict", verdict, name, *more]) == 0
        return tmp_path

    return check


def options_of(name, folder, *more):
    line = ["run", name, "--vehicle", "uav0=udp:127.0.0.1:0", "--socket", str(folder / "run.sock"), *more]
    return parse_arguments(line)


async def flown(flight, tape, kind, home, disturbance):
    terminal = Terminal(flight.resting)
    task = asyncio.ensure_future(fly(flight, (terminal, *([tape] if tape else []))))
    plugin = flight.plugins[0]
    while not plugin.local and not task.done():
        await asyncio.sleep(0.05)
    vehicle = Vehicle(kind, home)
    simulator = Simulator(f"udpout:127.0.0.1:{plugin.local[1]}", [vehicle], disturbance, 1)
    simulation = asyncio.ensure_future(simulator.run())
    try:
        return await task, terminal, vehicle
    finally:
        simulation.cancel()


def test_the_oil_spill_mission_flies_is_recorded_and_replays_equal(verified):
    folder = verified("oil_spill")
    path = folder / "run.mcap"
    flight = prepare(options_of("oil_spill", folder, "--record", str(path), "--for", "3000"))
    with record(flight) as tape:
        ending, terminal, vehicle = run(flown(flight, tape, Kind.PLANE, AIRFIELD, Disturbance()))
    assert ending.reason == "the mission has ended"
    assert not terminal.broken
    assert vehicle.flies
    recording = open_recording(str(path))
    trace = trace_of(recording, flight.mission)
    assert trace.configurations[-1] == ending.state.configuration
    assert ending.state.configuration.structure.logical.parent("uav0") == "oilSpill0"
    assert main(["replay", str(path)]) == 0


def test_changing_one_character_of_the_mission_makes_run_refuse_it(verified):
    folder = verified("oil_spill")
    text = (folder / "changed.mission").write_text
    from bigactors.missions import locate  # noqa: PLC0415

    original = locate("oil_spill").read_text()
    text(original.replace("radius 900 m", "radius 901 m"))
    verdict = str(folder / "oil_spill.verdict.json")
    with pytest.raises(Mistake, match="changed since: the mission's text"):
        prepare(options_of("changed.mission", folder, "--verdict", verdict))


def test_without_a_verdict_nothing_flies(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(Mistake, match="no verdict"):
        prepare(options_of("oil_spill", tmp_path))
