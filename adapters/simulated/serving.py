"""Serve simulated vehicles on a link: real sockets and packets, with the requested disturbance."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from random import Random
from typing import Final

from adapters.addresses import parse_address
from adapters.mavlink.codec import Decoder, Encoder, Garbage
from adapters.mavlink.constants import AUTOPILOT_COMPONENT
from adapters.mavlink.message import MavlinkMessage
from adapters.mavlink.signing import stamp
from adapters.simulated import protocol
from adapters.simulated.reporting import Reporter
from adapters.simulated.simulated_vehicle import Vehicle
from adapters.transport import Port, Remote, open_port


@dataclass(frozen=True, slots=True)
class Disturbance:
    """The disturbance of packets on a link.

    Attributes:
        loss: The probability that a packet is lost.
        duplication: The probability that a packet comes twice.
        delay: The shortest and longest delay in seconds: packets may overtake each other.
        blackouts: Start and end of each total outage, in seconds of the sender's clock.
    """

    loss: float = 0.0
    duplication: float = 0.0
    delay: tuple[float, float] = (0.0, 0.0)
    blackouts: tuple[tuple[float, float], ...] = ()

    def arrivals(self, now: float, random: Random) -> tuple[float, ...]:
        """Return the delays of a packet sent now, one for each arrival: none if it is lost, two if it is duplicated."""
        if any(start <= now < end for start, end in self.blackouts) or random.random() < self.loss:
            return ()
        copies = 2 if random.random() < self.duplication else 1
        return tuple(random.uniform(*self.delay) for _ in range(copies))


NONE = Disturbance()


STEP: Final = 0.1
"""Seconds between two steps of the simulation."""


class Simulator:
    """Vehicles on one address, such as `udpout:127.0.0.1:14550`.

    Time is the event loop's plus `epoch`, the loop's time 0 in seconds since 1970. `disturbance` affects every packet,
    in both directions.
    """

    def __init__(
        self,
        address: str,
        vehicles: Sequence[Vehicle],
        disturbance: Disturbance = NONE,
        seed: int = 0,
        epoch: float = 1_600_000_000.0,
    ) -> None:
        self._address = parse_address(address)
        self._vehicles = {vehicle.system: (vehicle, Reporter()) for vehicle in vehicles}
        self.disturbance = disturbance
        self._random = Random(seed)
        self._epoch = epoch
        self._decoders: dict[Remote, Decoder] = {}
        self._encoders: dict[tuple[int, bytes | None], Encoder] = {}
        self._remotes: dict[Remote, None] = {}
        self._port: Port | None = None

    @property
    def local(self) -> Remote | None:
        """Its address, once it runs."""
        return self._port.local if self._port else None

    def now(self) -> float:
        """Return the time in seconds since 1970."""
        return self._epoch + asyncio.get_running_loop().time()

    def reboot(self, system: int, *, armed: bool = False) -> None:
        """Reboot a vehicle at its current position."""
        vehicle, reporter = self._vehicles[system]
        vehicle.reboot(armed=armed)
        reporter.reset()

    def restart(self, system: int) -> None:
        """Reboot a vehicle on the ground at home, as if its simulator had been restarted."""
        vehicle, reporter = self._vehicles[system]
        vehicle.restart()
        reporter.reset()

    def every(self, system: int, name: str, seconds: float) -> None:
        """Let a vehicle send a message at an interval without a request."""
        self._vehicles[system][1].every(name, seconds)

    async def run(self) -> None:
        """Fly until cancelled."""
        async with open_port(self._address, self._receive) as self._port:
            for vehicle, _ in self._vehicles.values():
                vehicle.time = vehicle.booted = self.now()
            loop = asyncio.get_running_loop()
            due = loop.time()
            while True:
                due = max(due + STEP, loop.time())  # on a grid: simulators that share a processor stay apart
                await asyncio.sleep(due - loop.time())
                for vehicle, reporter in self._vehicles.values():
                    vehicle.move(self.now())
                    self._broadcast(vehicle, [*reporter.due(vehicle), *vehicle.store.tick(self.now())])

    def _receive(self, remote: Remote, data: bytes) -> None:
        for seconds in self.disturbance.arrivals(self._loop_time(), self._random):
            self._after(seconds, partial(self._arrived, remote, data))

    def _arrived(self, remote: Remote, data: bytes) -> None:
        self._remotes[remote] = None
        for message in self._decoders.setdefault(remote, Decoder()).feed(data):
            if isinstance(message, Garbage):
                continue
            for vehicle, reporter in self._vehicles.values():
                self._send(vehicle, protocol.hear(vehicle, reporter, message, self.now()), remote)

    def _broadcast(self, vehicle: Vehicle, messages: Sequence[MavlinkMessage]) -> None:
        remotes: list[Remote | None] = [*self._remotes]
        for remote in remotes or [None]:
            self._send(vehicle, messages, remote)

    def _send(self, vehicle: Vehicle, messages: Sequence[MavlinkMessage], remote: Remote | None) -> None:
        for message in messages:
            frame = self._frame(vehicle, message)
            for seconds in self.disturbance.arrivals(self._loop_time(), self._random):
                self._after(seconds, partial(self._put, frame, remote))

    def _put(self, frame: bytes, remote: Remote | None) -> None:
        if self._port is not None:
            self._port.send(frame, remote)

    def _frame(self, vehicle: Vehicle, message: MavlinkMessage) -> bytes:
        timestamp, key = 0, None
        if vehicle.signing is not None:
            vehicle.signing = stamp(vehicle.signing, self.now())
            timestamp, key = vehicle.signing.timestamp, vehicle.signing.key
        known = (vehicle.system, key)
        if known not in self._encoders:
            self._encoders[known] = Encoder(vehicle.system, AUTOPILOT_COMPONENT, key)
        return self._encoders[known].pack(replace(message, system=vehicle.system), timestamp)

    def _loop_time(self) -> float:
        return asyncio.get_running_loop().time()

    def _after(self, seconds: float, action: Callable[[], None]) -> None:
        if seconds:
            asyncio.get_running_loop().call_later(seconds, action)
        else:
            action()
