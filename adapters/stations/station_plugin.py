"""The station as a plugin: it shares the publications of its own plugins, and publishes those of the others.

Everything that it shares is an entry of its log, appended before it is sent. Entries are sent to all stations at once.
A station that missed some asks for them, so a lost message only delays them. A parcel stays in the log until the other
station's log acknowledges it, so it arrives exactly once in spite of crashes and partitions.
"""

from __future__ import annotations

import asyncio
from collections.abc import Container, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any, Final

from msgspec import UNSET, Raw
from msgspec.json import encode

from adapters.live.fresh_placements import MOST_AHEAD
from adapters.live.run_watchers import Watcher
from adapters.live.turn_result import Turn
from adapters.plugin import (
    Believes,
    Broken,
    Command,
    Delivered,
    Failed,
    Gone,
    HandOver,
    Hosts,
    Plugin,
    Published,
    Refused,
    Trouble,
    Underway,
    World,
    entity_of,
)
from adapters.rate_limit import Troubles
from adapters.silence_clock import Listening
from adapters.stations.authority import Authority, is_silent
from adapters.stations.bus import Bus
from adapters.stations.entries import (
    Believed,
    Broke,
    Content,
    Entry,
    Hosted,
    Posted,
    Said,
    Took,
    VehicleSent,
    entry_of,
    stamped,
)
from adapters.stations.journal import Journal
from adapters.stations.merge import ABREAST, MOST_ENTITIES, Merge, channels_of, on
from adapters.stations.outgoing import believed, entered, moved, told
from adapters.stations.peers import Peers
from adapters.stations.remote_station import SETTLED, Other, logical_digest, measured
from adapters.stations.shared_plugin import Shared
from adapters.stations.station_messages import (
    MOST_BYTES,
    MOST_ENTRIES,
    Question,
    StationMessage,
    fitting,
    read,
)
from adapters.typed_json import read_typed
from physical import PhysicalError
from physical.wordings import counted
from semantics.state.logical_model import LogicalModel

NAME: Final = "stations"
"""The plugin's name."""

TICK: Final = 0.02
"""Seconds of gathering entries before they are sent; only the newest of each entity is sent."""

MOVING: Final = frozenset({"migrate", "spawn", "enter"})
"""The rules that change the host of an agent."""

POLL: Final = 1.0
"""Seconds between two questions to each station."""

PATIENCE: Final = 2.0
SILENCE: Final = 4.0
"""Seconds without an answer after which a station is reported as not reached."""

MOST_SKEW: Final = 1.0
"""Seconds by which clocks may differ before it is reported."""

MOST_STRANGERS: Final = MOST_ENTITIES // 4
"""The most shared entities of each plugin that the mission does not name."""

MOST_PARCELS: Final = 10_000
"""The most waiting parcels of one station; more are requested later."""


class Sharing(Watcher):
    """The plugin of one station; it also watches the run.

    Arguments:
        peers: The stations.
        journal: The log of this station.
        topic: The mission's name between them.
        digest: The mission's digest: stations with another one are ignored.
        vehicles: The entities that only their own links may report, and whether each obeys a station.
        named: The entities of the mission; of others a limited number of each plugin is shared.

    Attributes:
        begun: Whether the run has begun.
    """

    name = NAME

    def __init__(
        self,
        peers: Peers,
        journal: Journal,
        topic: str,
        digest: str,
        vehicles: Mapping[str, bool],
        named: Container[str] = (),
    ) -> None:
        self.merge = Merge()
        self.others = {name: Other() for name in peers.others}
        self._peers = peers
        self._journal = journal
        self._topic = topic
        self._digest = digest
        self._vehicles = vehicles
        self._named = named
        self._strangers: dict[str, set[str]] = {}
        self._authority = Authority(journal.station)
        self._troubles = Troubles(NAME)
        if journal.dropped:
            self._troubles.note("damaged log", journal.dropped)
        self._ahead: set[str] = set()
        self._unsaid: dict[tuple[str, ...], Entry] = {}
        self._said = journal.last
        self._world: World | None = None
        self._listening = Listening(0.0)
        self._introduced = False
        self._logical: LogicalModel | None = None
        self._mute = False
        self.begun = False

    # --- as a plugin

    def owns(self, entity: str) -> bool:  # noqa: ARG002 - a plugin's interface
        """Return False: other stations' vehicles take no commands from here."""
        return False

    async def command(self, command: Command) -> None:
        """Refuse: commands go over a vehicle's own link."""
        raise Refused(f"{command.entity} is another station's", f"give --vehicle {command.entity}=...")

    async def run(self, world: World) -> None:
        """Share until cancelled."""
        self._world = world
        bus = Bus(self._peers, self._topic, self._hear, self._answer)
        self._listening = Listening(world.now())
        for other in self.others.values():
            other.answered = self._listening.looked
        for entry in self._journal.entries():
            self._take(entry)
        try:
            following = (self._follow(bus, name, other) for name, other in self.others.items())
            await asyncio.gather(self._putting(bus), self._watching(), *following)
        finally:
            self._put(bus)
            bus.close()
            self.close()

    def close(self) -> None:
        """Close the log, also for a run that has not begun."""
        self._journal.close()

    def sharing(self, plugin: Plugin) -> Plugin:
        """Return a plugin that shares its publications with all stations."""
        return Shared(plugin, self)

    # --- as a watcher

    def turned(self, turn: Turn, now: float) -> None:
        """Share a turn's entries for the others; the recording has the turn already."""
        self._logical = turn.state.configuration.structure.logical
        for station, number in entered(turn).items():
            self.others[station].drop(number)
        contents: list[Content] = [*believed(turn, self.merge)]
        if not self._introduced or any(step.transition.label.rule in MOVING for step in turn.steps):
            contents += moved(turn.state.configuration, self.merge, now)
            self._introduced = True
        known = {name: other.last for name, other in self.others.items() if other.last}
        contents += told(turn, self._vehicles, known)
        for entry in self._add(contents):
            self.merge.hear(entry)

    # --- sending

    def publish(self, plugin: Plugin, world: World, published: Published) -> None:
        """Take a publication of an own plugin: share it, and publish the merged state to our own world."""
        published = stamped(published, world.now())
        entity, owned = entity_of(published), plugin.owns(entity_of(published))
        if entity in self._vehicles and not owned:
            world.publish(published)  # refused there, and reported
            return
        if not self._has_room(plugin.name, entity):
            world.publish(published)  # our own run may take it in
            return
        before = self._journal.word(("said", entity))
        if isinstance(before, Said) and before.time > Said(published, 0.0).time:
            return
        said = Said(published, world.now(), owned)
        if owned:
            known = self._holds(entity, world.now())
            if known is None and self._vehicles.get(entity) and is_silent(channels_of(published)):
                return  # its authority is unknown: it may answer only another station's link
            now = world.now()
            missed = now - self._listening.look(now)
            channels, since = self._authority.channels(entity, published, known, now, missed)
            said = Said(on(published, channels), since, owned)
        entries = self._add([said])
        for entry in entries:
            self._join(entry)
        if entries:
            self._show(world, entity)
        else:
            world.publish(published)  # it can no longer be shared; our own run sees it

    def _has_room(self, plugin: str, entity: str) -> bool:
        """Return whether an entity is shared: a flood on one feed leaves room for the others."""
        told = self._strangers.setdefault(plugin, set())
        if entity in self._named or entity in told:
            return True
        if len(told) >= MOST_STRANGERS:
            self._troubles.note(
                "not shared", f"'{plugin}': over {MOST_STRANGERS:,} entities that the mission does not name"
            )
            return False
        told.add(entity)
        return True

    def lags(self, entity: str) -> bool:
        """Return whether a vehicle obeys us, and our link has not read it yet."""
        now = 0.0 if self._world is None else self._world.now()
        return self._authority.lags(entity, self._holds(entity, now))

    def commanded(self, command: Command) -> None:
        """Record a hand-over command to one of our vehicles."""
        if isinstance(command, HandOver):
            self._authority.hand_overs[command.entity] = command

    def _add(self, contents: Sequence[Content]) -> list[Entry]:
        """Share contents as entries; a failure of the log ends sharing, since unlogged entries must not be sent."""
        if not contents or self._mute:
            return []
        try:
            entries = self._journal.add(list(contents))
        except OSError as error:
            self._mute = True
            assert self._world is not None
            self._world.report(Failed.by(error, str(self._journal.path), self._world.now()))
            return []
        for entry in entries:
            self._unsaid.pop(entry.content.key, None)
            self._unsaid[entry.content.key] = entry
        return entries

    async def _putting(self, bus: Bus) -> None:
        while True:
            await asyncio.sleep(TICK)
            self._put(bus)

    def _put(self, bus: Bus) -> None:
        """Send the gathered entries; stations that missed earlier ones ask for them."""
        if self._unsaid:
            entries = list(self._unsaid.values())
            texts, upto = fitting(entries, self._journal.last)
            bus.put(self._message(texts, upto, after=self._said))
            self._said = upto
            for entry in entries[: len(texts)]:
                del self._unsaid[entry.content.key]

    def _message(self, entries: Sequence[Raw], upto: int, after: int) -> bytes:
        assert self._world is not None
        return encode(
            StationMessage(
                self._digest,
                self._world.now(),
                after,
                upto,
                self._journal.last,
                entries,
                self._digest_of_l(),
                self.begun,
            )
        )

    def _digest_of_l(self) -> str:
        """Return the digest of our L; empty before the first turn."""
        return "" if self._logical is None else logical_digest(self._logical)

    def _answer(self, _key: str, question: bytes) -> bytes:
        """Answer with the entries after a number."""
        after = 0
        with suppress(PhysicalError):
            after = read_typed(question, MOST_BYTES, Question).after
        texts, upto = fitting(*self._journal.after(after, MOST_ENTRIES))
        return self._message(texts, upto, after)

    # --- receiving

    def _hear(self, station: str, said: bytes) -> None:
        """Take sent entries; ask at once for missed ones."""
        other, message = self.others[station], self._read(station, said)
        if message is None:
            return
        if not other.follow(message, whole=self._take_all(station, message.entries)):
            other.awake.set()
        self._deliver()

    async def _follow(self, bus: Bus, station: str, other: Other) -> None:
        """Ask a station repeatedly for missed entries and for its time."""
        assert self._world is not None
        world = self._world
        while True:
            asked = world.now()
            try:
                answer = await bus.ask(station, encode(Question(other.heard)), PATIENCE)
            except OSError:
                self._silent(world, station, other)
                await asyncio.sleep(POLL)
                continue
            more = self._told(world, station, self._read(station, answer), asked)
            other.delivered = 0  # parcels that have not entered are delivered again
            self._deliver()
            if not more:
                other.awake.clear()
                with suppress(TimeoutError):
                    async with asyncio.timeout(POLL):
                        await other.awake.wait()

    def _told(self, world: World, station: str, message: StationMessage | None, asked: float) -> bool:
        """Take an answer; return whether there is more to ask for."""
        other = self.others[station]
        if message is None:
            return False
        self._found(world, station, other, message.time, asked)
        if other.compare(message.logical, self._digest_of_l(), world.now()):
            detail = f"it has believed otherwise for {SETTLED:g} s: compare the bigraphs of both consoles"
            world.report(Trouble(NAME, world.now(), f"the L of {station} differs from ours", detail))
        return (
            other.follow(message, whole=self._take_all(station, message.entries)) and other.heard < other.last
        )

    def _read(self, station: str, said: bytes) -> StationMessage | None:
        """Read a message; report invalid ones, and stations with another mission."""
        try:
            message = read(said)
        except ValueError as error:
            self._troubles.note("unreadable message", f"from {station}: {error!s:.200}")
            return None
        if message.mission != self._digest:
            detail = f"{station} flies another mission, or another version of it: give all the same"
            self._troubles.note("another mission", detail)
            return None
        self.others[station].begun = message.begun
        return message

    def _take_all(self, station: str, entries: Sequence[Any]) -> bool:
        """Take entries; return whether there was room for all."""
        for data in entries:
            try:
                entry = entry_of(station, data)
                if isinstance(entry.content, Posted) and len(self.others[station].parcels) >= MOST_PARCELS:
                    return False
                self._take(entry)
            except ValueError as error:
                self._troubles.note("unreadable entry", f"from {station}: {error!s:.200}")
        return True

    def _take(self, entry: Entry) -> None:
        assert self._world is not None
        match entry.content:
            case Said(_, _, owned) as said:
                if said.entity in self._vehicles and not owned:
                    detail = f"{entry.station} reports {said.entity}, which is a vehicle, without its link"
                    self._troubles.note("not its vehicle", detail)
                elif self._join(entry):
                    self._show(self._world, said.entity)
            case VehicleSent(entity) if self.merge.hear(entry):
                self._pass_on(self.merge.leg(entity))
            case Hosted(agent) if self.merge.hear(entry):
                self._pass_on(self.merge.home(agent))
            case Believed(node, slot) if self.merge.hear(entry):
                self._pass_on(self.merge.belief(slot, node))
            case Broke(assumption) if assumption and entry.station != self._journal.station:
                self._world.report(Broken(entry.station, self._world.now(), assumption))
            case Posted(to, index) as posted:
                if to == self._journal.station != entry.station and index > self._journal.took(entry.station):
                    self.others[entry.station].parcels[index] = posted
            case Took(of, index):
                if of == self._journal.station != entry.station:
                    self._journal.taken(entry.station, index)

    def _pass_on(self, entry: Entry | None) -> None:
        """Report another station's latest entry on a flight, a host or a slot of L to the run."""
        assert self._world is not None
        now = self._world.now()
        match entry:
            case Entry(content=Believed(node, slot, names)):
                self._world.report(Believes(node, now, slot, names))
            case Entry(station) if station == self._journal.station:
                pass  # the run knows
            case Entry(station, _, VehicleSent(entity, to, time)):
                self._world.report(Underway(entity, now, to, self.others[station].here(time)))
            case Entry(content=Hosted(agent, host)):
                self._world.report(Hosts(agent, now, host))

    def _join(self, entry: Entry) -> bool:
        """Join an entry to the merge; return whether it made a difference."""
        assert self._world is not None
        if self.merge.hear(entry) is None:
            return False
        said, now = entry.content, self._world.now()
        if isinstance(said, Said) and said.time > now + MOST_AHEAD:
            self._ahead.add(said.entity)
            detail = f"{entry.station} reports {said.entity} with a time {said.time - now:.0f} s ahead: set its clock"
            self._troubles.note("time stamp in the future", detail)
        return True

    def _holds(self, entity: str, now: float) -> Said | None:
        """Return the state of an entity; for a vehicle that obeys us on our own link, that link decides."""
        own = self.merge.own(entity, self._journal.station, now) if self._authority.keeps(entity) else None
        found = self.merge.holds(entity, now)
        if own is None or found is None or isinstance(own.published, Gone):
            return found
        if now - own.time <= ABREAST or isinstance(found.published, Gone):
            return own
        return replace(found, published=on(found.published, channels_of(own.published)), since=own.since)

    def _show(self, world: World, entity: str) -> None:
        said = self._holds(entity, world.now())
        if said is not None:
            world.publish(said.published)

    def _deliver(self) -> None:
        """Report the parcels that may enter to the run."""
        assert self._world is not None
        for station, other in self.others.items():
            if other.parcels:
                for index, posted in other.due(self.others, self._journal.took(station)):
                    done = None if posted.time is UNSET else other.here(posted.time)
                    self._world.report(Delivered(station, self._world.now(), index, posted.parcel, done))

    # --- links and clocks

    async def _watching(self) -> None:
        """Show entries once their times are no longer in the future, and report presence and troubles."""
        assert self._world is not None
        world = self._world
        while True:
            await asyncio.sleep(POLL)
            self._listening.look(world.now())
            early = (
                {entry.content.key[1] for entry in self.merge.ahead(world.now())} if self._ahead else set()
            )
            for entity in sorted(self._ahead - early):
                self._show(world, entity)
            self._ahead &= early
            for station, other in self.others.items():
                if (presence := other.presence(station, world.now())) is not None:
                    world.report(presence)
            self._troubles.report(world)

    def _silent(self, world: World, station: str, other: Other) -> None:
        silent = self._listening.look(world.now()) - other.answered
        if other.reached is not False and silent > SILENCE:
            other.reached = False
            where = ", ".join(self._peers.others[station].connect)
            waiting = self._journal.waiting(station)
            kept = f"; {counted(waiting, 'parcel')} to be sent" if waiting else ""
            detail = f"nothing from {station} at {where} for {silent:.0f} s; attempts go on{kept}"
            world.report(Trouble(NAME, world.now(), f"{station} is not reached", detail))

    def _found(self, world: World, station: str, other: Other, theirs: float, asked: float) -> None:
        now = world.now()
        if other.reached is False:
            world.report(Trouble(NAME, now, f"{station} is reached again"))
        other.reached, other.answered, other.met = True, self._listening.look(now), now
        other.skew.add(measured(asked, theirs, now))
        best = other.skew.best
        skewed = best is not None and best.exceeds(MOST_SKEW)
        if best is not None and skewed and not other.skewed:
            detail = f"it is {best.ahead:+.1f} s off ours (to {best.error:.2f} s): set both, as by NTP"
            world.report(Trouble(NAME, now, f"the clock of {station}", detail))
        other.skewed = skewed
