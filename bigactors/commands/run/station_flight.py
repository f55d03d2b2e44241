"""`run --station NAME --peers FILE`: a mission flown by several stations, each with its own part of it."""

from __future__ import annotations

import time
from argparse import Namespace
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from adapters.live.command_planning import is_authority
from adapters.live.plan import Plan
from adapters.plugin import Plugin
from adapters.stations.entries import Believed, Broke, Content, Posted, Took, VehicleSent
from adapters.stations.journal import Journal, JournalError
from adapters.stations.peers import Peers, read_peers
from adapters.stations.station_plugin import NAME, Sharing
from bigactors.files import file_stem
from bigactors.mission_lookup import digest_of
from bigactors.mistakes import Mistake, near_or_known, unreadable
from bigactors.recordings import Resumed
from physical import PhysicalError
from semantics.state.parcel_serialization import parcel_json
from semantics.state.station_partition import Parting, parted, took_cell
from specs.elaboration import ElaboratedMission


@dataclass(frozen=True, slots=True)
class Company:
    """One station of several.

    Attributes:
        sharing: The plugin that exchanges data with the other stations.
        parting: Its part of the mission.
    """

    sharing: Sharing
    parting: Parting

    def plan(self, plan: Plan, mission: ElaboratedMission) -> Plan:
        """Return the run's constants at this station: its part of the mission. Other stations report their vehicles."""
        elsewhere = dict.fromkeys(driven(mission) - plan.vehicles.keys(), NAME)
        first = parted(mission.initial, self.parting)
        return replace(plan, first=first, vehicles={**plan.vehicles, **elsewhere}, peers=NAME)

    def plugins(self, plugins: Sequence[Plugin]) -> tuple[Plugin, ...]:
        """Return the plugin of the other stations, to be started first, then our plugins, wrapped to share data."""
        return (self.sharing, *map(self.sharing.sharing, plugins))


def own_station(options: Namespace) -> str | None:
    """Return the name of this run's station, None if it is the only one; raises Mistake."""
    found = sorted({name for name, number in options.station if number is None})
    if len(found) > 1:
        raise Mistake(f"a run is one station, not {' and '.join(found)}", "start another run for the other")
    if found and options.peers is None:
        raise Mistake(f"the peers of station '{found[0]}' are not given", "give them: --peers FILE")
    if options.peers is not None and not found:
        raise Mistake("the name of this station is not given", "give it: --station NAME")
    return found[0] if found else None


def company_of(options: Namespace, mission: ElaboratedMission, before: Resumed | None) -> Company | None:
    """Return this run's station and its part of the mission, None if it is the only one; raises Mistake."""
    station = own_station(options)
    if station is None:
        return None
    peers = _peers(options, station)
    _check_hosts(peers, mission, options.peers)
    if before is not None and not _is_same(before.station, peers):
        raise Mistake(
            "it records another station, or other peers", f"resume it as {station} was run", options.resume
        )
    digest = digest_of(mission)
    path = Path(options.station_log or f"{file_stem(mission.name)}.{station}.log")
    try:
        journal = Journal(path, station, digest)
    except JournalError as error:
        raise Mistake(str(error), "give another with --station-log FILE") from error
    except OSError as error:
        raise unreadable(str(path), error) from error
    parting = _parting(peers, journal, before)
    topic = file_stem(mission.name)
    return Company(Sharing(peers, journal, topic, digest, _obeying(mission), mission.setting.kinds), parting)


def driven(mission: ElaboratedMission) -> set[str]:
    """Return the vehicles of a mission: the entities that exist and are of a driven kind."""
    setting, physical = mission.setting, mission.initial.structure.physical
    return {name for name in setting.driven() if name in physical}


def _obeying(mission: ElaboratedMission) -> dict[str, bool]:
    """Return the vehicles of a mission, each with whether a station has control authority over it."""
    physical = mission.initial.structure.physical
    return {name: any(map(is_authority, physical.channels(name))) for name in sorted(driven(mission))}


def _peers(options: Namespace, station: str) -> Peers:
    try:
        return read_peers(Path(options.peers), station)
    except PhysicalError as error:
        raise Mistake(error.message, error.hint, options.peers) from error
    except OSError as error:
        raise unreadable(options.peers, error) from error


def _check_hosts(peers: Peers, mission: ElaboratedMission, place: str) -> None:
    """Refuse stations and hosts that the mission doesn't have, and bigActors without a station."""
    kinds, alpha = mission.setting.kinds, mission.initial.alpha
    for host, station in peers.hosts.items():
        if host not in kinds:
            what = "station" if host == station else f"host of [{station}]"
            hint = near_or_known(host, map(alpha.host, alpha.names()), "hosts of bigActors")
            raise Mistake(f"the mission has no host '{host:.60}', a {what} here", hint, place)
    for agent in alpha.names():
        host = alpha.host(agent)
        if host not in peers.hosts:
            hint = f'add hosts = ["{host}"] to the station that is to run it'
            raise Mistake(f"no station runs the bigActor {agent}, which is hosted at {host}", hint, place)


def _is_same(flown: Parting | None, peers: Peers) -> bool:
    return flown is not None and (flown.here, flown.hosts) == (peers.own.name, peers.hosts)


def _parting(peers: Peers, journal: Journal, before: Resumed | None) -> Parting:
    """Return a station's part of a mission; a resumed run first adds missing entries to its log."""
    here = peers.own.name
    journal.add([*_amended(journal, before)])
    if before is None:
        sent = {name: journal.sent(name) for name in peers.others}
        return Parting(here, peers.hosts, sent, {name: journal.took(name) for name in peers.others})
    assert before.station is not None
    for left in before.left:
        if left.number > journal.sent(left.station):
            journal.add([Posted(left.station, left.number, parcel_json(left.parcel))])
    for name in peers.others:
        taken = before.configuration.read(took_cell(name)) or 0
        if taken > journal.took(name):
            journal.add([Took(name, taken)])
    return before.station


def _amended(journal: Journal, before: Resumed | None) -> Iterator[Content]:
    """Yield the entries that bring the log up to date with the run, after a crash or a new start."""
    now, kinds = time.time(), {} if before is None else before.configuration.setting.kinds
    physical = None if before is None else before.configuration.structure.physical
    for entry in list(journal.entries()):
        match entry.content:
            case VehicleSent(entity, known):
                to = "" if physical is None or entity not in kinds else physical.going_to(entity)
                if to != known:
                    yield VehicleSent(entity, to, now)
            case Believed(node, slot, known) if before is not None and node in kinds:
                logical = before.configuration.structure.logical
                parent = logical.parent(node)
                nested = () if parent is None else (parent,)
                names = nested if slot == "parent" else logical.links(node)
                if names != known:
                    yield Believed(node, slot, names, now)
            case Broke(assumption) if assumption and before is None:
                yield Broke("", now)


def parting_json(parting: Parting) -> dict[str, Any]:
    """Return the station's part of a mission as plain data."""
    counts = {"sent": dict(parting.sent), "took": dict(parting.took)}
    return {"here": parting.here, "hosts": dict(parting.hosts), **counts}
