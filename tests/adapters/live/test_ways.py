"""Moves that name what they pass: the vehicle gets a mission, flies it, and what is committed is true."""

import asyncio

import pytest
from audited import LOOK, PLACES, flown_in

from adapters.mavlink.items import e7
from adapters.mavlink.numbers import Cmd, MissionType
from adapters.simulated import Disturbance, Kind, Vehicle
from physical import contains, point, waypoint

AIRFIELD = (37.147, -8.582, 20.0)
GATES = ("northGate0", "southGate0")
WAY_OUT = (*GATES, "bay0")
WAY_BACK = ("southGate0", "northGate0", "airfield0")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


class Log:
    """The missions that a vehicle was given, in their order."""

    def __init__(self):
        self.missions = []

    async def keep(self, _flight, _simulator, witness):
        while True:
            items = witness.vehicle.store.items.get(MissionType.MISSION)
            if items and items not in self.missions[-1:]:
                self.missions.append(items)
            await asyncio.sleep(LOOK)


def passed(witness):
    """Return which gates the vehicle was over, and when its flights were committed, in that order."""
    events = []
    for number, (_, at, _) in enumerate(witness.truth):
        events += ["commit"] * witness.commits.count(number)
        over = [gate for gate in GATES if contains(PLACES[gate], point(*at))]
        events += [gate for gate in over if [gate] != events[-1:]]
    return [*events, *["commit"] * witness.commits.count(len(witness.truth))]


def spots(items):
    """Return where a mission goes, its home and its take-off left out."""
    return [(item.x, item.y) for item in items[1:] if item.command != Cmd.TAKEOFF]


@pytest.mark.parametrize("loss", [0.0, 0.3])
def test_a_plane_flies_round_the_town_by_the_gates_that_its_mission_names(folder, loss):
    log, plane = Log(), Vehicle(Kind.PLANE, AIRFIELD)
    flown = flown_in(
        folder, "two_gates", plane, disturbance=Disturbance(loss=loss), foe=log.keep, seconds=4000
    )
    assert flown.ended, flown.witness.told()
    assert not flown.broken
    told = [[e7(waypoint(PLACES[name])) for name in way] for way in (WAY_OUT, WAY_BACK)]
    assert [spots(items) for items in log.missions] == told
    assert passed(flown.witness) == [*GATES, "commit", *reversed(GATES), "commit"]
    assert not any(contains(PLACES["town0"], point(*at)) for _, at, _ in flown.witness.truth)
    assert flown.logical.parent("uav0") == "airfield0"
