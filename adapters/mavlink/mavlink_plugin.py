"""The autopilot plugin: one MAVLink link with the vehicles on it."""

from __future__ import annotations

import asyncio
from collections import OrderedDict
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, Final

from adapters.addresses import parse_address
from adapters.mavlink import loiter_circle
from adapters.mavlink import pilot as piloting
from adapters.mavlink import roster as rosters
from adapters.mavlink.codec import Decoder, Encoder, Garbage
from adapters.mavlink.constants import GROUND_COMPONENT, GROUND_STATION, NO_AUTOPILOT
from adapters.mavlink.inventory import overheard
from adapters.mavlink.keys import Keeper
from adapters.mavlink.message import MavlinkMessage, say
from adapters.mavlink.objections import impassable, remarks, unfit
from adapters.mavlink.onboard_fences import fence_on_board
from adapters.mavlink.pilot import Outcome, Pilot
from adapters.mavlink.roster import Roster
from adapters.mavlink.signing import Verdict
from adapters.mavlink.vehicle_identities import Craft, Stations
from adapters.plugin import (
    NOWHERE_ELSE,
    Aged,
    Command,
    Failed,
    GoTo,
    LinkLost,
    Readiness,
    Rebind,
    Refused,
    Report,
    Status,
    StatusText,
    World,
)
from adapters.rate_limit import Ration, Troubles
from adapters.silence_clock import Listening
from adapters.transport import Port, Remote, open_port
from physical import Geometry, PhysicalError, Surroundings

TICK: Final = 0.2
"""Seconds between two ticks of a pilot."""

AT_ONCE: Final = 8
"""Pilots whose ticks run in one go; then the event loop serves others."""

HEARTBEAT: Final = 1.0
MAX_REMOTES: Final = 64
"""The most remote addresses with a parser; beyond it, the longest unheard address without a vehicle is dropped."""

MOST_LOGGED: Final = 1_000
"""The most received packets logged in a second."""

MOST_TEXTS: Final = 10
"""The most texts of a vehicle reported in a second."""

Tap = Callable[[float, bytes], None]
Listener = Callable[[str, Mapping[str, Any], float], None]
"""The receiver of every frame heard and sent, with its time: a tlog. Its rate in a flood is limited."""


class Autopilot:
    """A plugin for the vehicles on one address.

    Arguments:
        name: Its name in reports.
        address: The address of the link, such as `udp:127.0.0.1:14550`.
        crafts: The vehicles that are expected there.
        stations: The stations that may command them.
        keeper: The signing key, if packets are signed; then unsigned ones are ignored.
        tap: Receives every frame.
        listeners: For each vehicle, a receiver of its accepted messages with our time.

    Raises PhysicalError if two vehicles cannot be distinguished.
    """

    def __init__(  # noqa: PLR0913, PLR0917 - each is one property of a link
        self,
        name: str,
        address: str,
        crafts: Sequence[Craft],
        stations: Stations | None = None,
        keeper: Keeper | None = None,
        tap: Tap | None = None,
        listeners: Mapping[str, Listener] | None = None,
    ) -> None:
        self._stations = stations or Stations()
        self._own = frozenset(self._stations.ids[name] for name in self._stations.own)
        _check_crafts(crafts, self._stations)
        self._name = name
        self._address = parse_address(address)
        self._pilots = {
            craft.entity: Pilot(craft, self._stations, _bound(craft), signs=keeper is not None)
            for craft in crafts
        }
        self._roster = Roster()
        self._systems: dict[int, str] = {}
        self._strangers: set[int] = set()
        self._keeper = keeper
        self._tap = tap
        self._listeners = listeners or {}
        self._logged: Ration[None] = Ration(MOST_LOGGED)
        self._texts: Ration[str] = Ration(MOST_TEXTS)
        self._decoders: OrderedDict[Remote, Decoder] = OrderedDict()
        self._encoders: dict[int, Encoder] = {}
        self._routes: dict[int, Remote] = {}
        self._elsewhere: dict[int, set[Remote]] = {}
        self._troubles = Troubles(name)
        self._world: World | None = None
        self._listening = Listening(0.0)
        self._port: Port | None = None

    @property
    def name(self) -> str:
        """Its name in reports."""
        return self._name

    def owns(self, entity: str) -> bool:
        """Whether the vehicle is expected on this link."""
        return entity in self._pilots

    def pilot(self, entity: str) -> Pilot:
        """Return the state of a vehicle."""
        return self._pilots[entity]

    @property
    def local(self) -> Remote | None:
        """Its local address, once it listens."""
        return self._port.local if self._port else None

    @property
    def fences(self) -> dict[str, Geometry]:
        """The fence of each vehicle that has one."""
        crafts = (pilot.craft for pilot in self._pilots.values())
        return {craft.entity: craft.fence for craft in crafts if craft.fence is not None}

    def objection(
        self, entity: str, place: Geometry, name: str, around: Surroundings = NOWHERE_ELSE
    ) -> str | None:
        """Return the reason why a vehicle can't stay at a place, as far as its kind is known; None if it can."""
        pilot = self._pilots[entity]
        command = GoTo("", entity, place, name=name, around=around)
        return unfit(command, pilot.craft, pilot.known, pilot.on_board)

    def bar(self, entity: str, place: Geometry, name: str) -> str | None:
        """Return the reason why a vehicle can't pass a place; None if it can."""
        pilot = self._pilots[entity]
        return impassable(place, pilot.craft, pilot.known, name, pilot.on_board)

    def circle(self, entity: str) -> float:
        """Return the diameter in metres of a vehicle's circle; 0 if it hovers, or its kind is unknown."""
        pilot = self._pilots[entity]
        profile = pilot.known.profile
        return 0.0 if profile is None else 2 * loiter_circle.circle(pilot.craft, profile, pilot.known)

    def is_known(self) -> bool:
        """Return whether all vehicles have reported their parameters, or were asked for long enough."""
        return all(map(piloting.is_known, self._pilots.values()))

    def remarks(self) -> Iterator[str]:
        """Yield messages to the operator about the vehicles before take-off."""
        for pilot in self._pilots.values():
            yield from remarks(pilot.craft, pilot.known, pilot.on_board, pilot.survey.given_up)

    def readiness(self, entity: str) -> Readiness:
        """Return a vehicle's fence as read back, and its recent reasons why it cannot be armed."""
        pilot = self._pilots[entity]
        found = fence_on_board(pilot.craft.fence, pilot.on_board)
        return Readiness(
            found, pilot.known.unready(self._listening.look(self._world.now()) if self._world else 0.0)
        )

    async def command(self, command: Command) -> None:
        """Take on a command; raises Refused."""
        if self._world is None or not self.owns(command.entity):
            raise Refused(f"{command.entity} takes no commands from {self._name}", "start the plugin first")
        if isinstance(command, Rebind):
            self._rebind(self._pilots[command.entity], command.source)
            return
        self._take(command.entity, piloting.command(self._pilots[command.entity], command, self._listened()))

    async def run(self, world: World) -> None:
        """Serve the link until cancelled."""
        self._world, self._listening = world, Listening(world.now())
        try:
            async with open_port(self._address, self._receive) as self._port:
                await asyncio.gather(self._ticking(world), self._beating())
        finally:
            if self._keeper is not None:
                self._keeper.save()
                self._note_unsaved(self._keeper)
            self._troubles.report(world, now=True)
            self._world = self._port = None

    # --- received messages ------------------------------------------------------------------------

    def _receive(self, remote: Remote, data: bytes) -> None:
        for found in self._decoder(remote).feed(data):
            if isinstance(found, Garbage):
                self._troubles.note(found.reason, f"from {remote[0]}:{remote[1]}")
            elif self._believed(found):
                self._hear(remote, found)

    def _decoder(self, remote: Remote) -> Decoder:
        decoder = self._decoders.get(remote)
        if decoder is None:
            decoder = self._decoders[remote] = Decoder()
        self._decoders.move_to_end(remote)
        if len(self._decoders) > MAX_REMOTES:
            bound = frozenset(self._routes.values())
            strange = next((each for each in self._decoders if each not in bound), remote)
            del self._decoders[strange]
        return decoder

    def _believed(self, message: MavlinkMessage) -> bool:
        if self._keeper is None:
            return True
        verdict = self._keeper.judge(message)
        self._note_unsaved(self._keeper)
        if verdict is not Verdict.GOOD:
            self._troubles.note(verdict.value, f"{message.name} of system {message.system}")
        return verdict is Verdict.GOOD

    def _note_unsaved(self, keeper: Keeper) -> None:
        if keeper.trouble:
            detail = f"{keeper.trouble}: after a crash, packets could be replayed"
            self._troubles.note("signing state not written", detail)
            keeper.trouble = ""

    def _hear(self, remote: Remote, message: MavlinkMessage) -> None:
        assert self._world is not None
        now = self._world.now()
        if self._logged.takes(None, now):
            self._log(now, message.raw)
        for _, count in self._logged.left_out(now):
            self._troubles.note("not logged", f"{count:,} packets, over {MOST_LOGGED:,} in a second")
        if self._is_of_a_station(message):
            self._overheard(message)
            return
        listened = self._listening.look(now)
        pilot = self._pilot_of(message, remote, listened)
        if pilot is None or not self._is_its_source(pilot, remote):
            return
        if not self._is_for_us(message):
            self._pilots[pilot.craft.entity] = overheard(pilot, message)
            return
        self._routes[pilot.system] = remote
        self._take(pilot.craft.entity, piloting.hear(pilot, message, listened))
        if (listener := self._listeners.get(pilot.craft.entity)) is not None:
            listener(message.name, message.fields, now)

    def _is_its_source(self, pilot: Pilot, remote: Remote) -> bool:
        """Whether an address is the vehicle's source: without signatures, only its first address is."""
        bound = self._routes.get(pilot.system, remote)
        if self._keeper is not None or bound == remote:
            return True
        others = self._elsewhere.setdefault(pilot.system, set())
        if remote not in others and len(others) < MAX_REMOTES:
            others.add(remote)
            entity, there = pilot.craft.entity, _shown(remote)
            detail = (
                f"{entity} is accepted from {_shown(bound)} alone, but packets in its name come from {there}"
            )
            remedy = f"if it has moved, run this once it is silent: bigactors give-back {entity} --at {there}"
            self._troubles.note(f"second source of {entity}", f"{detail}; {remedy}")
        return False

    def _rebind(self, pilot: Pilot, source: str) -> None:
        """Accept a vehicle's messages from another address, if the old one is silent."""
        host, _, port = source.rpartition(":")
        bound = self._routes.get(pilot.system)
        entity = pilot.craft.entity
        if self._keeper is not None:
            self._troubles.note(
                "source kept", f"{entity} signs its packets, and is accepted from any address"
            )
        elif bound is None or not pilot.link.lost:
            at = "nowhere as yet" if bound is None else f"from {_shown(bound)}"
            self._troubles.note("source kept", f"{entity} is heard {at}; it can move when it is silent")
        else:
            self._routes[pilot.system] = host.removeprefix("[").removesuffix("]"), int(port)
            self._elsewhere.pop(pilot.system, None)

    def _is_of_a_station(self, message: MavlinkMessage) -> bool:
        """Whether a message is of a ground station, by its id, its heartbeat, or its target."""
        if message.system in self._stations.ids.values():
            return True
        if message.name == "HEARTBEAT":
            return bool(message["type"] == GROUND_STATION)
        return message.system not in self._systems and self._addressed(message) is not None

    def _addressed(self, message: MavlinkMessage) -> Pilot | None:
        to = message.target
        return next((pilot for pilot in self._pilots.values() if to and pilot.system == to), None)

    def _overheard(self, message: MavlinkMessage) -> None:
        """Report that another ground station sends to a vehicle of ours; items that it may change are read again."""
        pilot = self._addressed(message)
        if message.system not in self._own and pilot is not None:
            self._troubles.note("second ground station", f"system {message.system} sends {message.name}")
            self._pilots[pilot.craft.entity] = overheard(pilot, message)

    def _is_for_us(self, message: MavlinkMessage) -> bool:
        return not message.target or message.target in self._own

    def _pilot_of(self, message: MavlinkMessage, remote: Remote, now: float) -> Pilot | None:
        known = self._systems.get(message.system)
        possible = self._pilots.values() if known is None else (self._pilots[known],)
        found = rosters.find(self._roster, possible, message, now)
        self._roster = found.roster
        if found.question is not None:
            for name in self._stations.own:  # it may obey any of them, and only that one
                self._send(replace(found.question, system=self._stations.ids[name]), remote)
        if found.stranger and message.system not in self._strangers:
            self._strangers.add(message.system)
            serial = self._roster.serials.get(message.system)
            called = f"system {message.system}" + (f" with serial number {serial}" if serial else "")
            detail = f"{called} is no vehicle of the mission; add it, or keep it off this link"
            self._troubles.note("unknown vehicle", detail)
        return found.pilot

    # --- results and sent messages ----------------------------------------------------------------

    def _listened(self) -> float:
        """Return the pilots' time, which stops while this process does not listen."""
        assert self._world is not None
        return self._listening.look(self._world.now())

    def _take(self, entity: str, outcome: Outcome) -> None:
        """Carry out the results of an input; publications get the world's time."""
        assert self._world is not None
        self._pilots[entity], missed = outcome.pilot, self._listening.missed
        if outcome.pilot.system:
            self._systems[outcome.pilot.system] = entity
        for published in outcome.published:
            self._world.publish(_later(published, missed))
        for report in outcome.reports:
            self._world.report(_reported_later(report, missed))
        for seen in outcome.seen:
            self._show(seen, missed)
        for message in outcome.sent:
            self._send(message, self._routes.get(outcome.pilot.system))

    def _show(self, seen: Status | StatusText, missed: float) -> None:
        """Report a vehicle's status or text; texts above the limit are left out."""
        assert self._world is not None
        if isinstance(seen, Status):
            heard = None if seen.heard is None else seen.heard + missed
            seen = replace(seen, plugin=self._name, heard=heard)
        elif not self._texts.takes(seen.entity, seen.time):
            return
        self._world.report(replace(seen, time=seen.time + missed))

    def _send(self, message: MavlinkMessage, remote: Remote | None) -> None:
        assert self._world is not None
        if self._port is None:
            return
        now = self._world.now()
        timestamp = self._keeper.stamp(now) if self._keeper else 0
        frame = self._encoder(message.system).pack(message, timestamp)
        self._port.send(frame, remote)
        self._log(now, frame)

    def _log(self, now: float, frame: bytes) -> None:
        if self._tap is None:
            return
        try:
            self._tap(now, frame)
        except OSError as error:
            self._tap = None
            assert self._world is not None
            self._world.report(Failed.by(error, "the telemetry log", now))

    def _encoder(self, system: int) -> Encoder:
        if system not in self._encoders:
            key = self._keeper.key if self._keeper else None
            self._encoders[system] = Encoder(system, GROUND_COMPONENT, key)
        return self._encoders[system]

    async def _ticking(self, world: World) -> None:
        while True:
            for some in (groups := _groups([*self._pilots])):
                await asyncio.sleep(TICK / len(groups))
                for entity in some:
                    self._take(entity, piloting.tick(self._pilots[entity], self._listened()))
            for entity, count in self._texts.left_out(self._listened()):
                self._troubles.note(
                    f"texts of {entity} left out", f"{count:,} texts, over {MOST_TEXTS} in a second"
                )
            self._troubles.report(world)

    async def _beating(self) -> None:
        """Send heartbeats: at once to an address that we connect to, else once a vehicle was heard there."""
        while True:
            for name in self._stations.own:
                beat = replace(_heartbeat(), system=self._stations.ids[name])
                for remote in dict.fromkeys(self._routes.values()) or [None]:
                    self._send(beat, remote)
            await asyncio.sleep(HEARTBEAT)


def _groups(entities: Sequence[str]) -> list[Sequence[str]]:
    """Return groups of vehicles whose pilots tick together; one empty group if there are none."""
    return [entities[first : first + AT_ONCE] for first in range(0, len(entities), AT_ONCE)] or [()]


def _shown(remote: Remote) -> str:
    host, port = remote
    return f"[{host}]:{port}" if ":" in host else f"{host}:{port}"


def _heartbeat() -> MavlinkMessage:
    return say(
        "HEARTBEAT",
        type=GROUND_STATION,
        autopilot=NO_AUTOPILOT,
        base_mode=0,
        custom_mode=0,
        system_status=4,
        mavlink_version=3,
    )


def _later(published: Aged, seconds: float) -> Aged:
    """Return a publication with its time shifted."""
    said = published.property
    assert said.time is not None, "a position is stamped when it is heard"
    return replace(published, property=replace(said, time=said.time + seconds)) if seconds else published


def _reported_later(report: Report, seconds: float) -> Report:
    if isinstance(report, LinkLost):
        report = replace(report, since=report.since + seconds)
    return replace(report, time=report.time + seconds)


def _bound(craft: Craft) -> int:
    """Return a vehicle's system id, 0 if it is not known yet."""
    return craft.system or 0 if craft.serial is None else 0


def _check_crafts(crafts: Sequence[Craft], stations: Stations) -> None:
    systems = [craft.system or craft.serial for craft in crafts]
    if set(systems) & set(stations.ids.values()):
        raise PhysicalError(
            "vehicles", "a vehicle and a station share a system id", "give the station another"
        )
    names = [craft.entity for craft in crafts]
    if len(set(names)) < len(names) or len(set(systems)) < len(systems):
        raise PhysicalError(
            "vehicles",
            "two vehicles on one link have the same name or system id, or more than one has none",
            "give each a system id or a serial number of its own",
        )
    if any(craft.system is not None and not 0 < craft.system < 256 for craft in crafts):
        raise PhysicalError(
            "vehicles", "a system id is not from 1 to 255", "take the vehicle's own (SYSID_THISMAV)"
        )
