"""The sea off Portimão as it is, whatever stations make of it: a UAV, two drifters that tell where they are, a spill.

It goes on in a thread of its own, faster than the stations' clock, and its `track` is the truth that they are held to.
"""

import asyncio
import socket
import threading
import time
from bisect import bisect
from contextlib import contextmanager
from dataclasses import dataclass
from operator import attrgetter
from urllib.request import Request, urlopen

from pyais.encode import encode_dict

from adapters.simulated import Kind, Simulator, Vehicle, run
from physical import PhysicalProperty, box, circle, contains, point, write_geojson

AIRFIELD, SEARCH = circle((37.149, -8.584), 900.0), box((37.04, -8.59), (36.94, -8.79))
SPILL = circle((37.0, -8.7), 650.0)
DRIFTERS = {263999001: (37.02, -8.63, 2e-6), 263999002: (37.0, -8.69, 8e-6)}
"""By MMSI where each is at first, and how many degrees it drifts to the west in a second: the other into the spill."""

AGROUND = 1_000
"""Seconds after which they drift no further."""

SPEED = 40
"""Of the sea's seconds in one of the stations': half an hour takes less than a minute, and all packets are logged."""


@dataclass(frozen=True, slots=True)
class Moment:
    """Where the UAV really was, and which system it obeyed, at a time of the stations' clock."""

    time: float
    at: tuple[float, float]
    authority: int

    @property
    def point(self):
        return point(*self.at)


class Witnessed(Vehicle):
    """A simulated vehicle of which each movement is written down, before anybody hears of it."""

    def __init__(self, track, *rest):
        super().__init__(*rest)
        self.track = track

    def move(self, now):
        super().move(now)
        authority = round(self.parameters[self.authority_parameter])
        self.track.append(Moment(time.time(), (self.body.latitude, self.body.longitude), authority))


class Water:
    """The sea; `vehicle`, `ais` and `camera` are the ports of the UAV, of who hears AIS, of who is told of spills."""

    def __init__(self, vehicle, ais, camera):
        self.track = []
        self.answers = []
        plane = Witnessed(self.track, Kind.PLANE, (37.147, -8.582, 20.0))
        self._simulator = Simulator(f"udp:127.0.0.1:{vehicle}", [plane])
        self._ais, self._camera = ("127.0.0.1", ais), f"http://127.0.0.1:{camera}/detections"
        self._begun, self._end = threading.Event(), None

    @contextmanager
    def going_on(self):
        thread = threading.Thread(target=lambda: run(self._go_on(), SPEED), daemon=True)
        thread.start()
        assert self._begun.wait(60)
        try:
            yield self
        finally:
            self._end()
            thread.join()

    async def _go_on(self):
        parts = (self._simulator.run(), self._drift(), self._film())
        going = asyncio.gather(*parts)
        loop = asyncio.get_running_loop()
        self._end = lambda: loop.call_soon_threadsafe(going.cancel)
        self._begun.set()
        try:
            await going
        except asyncio.CancelledError:
            return

    async def _drift(self):
        """Say every half a minute what the drifters' transponders say."""
        second = 0
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
            while True:
                for mmsi in DRIFTERS:
                    link.sendto(_sentence(mmsi, second), self._ais)
                await asyncio.sleep(30.0)
                second = min(second + 30, AGROUND)

    async def _film(self):
        """Post the spill as a vision system does, once the UAV has been over the search area for a minute."""
        while not (self.track and contains(SEARCH, self.track[-1].point)):
            await asyncio.sleep(1.0)
        await asyncio.sleep(60.0)
        spill = write_geojson([PhysicalProperty("oilSpill0", "OilSpill", SPILL)]).encode()
        with urlopen(
            Request(self._camera, spill, {"Content-Type": "application/json"}), timeout=10
        ) as answer:
            self.answers.append(answer.read())

    def between(self, begin, end):
        """Return the moments of a time."""
        first, last = (bisect(self.track, when, key=attrgetter("time")) for when in (begin, end))
        return self.track[first:last]


def drifted(mmsi, second=AGROUND):
    """Return where a drifter is after some seconds."""
    latitude, longitude, west = DRIFTERS[mmsi]
    return latitude, longitude - west * second


def _sentence(mmsi, second):
    latitude, longitude = drifted(mmsi, second)
    fields = {"type": 18, "mmsi": mmsi, "lat": latitude, "lon": longitude, "second": 60}
    (sentence,) = encode_dict(fields, talker_id="AI", sentence_type="VDM")
    return f"{sentence}\r\n".encode("ascii")
