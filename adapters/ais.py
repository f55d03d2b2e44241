"""The AIS plugin: vessels, base stations and buoys from a receiver or a recording, named by their MMSI.

`physical.ais_receiver` decodes lines; this module receives, filters and stamps them. A transponder's time counts only
up to the receiver's clock.
"""

from __future__ import annotations

import asyncio
from collections import OrderedDict
from collections.abc import Collection, Iterator
from dataclasses import replace
from typing import Final

from adapters.addresses import parse_address
from adapters.listening_plugin import Feed
from adapters.naming import NamingService
from adapters.plugin import Aged, World
from adapters.rate_limit import Troubles
from adapters.transport import Port, Remote, open_port
from physical import Geometry, PhysicalError, PhysicalProperty, contains, open_file
from physical.ais_receiver import TAKEN, ReceiverState, hear
from physical.ais_reports import AisError, PositionReport
from physical.ais_world import COARSE, TIME_TO_LIVE, Finest, physical_property
from physical.file_account import Counting
from physical.mmsi import KINDS, digits
from physical.nmea import DecodingFailure

MAX_LINE: Final = 8_192
"""The longest line in bytes; the beginning of a longer one is passed on, for its reader to refuse."""


class Lines:
    """One stream of lines; `whole` if a chunk's end ends a line, as a datagram's does."""

    def __init__(self, *, whole: bool = False) -> None:
        self._rest = b""
        self._whole = whole
        self._skipping = False

    def feed(self, chunk: bytes) -> list[bytes]:
        """Return the complete lines, without their ends."""
        *lines, rest = (self._rest + chunk).split(b"\n")
        if self._skipping and lines:
            lines, self._skipping = lines[1:], False
        if self._skipping:
            rest = b""
        if self._whole or len(rest) > MAX_LINE:
            self._skipping = not self._whole
            lines, rest = ([*lines, rest] if rest else lines), b""
        self._rest = rest
        return [line.rstrip(b"\r") for line in lines if line.strip()]

    def end(self) -> list[bytes]:
        """Return the last line, if it lacks its end."""
        return self.feed(b"\n") if self._rest else []

    @property
    def held(self) -> int:
        """The number of bytes that wait for the rest of their line."""
        return len(self._rest)


MAX_REMOTES: Final = 64
FUTURE: Final = 1.0
"""Seconds by which a receiver's clock may be ahead of ours."""

PACE: Final = 100.0
"""Lines a second from a recording whose lines have no times."""

REPORT: Final = 1.0
_REASONS: Final = frozenset(reason.value for reason in DecodingFailure)


class AisFeed(Feed):
    """A plugin that receives AIS.

    Arguments:
        name: Its name in reports.
        address: The receiver's address, such as `udp:127.0.0.1:10110`, or `file:PATH` of a recording, which is replayed
            in real time as if it were received now.
        naming: The naming service.
        area: Positions outside are ignored.
        kinds: Kinds of stations that count; all if None.
        time_to_live: Seconds for which a position is valid.

    Raises AisError for an unknown kind.
    """

    def __init__(
        self,
        name: str,
        address: str,
        naming: NamingService | None = None,
        *,
        area: Geometry | None = None,
        kinds: Collection[str] | None = None,
        time_to_live: float = TIME_TO_LIVE,
    ) -> None:
        unknown = sorted(set(kinds or ()) - set(KINDS))
        if unknown:
            raise AisError(
                "ais-kind", f"no station is of kind {unknown[0]!r:.60}", f"the kinds are {', '.join(KINDS)}"
            )
        super().__init__(name, "is heard over AIS")
        self._address = parse_address(address)
        self._naming = naming or NamingService()
        self._area = area
        self._kinds = None if kinds is None else frozenset(kinds)
        self._time_to_live = time_to_live
        self._streams: OrderedDict[Remote, tuple[Lines, ReceiverState]] = OrderedDict()
        self._troubles = Troubles(name)
        self._finest = Finest(time_to_live)
        self._counting = Counting()
        self._world: World | None = None
        self._port: Port | None = None
        self.played = asyncio.Event()
        """Set when a recording has been played to its end."""

    @property
    def local(self) -> Remote | None:
        """Its local address, once it listens."""
        return self._port.local if self._port else None

    async def run(self, world: World) -> None:
        """Receive until cancelled."""
        self._world = world
        hear(ReceiverState(), b"")  # report a missing extra at once
        try:
            if self._address.scheme == "file":
                await asyncio.gather(self._play(world), self._reporting(world))
            async with open_port(self._address, self._receive) as self._port:
                await self._reporting(world)
        finally:
            self._tell_unread()
            self._troubles.report(world, now=True)
            self._world = self._port = None

    async def _reporting(self, world: World) -> None:
        while True:
            await asyncio.sleep(REPORT)
            self._troubles.report(world)

    # --- received lines ---------------------------------------------------------------------------

    def _receive(self, remote: Remote, data: bytes) -> None:
        assert self._world is not None
        lines, ear = self._stream(remote)
        for line in lines.feed(data):
            ear = self._line(ear, line, self._world.now())
        self._streams[remote] = lines, ear

    def _stream(self, remote: Remote) -> tuple[Lines, ReceiverState]:
        if remote not in self._streams:
            self._streams[remote] = Lines(whole=self._address.scheme.startswith("udp")), ReceiverState()
        self._streams.move_to_end(remote)
        if len(self._streams) > MAX_REMOTES:
            self._streams.popitem(last=False)
        return self._streams[remote]

    def _line(self, ear: ReceiverState, line: bytes, now: float, shift: float = 0.0) -> ReceiverState:
        """Decode one line; `shift` moves the times of a recording to today."""
        heard = hear(ear, line, None if shift else now)
        for reason in heard.reasons:
            self._troubles.note(reason.value, repr(line[:100]))
        for piece in heard.pieces:
            if piece not in TAKEN and piece not in _REASONS:
                self._leave(piece)
        for report in heard.reports:
            if isinstance(report, PositionReport):
                self._position(_shifted(report, shift, now), now)
        return heard.ear

    def _leave(self, kind: str) -> None:
        """Count a valid line without a position; its kind is reported once, and its number at the end."""
        if kind not in self._counting.left_out:
            self._troubles.note(f"{kind}: not read", "their number is reported at the end")
        self._counting.leave(kind)

    def _tell_unread(self) -> None:
        for kind, count in sorted(self._counting.left_out.items()):
            self._troubles.note(f"{kind}: not read, in total", "", count)
        self._counting = Counting()

    def _position(self, report: PositionReport, now: float) -> None:
        assert self._world is not None
        assert report.time is not None
        if report.time > now + FUTURE:
            self._troubles.note(
                "time stamp in the future", f"{digits(report.mmsi)}, {report.time - now:.0f} s ahead"
            )
        if report.time < now - self._time_to_live:
            self._troubles.note(
                "time stamp too old", f"{digits(report.mmsi)}, {now - report.time:.0f} s behind"
            )
            return
        if self._finest.supersedes(report, min(report.time, now)):
            self._leave(COARSE)
            return
        known = physical_property(report if report.time <= now else replace(report, time=now))
        if self._wanted(known):
            self._publish(report.mmsi, known)

    def _publish(self, mmsi: int, known: PhysicalProperty) -> None:
        assert self._world is not None
        try:
            entity = self._naming.name(f"mmsi:{digits(mmsi)}")
            kind = self._naming.kind_of(entity, known.kind)
        except PhysicalError as clash:
            self._troubles.note(clash.code, clash.message)
            return
        if (entity, kind) != (known.entity, known.kind):
            known = replace(known, entity=entity, kind=kind)
        self._world.publish(Aged(known, self._time_to_live))

    def _wanted(self, known: PhysicalProperty) -> bool:
        of_kind = self._kinds is None or known.kind in self._kinds
        return of_kind and (self._area is None or contains(self._area, known.geometry))

    # --- recordings -------------------------------------------------------------------------------

    async def _play(self, world: World) -> None:
        """Replay a recording in real time."""
        ear, shift = ReceiverState(), 0.0
        for line in self._recorded():
            clock = _clock(ear, line)
            if clock is None:
                await asyncio.sleep(1 / PACE)
            elif not shift:
                shift = world.now() - clock
            else:
                await asyncio.sleep(max(0.0, clock + shift - world.now()))
            ear = self._line(ear, line, world.now(), shift)
        self.played.set()

    def _recorded(self) -> Iterator[bytes]:
        with open_file(self._address.path) as file:
            lines = Lines()
            while chunk := file.read(65_536):
                yield from lines.feed(chunk)
            yield from lines.end()


def _shifted(report: PositionReport, shift: float, now: float) -> PositionReport:
    time = now if report.time is None else report.time + shift
    return report if time == report.time else replace(report, time=time)


def _clock(ear: ReceiverState, line: bytes) -> float | None:
    """Return the time that a line implies: of its own reports, or of the next ones."""
    heard = hear(ear, line, None)
    times = [report.time for report in heard.reports if report.time is not None]
    return times[0] if times else (heard.ear.clock if heard.ear.clock != ear.clock else ear.clock)
