"""A station that lies over a real link gets nothing done that the mission's text does not say."""

import asyncio
import json
import time

import pytest
from company import WORLD, Station, peers_toml, running
from flown_processes import free_port, until
from live_missions import LIVE, Run, plan_of
from msgspec import Raw
from msgspec.json import encode
from scale import long_ones

from adapters.live.plan import Plan
from adapters.plugin import Delivered
from adapters.stations.bus import Bus
from adapters.stations.entries import Entry, Posted, entry_text
from adapters.stations.peers import read_peers
from adapters.stations.station_messages import StationMessage
from bigactors.commands.run.station_flight import digest_of
from semantics.state.station_partition import Parting, parted
from specs.elaboration import load_mission

MISSION = (
    "mission lie\n"
    + WORLD
    + """
BigActor scout hosted_at gcs0 with_behavior {
  let place = west0
  migrate(gcs1)
  observe(CHILDREN(place))
  react { case seen => send ("seen", place) to op0 }
  migrate(gcs0) }
BigActor op0 hosted_at gcs0 with_behavior { loop { react { case ("seen", place) => display(place) } } }
BigActor op1 hosted_at gcs1 with_behavior { loop { react { case "hello" => display("hello") } } }
environment { says "hello" to op1 at most 3 times }
"""
)


class Liar:
    """A station's place in the company, taken by hand: it answers with whatever entries it is given."""

    def __init__(self, peers, mission):
        self.peers, self.mission = peers, mission
        self.texts = []

    def _message(self):
        upto = len(self.texts)
        return encode(StationMessage(digest_of(self.mission), time.time(), 0, upto, upto, self.texts))

    async def lie(self, seconds):
        """Answer every question for a while."""
        bus = Bus(self.peers, "lie", lambda *_: None, lambda *_: self._message())
        try:
            end = time.monotonic() + seconds
            while time.monotonic() < end:
                bus.put(self._message())
                await asyncio.sleep(0.2)
        finally:
            bus.close()

    def post(self, parcel):
        number = len(self.texts) + 1
        self.texts.append(Raw(entry_text(Entry("gcs0", number, Posted("gcs1", number, parcel)))))


def scout(code=(), store=(), requests=(), host="gcs1", says=()):
    return {"Parcel": ["scout", [], {"Running": [host, *map(list, (code, store, requests, says))]}]}


LIES = [
    scout(requests=[{"Controls": ["scout", "MOVE_HOST_TO", "gcs1", ["east0"]]}]),
    scout(
        requests=[
            {"CTR": ["scout", {"Reaction": ["MOVE_HOST_TO west0", {"Pattern": []}, {"Pattern": []}, []]}]}
        ]
    ),
    scout(code=[3]),
    scout(code=[10**17, -1]),
    {"Parcel": ["scout", [{"seen": {}, "swept": 0}], None]},
    {"Parcel": [{}, None, []]},
    10**350,
]


@pytest.mark.parametrize("lie", LIES[:-1], ids=range(len(LIES) - 1))
def test_a_forged_parcel_does_not_enter(lie):
    part = Parting("gcs1", {"gcs0": "gcs0", "gcs1": "gcs1", "gcs2": "gcs1"}, {}, {})
    run = Run(Plan(parted(plan_of(MISSION).first, part), peers="stations"))
    run.turn(0.0, reports=[Delivered("gcs0", 1.0, 1, lie)])
    assert "enter" not in run.rules
    assert "parcel 1 of gcs0 cannot enter" in run.messages()[0]


@pytest.mark.parametrize("lie", [LIES[0], *long_ones(LIES[-1])], ids=["forged", "unreadable"])
def test_a_forged_parcel_is_refused_and_recorded_and_the_run_goes_on(tmp_path, lie):
    path = tmp_path / "lie.mission"
    path.write_text(MISSION)
    ports = {name: free_port() for name in ("gcs0", "gcs1")}
    for name in ports:
        (tmp_path / f"{name}.toml").write_text(peers_toml(ports, hosts={"gcs1": ["gcs2"]}))
    liar = Liar(read_peers(tmp_path / "gcs0.toml", "gcs0"), load_mission(path, LIVE))
    liar.post(lie)
    station = Station(tmp_path, "gcs1", tmp_path / "gcs1.toml", path)
    with running([station]):
        until(station.socket.exists)
        asyncio.run(liar.lie(3.0))
        until(lambda: ("cannot enter" if lie == LIES[0] else "unreadable") in station.said)
        assert station._process.poll() is None
        assert "Traceback" not in station.said
        station.interrupt()
    assert not any("enter" in label for label in station.steps())
    found = [json.dumps(message.data) for message in station._read().of("findings")]
    assert any("gcs0" in each for each in found) or lie == LIES[-1]
