"""From what the command line says of vehicles and feeds to the plugins that serve them."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Callable
from pathlib import Path

from adapters.addresses import parse_address
from adapters.ais import AisFeed
from adapters.detections import Detections
from adapters.location import LocationService
from adapters.mavlink.autopilot import Autopilot, Tap
from adapters.mavlink.fleet import Craft, Stations
from adapters.naming import NamingService
from adapters.places import StaticPlaces
from adapters.plugin import Plugin
from adapters.web import Listen
from bigactors.mistakes import Mistake, suggestion
from bigactors.stations import driven, own_station
from physical import PhysicalError
from semantics.reactions import CONTROL_AUTHORITY
from specs.elaboration import ElaboratedMission

MOST_STATIONS = 254


def plugins_of(
    options: Namespace, mission: ElaboratedMission, tap: Tap | None = None
) -> tuple[tuple[Plugin, ...], dict[str, str]]:
    """Return the plugins of a run, and which of them owns each vehicle; `tap` is told every frame; raises Mistake."""
    try:
        vehicles = _vehicles(options, mission, tap)
        naming = NamingService(dict(options.name))
        feeds = tuple(_feed(kind, address, n, naming) for n, (kind, address) in enumerate(options.feed, 1))
    except PhysicalError as error:
        raise Mistake(error.message, error.hint) from error
    owners = {name: plugin.name for plugin in vehicles for name, _, _ in options.vehicle if plugin.owns(name)}
    return (*vehicles, *feeds), owners


def _vehicles(options: Namespace, mission: ElaboratedMission, tap: Tap | None) -> tuple[Plugin, ...]:
    links: dict[str, list[Craft]] = {}
    for name, system, address in options.vehicle:
        links.setdefault(address, []).append(_craft(name, system, mission))
    _check_all_driven(options, mission)
    stations = _stations(options, mission)
    return tuple(
        Autopilot(f"autopilot {address}", address, crafts, stations, tap=tap)
        for address, crafts in links.items()
    )


def _craft(name: str, system: int | None, mission: ElaboratedMission) -> Craft:
    kind = mission.setting.kinds.get(name)
    if kind is None:
        hint = (
            suggestion(name, mission.setting.kinds) or "give the vehicle the name that it has in the mission"
        )
        raise Mistake(f"the mission has no entity '{name:.60}'", hint)
    if not mission.setting.signature[kind].driven:
        raise Mistake(
            f"'{name}' is no vehicle: nothing drives its kind {kind}", f"declare it: kind {kind} driven"
        )
    channels = mission.initial.structure.physical.channels(name)
    return Craft(name, kind, system, tuple(each for each in channels if not _is_authority(each)))


def _check_all_driven(options: Namespace, mission: ElaboratedMission) -> None:
    """Refuse to fly a mission while a vehicle of it is nowhere: what is sent there would never be seen to arrive.

    Of several stations each has its own vehicles.
    """
    missing = sorted(driven(mission) - {name for name, _, _ in options.vehicle})
    if missing and own_station(options) is None:
        hint = f"say where it is: --vehicle {missing[0]}=udp:127.0.0.1:14550"
        raise Mistake(f"the mission has vehicles that are not given: {', '.join(missing)}", hint)


def _stations(options: Namespace, mission: ElaboratedMission) -> Stations:
    """Return the stations that the mission's channels of authority name, with their MAVLink ids."""
    physical = mission.initial.structure.physical
    channels = {
        each for name in mission.setting.kinds for each in physical.channels(name) if _is_authority(each)
    }
    names = sorted(channel.partition(":")[2] for channel in channels)
    given = {name: number for name, number in options.station if number is not None}
    free = (number for number in range(255, 0, -1) if number not in given.values())
    ids = {name: given[name] if name in given else next(free) for name in names[:MOST_STATIONS]}
    unknown = sorted(set(given) - set(ids))
    if unknown:
        raise Mistake(
            f"no channel 'control:{unknown[0]:.40}' is in the mission",
            suggestion(unknown[0], ids) or "see its channels",
        )
    own = own_station(options)
    return Stations(ids, (own,) if own in ids else tuple(ids)) if ids else Stations()


def _is_authority(channel: str) -> bool:
    return channel.partition(":")[0] == CONTROL_AUTHORITY


def _ais(name: str, address: str, naming: NamingService) -> Plugin:
    return AisFeed(name, address, naming)


def _places(name: str, address: str, _naming: NamingService) -> Plugin:
    return StaticPlaces(name, Path(address.removeprefix("file:")))


def _detections(name: str, address: str, naming: NamingService) -> Plugin:
    scheme, _, rest = address.partition(":")
    if scheme == "folder" and rest:
        return Detections(name, folder=Path(rest), naming=naming)
    listen = parse_address(address.replace("http:", "tcpin:", 1))
    return Detections(name, listen=Listen(listen.port, listen.host), naming=naming)


def _locations(name: str, address: str, naming: NamingService) -> Plugin:
    return LocationService(name, address, naming=naming)


FEEDS: dict[str, Callable[[str, str, NamingService], Plugin]] = {
    "ais": _ais,
    "detections": _detections,
    "locations": _locations,
    "places": _places,
}
"""For each kind of feed what makes its plugin from a name, an address and the names of the mission."""


def _feed(kind: str, address: str, number: int, naming: NamingService) -> Plugin:
    make = FEEDS.get(kind)
    if make is None:
        hint = suggestion(kind, FEEDS) or f"the feeds are {', '.join(FEEDS) or 'none in this version'}"
        raise Mistake(f"there is no feed '{kind:.40}'", hint)
    return make(f"{kind}{number}", address, naming)
