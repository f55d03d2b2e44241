"""Vehicle and feed plugins from the command line's options."""

from __future__ import annotations

import re
from argparse import Namespace
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from adapters.addresses import SCHEMES
from adapters.assigned import Assigned
from adapters.live.command_planning import is_authority
from adapters.mavlink.keys import Keeper
from adapters.mavlink.mavlink_plugin import Autopilot, Listener, Tap
from adapters.mavlink.signing import Signing
from adapters.mavlink.vehicle_identities import Craft, Stations
from adapters.naming import NamingService
from adapters.plugin import Plugin, preflights
from adapters.ros import RosVehicles
from adapters.simulated import Kind, Vehicle
from adapters.simulated.missing_sensor import MissingSensor
from adapters.simulated.simulated_link import ADDRESS, SimulatedLink
from bigactors.arguments.values import LIVING
from bigactors.commands.run.feeds import cameras_of, feeds_of, poses_for
from bigactors.commands.run.geofence import fence_of
from bigactors.commands.run.station_flight import driven, own_station
from bigactors.installed_plugins import VEHICLES, make_vehicles, require_known
from bigactors.mistakes import Mistake, near_or_known
from physical import PhysicalError, PhysicalProperty
from semantics.state.physical_model import Placed
from semantics.state.signature import REGION
from specs.elaboration import ElaboratedMission

MOST_STATIONS = 254
ROS = "ros"
SIMULATED = "simulated"
GROUND = 20.0
"""The metres above the sea of a simulated vehicle's home; a boat's is at the sea."""


def plugins_of(
    options: Namespace, mission: ElaboratedMission, tap: Tap | None = None
) -> tuple[tuple[Plugin, ...], dict[str, str]]:
    """Return the plugins of a run, and the plugin that owns each vehicle; `tap` receives all frames; raises Mistake."""
    check_speed(options)
    try:
        crafts = _crafts(options, mission)
        poses = poses_for(options.camera, crafts)
        vehicles = _vehicles(options, mission, crafts, tap, {name: log.hear for name, log in poses.items()})
        own = _own_names(options, mission, crafts)
        naming = NamingService(dict(options.name), own, mission.setting.kinds)
        living = (LIVING | dict(options.time_to_live))["detections"]
        cameras = cameras_of(options, mission, poses, naming, living)
        feeds = (*feeds_of(options, mission, naming), *cameras, *_sensor(options, mission))
    except PhysicalError as error:
        raise Mistake(error.message, error.hint, error.where) from error
    owners = {name: plugin.name for plugin in vehicles for name in crafts if plugin.owns(name)}
    return (*vehicles, *feeds), owners


def fences_of(plugins: Iterable[Plugin]) -> dict[str, Any]:
    """Return the ring of each vehicle's fence."""
    return {name: fence.ring for link in preflights(plugins) for name, fence in link.fences.items()}


def _vehicles(
    options: Namespace,
    mission: ElaboratedMission,
    crafts: dict[str, Craft],
    tap: Tap | None,
    listeners: Mapping[str, Listener],
) -> tuple[Plugin, ...]:
    links: dict[str, list[Craft]] = {}
    for name, _, address in options.vehicle:
        links.setdefault(address, []).append(crafts[name])
    _check_all_driven(options, mission)
    stations = _stations(options, mission)
    keeper = None if options.key is None else Keeper(Path(options.key))

    def connected(address: str, crafts: list[Craft]) -> Plugin:
        scheme, colon, rest = address.partition(":")
        if not colon or scheme in SCHEMES:
            return Autopilot(f"autopilot {address}", address, crafts, stations, keeper, tap, listeners)
        if scheme == SIMULATED:
            own = [replace(craft, system=craft.system or 1 + at) for at, craft in enumerate(crafts)]
            link = Autopilot(f"autopilot {address}", ADDRESS, own, stations, keeper, tap, listeners)
            key = None if keeper is None else Signing(keeper.key)
            return SimulatedLink(link, [_simulated(craft, rest, mission, key) for craft in own])
        ours = (*SCHEMES, ROS, SIMULATED)
        require_known(scheme, VEHICLES, ours, f"'{scheme:.40}' is no way to connect a vehicle")
        assigned = tuple(_assigned(craft, mission) for craft in crafts)
        if scheme == ROS:
            return RosVehicles(f"robots {rest.partition('?')[0]}", rest, assigned)
        return make_vehicles(scheme, address, rest, assigned)

    return tuple(connected(address, crafts) for address, crafts in links.items())


def _simulated(craft: Craft, word: str, mission: ElaboratedMission, key: Signing | None) -> Vehicle:
    """Return a simulated vehicle of a kind, at home where the mission begins."""
    kinds = {kind.name.lower().replace("_", "-"): kind for kind in Kind}
    if word not in kinds:
        raise Mistake(f"'{word:.40}' is no kind of simulated vehicle", f"there are {', '.join(kinds)}")
    at = mission.initial.structure.physical.position(craft.entity)
    if at is None:
        hint = f"place it in the world: {craft.entity}: {craft.kind} = point (37.0, -8.6)"
        raise Mistake(f"'{craft.entity}' stands at no point in the mission, so it has no home", hint)
    latitude, longitude = at.geometry.vertices[0]
    kind = kinds[word]
    ground = 0.0 if kind is Kind.BOAT else GROUND
    return Vehicle(kind, (latitude, longitude, ground), craft.system or 1, signing=key)


def _sensor(options: Namespace, mission: ElaboratedMission) -> tuple[Plugin, ...]:
    """Return the simulated sensor that misses what the mission lets an observation miss; raises Mistake."""
    if options.misses is None:
        return ()
    physical, kinds = mission.initial.structure.physical, mission.setting.kinds
    vehicles = {name for name, _, _ in options.vehicle}
    placed = [(name, physical.placement(name)) for name in mission.setting.missable if name not in vehicles]
    there = [
        PhysicalProperty(name, kinds[name], at.geometry, at.altitude, physical.channels(name))
        for name, at in placed
        if isinstance(at, Placed)
    ]
    if not there:
        hint = "write environment { observe may miss OilSpill }, or leave --misses out"
        raise Mistake("the mission lets no observation miss anything", hint, "--misses")
    return (MissingSensor(there, *options.misses),)


def check_speed(options: Namespace) -> None:
    """Refuse another clock than that on the wall for vehicles that may be real; raises Mistake."""
    real = [name for name, _, address in options.vehicle if address.partition(":")[0] != SIMULATED]
    if options.speed != 1.0 and real:
        hint = f"simulate it in the run (--vehicle {real[0]}=simulated:plane), or leave --speed out"
        raise Mistake(f"{real[0]} may be a real vehicle, whose clock is that on the wall", hint, "--speed")


def _assigned(craft: Craft, mission: ElaboratedMission) -> Assigned:
    """Return the assignment of a vehicle to a plugin other than MAVLink's; raises Mistake if it has a MAVLink id."""
    if craft.system is not None or craft.serial is not None:
        hint = "leave the id out: only vehicles that speak MAVLink have one"
        raise Mistake(
            f"'{craft.entity}' has an id of MAVLink, and an address that is none of MAVLink's", hint
        )
    channels = mission.initial.structure.physical.channels(craft.entity)
    return Assigned(craft.entity, craft.kind, tuple(channels), craft.fence, craft.time_to_live)


def _crafts(options: Namespace, mission: ElaboratedMission) -> dict[str, Craft]:
    """Return the given vehicles, with the ids of --vehicle or --name."""
    found: dict[str, Craft] = {}
    for name, system, _ in options.vehicle:
        if name in found:
            raise Mistake(f"'{name}' is given twice", "give each vehicle one --vehicle")
        found[name] = _craft(name, system, mission)
    fence = fence_of(options.fence, mission)
    living = (LIVING | dict(options.time_to_live))["vehicles"]
    for name, craft in found.items():
        serial, system = _told(options, "serial", name), _told(options, "mavlink", name)
        found[name] = replace(
            craft,
            system=_system(name, craft.system, system),
            serial=serial,
            fence=fence,
            time_to_live=living,
            streams=("ATTITUDE",) if any(each.vehicle == name for each in options.camera) else (),
        )
    return found


def _craft(name: str, system: int | None, mission: ElaboratedMission) -> Craft:
    kind = mission.setting.kinds.get(name)
    if kind is None:
        hint = near_or_known(name, mission.setting.driven(), "vehicles")
        raise Mistake(f"the mission has no entity '{name:.60}'", hint)
    if not mission.setting.signature[kind].driven:
        raise Mistake(
            f"'{name}' is no vehicle: nothing drives its kind {kind}", f"declare it: kind {kind} driven"
        )
    channels = mission.initial.structure.physical.channels(name)
    return Craft(name, kind, system, tuple(each for each in channels if not is_authority(each)))


def _told(options: Namespace, scheme: str, name: str) -> str | None:
    """Return the number in the mission's name table for a name and a scheme."""
    found = (identity.partition(":") for identity, called in options.name if called == name)
    return next((number for of, _, number in found if of == scheme), None)


def _system(name: str, given: int | None, told: str | None) -> int | None:
    """Return the system id of a vehicle, by --vehicle or by --name."""
    if told is None:
        return given
    if not re.fullmatch(r"[0-9]{1,3}", told) or not 0 < int(told) < 256:
        raise Mistake(f"'mavlink:{told:.20}' is no system id", "they are from 1 to 255")
    if given not in (None, int(told)):
        raise Mistake(f"'{name}' has two system ids: {given} and {told}", "give it one")
    return int(told)


def _own_names(options: Namespace, mission: ElaboratedMission, crafts: dict[str, Craft]) -> dict[str, str]:
    """Return the reserved names: of the vehicles, the stations, and the places that never move.

    The names of bigActors, kinds and channels, and `region`, are reserved too.

    A place of a detectable kind isn't reserved: its detection elsewhere breaks an assumption.
    """
    detected = dict(options.kinds).get("detections", frozenset())
    own = {
        f"place:{name}": name
        for name in sorted(mission.fixed - crafts.keys())
        if _has_border(name, mission) and mission.setting.kinds[name] not in detected
    }
    own |= {f"{sort}:{name}": name for sort, name in mission.spans if sort in ("agent", "kind", "channel")}
    own["place:region"] = REGION
    told = {called for _, called in options.name}  # a station may carry a transponder
    own |= {f"station:{name}": name for name in sorted(_stations_of(mission) - crafts.keys() - told)}
    for name, craft in crafts.items():
        known = f"serial:{craft.serial}" if craft.serial else f"mavlink:{craft.system}"
        anonymous = craft.serial is None and craft.system is None
        own[f"vehicle:{name}" if anonymous or known in own else known] = (
            name  # ids are unique on one link only
        )
    return own


def _stations_of(mission: ElaboratedMission) -> set[str]:
    """Return our ground stations: the entities with control authority, and the hosts of bigActors."""
    alpha, kinds = mission.initial.alpha, mission.setting.kinds
    hosts = {alpha.host(agent) for agent in alpha.names()}
    channels = {each for name in kinds for each in mission.initial.structure.physical.channels(name)}
    named = {channel.partition(":")[2] for channel in channels if is_authority(channel)}
    return (hosts | named) & mission.fixed


def _has_border(name: str, mission: ElaboratedMission) -> bool:
    at = mission.initial.structure.physical.placement(name)
    return isinstance(at, Placed) and not at.geometry.is_point


def _check_all_driven(options: Namespace, mission: ElaboratedMission) -> None:
    """Refuse to fly a mission while one of its vehicles is missing: its flights would never be observed to end.

    With several stations, each has its own vehicles.
    """
    missing = sorted(driven(mission) - {name for name, _, _ in options.vehicle})
    if missing and own_station(options) is None:
        hint = (
            f"give its address: --vehicle {missing[0]}=udp:127.0.0.1:14550, or for a rehearsal "
            f"{missing[0]}=simulated:plane; traffic that nobody here commands is of a kind that is not driven, "
            "such as Tanker of the standard signature"
        )
        raise Mistake(f"vehicles of the mission have no address: {', '.join(missing)}", hint)


def _stations(options: Namespace, mission: ElaboratedMission) -> Stations:
    """Return the stations named by the mission's channels of control authority, with their MAVLink ids."""
    physical = mission.initial.structure.physical
    channels = {
        each for name in mission.setting.kinds for each in physical.channels(name) if is_authority(each)
    }
    names = sorted(channel.partition(":")[2] for channel in channels)
    given = {name: number for name, number in options.station if number is not None}
    free = (number for number in range(255, 0, -1) if number not in given.values())
    ids = {name: given[name] if name in given else next(free) for name in names[:MOST_STATIONS]}
    unknown = sorted(set(given) - set(ids))
    if unknown:
        raise Mistake(
            f"no channel 'control:{unknown[0]:.40}' is in the mission",
            near_or_known(unknown[0], ids, "stations"),
        )
    if not ids:
        return Stations({"this run": 255}, ("this run",), in_mission=False)
    own = own_station(options)
    return Stations(ids, (own,) if own in ids else tuple(ids))
