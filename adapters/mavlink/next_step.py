"""The next action towards a command: a pure function of the vehicle's state.

The memory holds little beyond the items on board. So lost packets, duplicate answers and reboots need no special cases:
the next action is the first whose effect the state does not show.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from adapters.mavlink import command as to
from adapters.mavlink.acceptance_radius import acceptance
from adapters.mavlink.constants import AUTHORITY_PARAMETERS, Cmd, Fence, MavFrame, MissionType
from adapters.mavlink.item_merging import (
    OnBoard,
    Unconfirmed,
    before_upload,
    is_on_board,
    may_be_landing,
    merged,
)
from adapters.mavlink.items import Items, e7, fence, route
from adapters.mavlink.loiter_circle import goal, stay
from adapters.mavlink.message import MavlinkMessage
from adapters.mavlink.profiles import Profile, TakeOff
from adapters.mavlink.refuges import ARMING_ITEMS, refuges
from adapters.mavlink.telemetry import Telemetry, VehiclePosition
from adapters.plugin import Command, Follow, GiveBack, GoTo, HandOver, Hold, Rebind, Return
from physical import Band, Geometry, contains, distance, point, waypoint

TARGET_METRES = 5.0
"""Metres by which the vehicle's reported target may differ from the commanded one, along and in height."""

CLIMBING = 0.2
"""Metres a second."""


@dataclass(frozen=True, slots=True)
class Wait:
    """Nothing to do: the vehicle must reach the next state by itself. `limited`: within a short time."""

    why: str
    limited: bool = True


@dataclass(frozen=True, slots=True)
class Tell:
    """A message, repeated until the state shows its effect."""

    why: str
    message: MavlinkMessage


@dataclass(frozen=True, slots=True)
class Load:
    """A mission or fence that must be on board.

    `before` are the items on board before any upload of ours, a part of which is kept.
    """

    items: Items
    kind: MissionType
    before: Items = field(default=(), compare=False)

    @property
    def what(self) -> str:
        """Its name for people."""
        return self.kind.name.lower()


@dataclass(frozen=True, slots=True)
class FollowsCommand:
    """The state shows that the vehicle follows its command.

    Attributes:
        done: Whether it has completed the command.
        waypoint: The point around which it will stay, if it is going anywhere.
    """

    done: bool
    waypoint: Geometry | None = field(default=None, compare=False)


Step = Wait | Tell | Load | FollowsCommand


@dataclass(frozen=True, slots=True)
class StepInput:
    """The input of `next_step`.

    Attributes:
        system: Its MAVLink system id.
        known: Its state according to its messages.
        profile: The profile of its kind.
        on_board: The missions, fences and rally points that were read back and have not changed since.
        uploads: The uploads that were begun and are not confirmed.
        fence: The polygon that it must stay in.
        circle: The radius in metres at which it circles where it stays.
        room: The radius in metres that contains its circles, in wind too.
        height: Metres above the mission's home at which the command is carried out.
        above: Metres above sea level of that home, if commanded heights are above sea level; None for above home.
        begun: Whether its mission was seen to begin since the command.
        resumes: Whether the mission continues with the current item.
        passed: The number of places of its path in which it was seen.
        furthest: The highest mission item at which it was seen.
        home_circle: The radius in metres at which it circles its home when it returns.
        speaker: The system id of messages to it, that of its authority.
        deaf: A likely reason why it does not answer us, or an empty text.
        lacks: The reason why it has no position, or an empty text.
    """

    system: int
    known: Telemetry
    profile: Profile
    on_board: OnBoard
    fence: Geometry | None
    circle: float
    height: float
    begun: bool
    uploads: Mapping[MissionType, Unconfirmed] = field(default_factory=dict)
    resumes: bool = False
    above: float | None = None
    passed: int = 0
    furthest: int = 0
    home_circle: float = 0.0
    room: float = 0.0
    speaker: int = 0
    deaf: str = ""
    lacks: str = ""


def next_step(command: Command, station: int, vehicle: StepInput) -> Step:
    """Return the first missing step; `station` is the system id that a HandOver gives authority to."""
    match command:
        case GoTo():
            return _prepared(vehicle, _takeoff_items(command, vehicle)) or _go(command, vehicle)
        case Follow():
            return _prepared(vehicle, _path_items(command, vehicle)) or _follow(command, vehicle)
        case HandOver():
            return _hand_over(station, vehicle)
        case Hold():
            return _in_mode(vehicle, vehicle.profile.hold) or _stopped(vehicle) or FollowsCommand(done=True)
        case Return():
            lands = may_be_landing(vehicle.known, vehicle.on_board)
            return (None if lands else _in_mode(vehicle, vehicle.profile.home)) or FollowsCommand(
                done=_is_home(vehicle)
            )
        case GiveBack() | Rebind():
            raise AssertionError("it is done at once")


def _prepared(vehicle: StepInput, mission: Items | None = None) -> Step | None:
    """Return the first missing precondition: a position, acceptance of missions, the fence, readiness to arm.

    A vehicle that is ready only with certain items on board gets its `mission` first.
    """
    if vehicle.known.position is None:
        return Wait(vehicle.lacks or "it has no position yet")
    dialect = vehicle.profile.dialect
    if dialect.above_sea and vehicle.known.ground is None:
        return Wait("it has no home yet")
    if not vehicle.known.armed and vehicle.known.healthy is not True:
        asks = bool(vehicle.known.parameters.get(ARMING_ITEMS)) and mission is not None
        return (_loaded(vehicle, mission or (), MissionType.MISSION) if asks else None) or _ready(vehicle)
    if vehicle.fence is None:
        return None
    load = _loaded(vehicle, fence(vehicle.fence), MissionType.FENCE)
    if load is None and not dialect.fence_action and not (vehicle.known.fenced and vehicle.known.polygon):
        # Without the polygon's bit all its fences come on, such as a circle of 300 m around home.
        command = to.long(Cmd.FENCE_ENABLE, vehicle.system, 1, Fence.POLYGON)
        return Tell("to keep within its fence", command)
    return load


def _ready(vehicle: StepInput) -> Step:
    """Wait until it could be armed; if that depends on its mode, first enter a mode from which it may take off."""
    unfit = vehicle.profile.climb is not None and vehicle.known.mode != vehicle.profile.climb
    return (_in_mode(vehicle, vehicle.profile.hold) if unfit else None) or Wait(
        "it is not ready to be armed yet"
    )


def _loaded(vehicle: StepInput, ours: Items, kind: MissionType) -> Step | None:
    """Read the items on board; then upload ours, with those that are kept."""
    found = vehicle.on_board.get(kind)
    if found is None:
        return Wait(f"its {kind.name.lower()} is not read yet")
    before = before_upload(found, vehicle.uploads.get(kind))
    wanted = merged(ours, before, kind, vehicle.known)
    return None if is_on_board(wanted, found, kind) else Load(wanted, kind, before)


def _go(command: GoTo, vehicle: StepInput) -> Step:
    at = _stay(command, vehicle)
    return (
        _off_the_ground(vehicle, at)
        or _sent(vehicle, at)
        or FollowsCommand(done=_reached(command.place, at, vehicle), waypoint=at)
    )


def _stay(command: GoTo | Follow, vehicle: StepInput) -> Geometry:
    """Return the point around which it will stay; commands without room for its circle were refused."""
    return stay(command, vehicle.room) or waypoint(goal(command))


def _off_the_ground(vehicle: StepInput, at: Geometry) -> Step | None:
    """Get the vehicle moving: a plane by a mission that begins with a take-off, the others in guided mode."""
    if vehicle.profile.takeoff is TakeOff.MISSION:
        return _mission_takeoff(vehicle, at)
    if vehicle.profile.climb is not None:
        return _mode_takeoff(vehicle, vehicle.profile.climb)
    ready = None if vehicle.known.flying else _in_mode(vehicle, vehicle.profile.guided) or _armed(vehicle)
    if ready or vehicle.profile.takeoff is TakeOff.NONE:
        return ready
    return _copter_takeoff(vehicle)


def _copter_takeoff(vehicle: StepInput) -> Step | None:
    if not vehicle.known.flying:
        return _told_to_take_off(vehicle)
    position = _position(vehicle)
    datum = vehicle.known.datum
    height = position.height if datum is None else position.altitude - datum
    low = height < 0.8 * vehicle.profile.rise
    return Wait("it climbs") if low and position.climb > CLIMBING else None


def _mode_takeoff(vehicle: StepInput, mode: int) -> Step | None:
    """Take off in a mode for that, which the vehicle leaves by itself once it is high enough."""
    known = vehicle.known
    if known.flying:
        return Wait("it climbs") if known.mode == mode else None
    return (_told_to_take_off(vehicle) if known.mode != mode else _armed(vehicle)) or Wait("it takes off")


def _told_to_take_off(vehicle: StepInput) -> Step:
    return Tell("to take off", to.take_off(vehicle.system, _height(vehicle, vehicle.profile.rise)))


def _height(vehicle: StepInput, height: float) -> tuple[float, MavFrame]:
    """Return a height above home in the vehicle's frame, for a take-off."""
    if not vehicle.profile.dialect.above_sea:
        return height, MavFrame.HOME
    assert vehicle.known.ground is not None, "plans begin with a home"
    return round(height + vehicle.known.ground, 1), MavFrame.SEA_LEVEL


def _travel_height(vehicle: StepInput) -> tuple[float, MavFrame]:
    """Return the height of the command in the vehicle's frame, for travel."""
    if vehicle.above is None:
        return _height(vehicle, vehicle.height)
    return round(vehicle.height + vehicle.above, 1), MavFrame.SEA_LEVEL


def _takeoff_items(command: GoTo, vehicle: StepInput) -> Items | None:
    """Return the mission by which a vehicle takes off, if it uses one."""
    if vehicle.profile.takeoff is not TakeOff.MISSION or vehicle.known.flying:
        return None
    return route((_stay(command, vehicle),), vehicle.height, takeoff=True, above=vehicle.above)


def _mission_takeoff(vehicle: StepInput, at: Geometry) -> Step | None:
    known, auto = vehicle.known, vehicle.profile.auto
    if known.flying:
        climbing = known.mode == auto and (known.current or 0) <= 1 and _may_take_off(vehicle)
        return Wait("it climbs") if climbing else None
    return (
        _loaded(vehicle, route((at,), vehicle.height, takeoff=True, above=vehicle.above), MissionType.MISSION)
        or _begun(vehicle, 1)
        or _in_mode(vehicle, auto)
        or _armed(vehicle)
        or Wait("it takes off")
    )


def _may_take_off(vehicle: StepInput) -> bool:
    items = vehicle.on_board.get(MissionType.MISSION)
    return items is None or (len(items) > 1 and items[1].command == Cmd.TAKEOFF)


def _sent(vehicle: StepInput, at: Geometry) -> Step | None:
    """Bring it to guided mode with the commanded target.

    A vehicle in guided mode is not asked to enter it: it may leave that mode at this moment for its safety.
    """
    known, (x, y) = vehicle.known, e7(at)
    enters = known.mode != vehicle.profile.guided
    why = "to go there"
    if not enters and _targets(known, at):
        if not _aims_elsewhere(vehicle):
            return None
        why = f"to go there at another height: its target is {known.aim:.0f} m above sea level"
    enters = enters or vehicle.profile.dialect.enters
    height = _travel_height(vehicle)
    return Tell(why, to.reposition(vehicle.system, x, y, height, vehicle.circle, enters=enters))


def _aims_elsewhere(vehicle: StepInput) -> bool:
    """Return whether its target is at another height than the command's, as far as both are known."""
    known = vehicle.known
    if known.aim is None or known.datum is None or vehicle.profile.takeoff is TakeOff.NONE:
        return False
    return abs(known.aim - vehicle.height - known.datum) > TARGET_METRES


def _stopped(vehicle: StepInput) -> Step | None:
    """Make it stay here, if the mode in which it holds is also the mode in which it goes to a target."""
    known, profile = vehicle.known, vehicle.profile
    if profile.hold != profile.guided or known.target is None or known.position is None:
        return None
    away = distance(point(*known.target), _spot(vehicle))
    near = away <= profile.drift * vehicle.circle + profile.reach
    return None if near else Tell("to stay where it is", to.stop(vehicle.system))


def _targets(known: Telemetry, at: Geometry) -> bool:
    return known.target is not None and distance(point(*known.target), at) <= TARGET_METRES


def _path_items(command: Follow, vehicle: StepInput) -> Items:
    profile, path = vehicle.profile, (*map(waypoint, command.path[:-1]), _stay(command, vehicle))
    usual = vehicle.known.parameters.get("WP_RADIUS", 0.0)
    return route(
        path,
        vehicle.height,
        takeoff=_by_item(profile),
        home=profile.dialect.home_is_item,
        above=vehicle.above,
        near=tuple(acceptance(place, usual) for place in command.path[:-1]),
    )


def _by_item(profile: Profile) -> bool:
    """Return whether the missions of a kind of vehicle begin with a take-off."""
    return profile.takeoff in (TakeOff.MISSION, TakeOff.COMMAND)


def _lead(profile: Profile) -> int:
    """Return the number of the item that is the first place of a path."""
    return profile.dialect.home_is_item + _by_item(profile)


def _follow(command: Follow, vehicle: StepInput) -> Step:
    profile, last, items = vehicle.profile, _stay(command, vehicle), _path_items(command, vehicle)
    # A flying vehicle need not take off again: it begins with the point after the take-off.
    first = _lead(profile) - (_by_item(profile) and not vehicle.known.flying)
    if vehicle.resumes:
        first = vehicle.known.current or first
    rises = profile.takeoff not in (TakeOff.MISSION, TakeOff.NONE)
    return (
        _loaded(vehicle, items, MissionType.MISSION)
        or (_off_the_ground(vehicle, waypoint(command.path[0])) if rises else None)
        or _begun(vehicle, first)
        or _in_mode(vehicle, profile.auto)
        or _armed(vehicle)
        or _in_turn(vehicle)
        or FollowsCommand(done=_at_the_end(command, last, items, vehicle), waypoint=last)
    )


def _begun(vehicle: StepInput, first: int) -> Step | None:
    """Make a mission begin at its start, not at the item of an earlier one."""
    by_command = vehicle.profile.dialect.begins_by_command
    if vehicle.begun or (vehicle.resumes and not by_command):  # it keeps its item when a mission changes
        return None
    return Tell("to begin its mission", to.begin_with(vehicle.system, first, by_command=by_command))


def _in_turn(vehicle: StepInput) -> Step | None:
    """Make it visit every place of the path: an item's number is no proof that the vehicle was there."""
    current, next_place = vehicle.known.current or 0, _lead(vehicle.profile) + vehicle.passed
    due = min(next_place, current) if current >= vehicle.furthest else vehicle.furthest
    if current == due:
        return None
    by_command = vehicle.profile.dialect.begins_by_command
    why = f"to fly to item {due} of its mission, not to item {current}"
    return Tell(why, to.begin_with(vehicle.system, due, by_command=by_command))


def _at_the_end(command: Follow, at: Geometry, items: Items, vehicle: StepInput) -> bool:
    passed_all = vehicle.passed >= len(command.path) - 1
    return passed_all and vehicle.known.current == len(items) - 1 and _reached(command.path[-1], at, vehicle)


def _hand_over(station: int, vehicle: StepInput) -> Step:
    if vehicle.known.authority == station:
        return FollowsCommand(done=True)
    name = vehicle.known.authority_parameter or AUTHORITY_PARAMETERS[0]
    return Tell("to obey the other station", to.set_parameter(vehicle.system, name, station))


def _in_mode(vehicle: StepInput, mode: int) -> Step | None:
    if vehicle.known.mode == mode:
        return None
    why = f"to change to {vehicle.profile.mode_name(mode)}"
    numbers = vehicle.profile.dialect.mode_parameters(mode)
    return Tell(why, to.long(Cmd.DO_SET_MODE, vehicle.system, 1, *numbers))


def _armed(vehicle: StepInput) -> Step | None:
    return None if vehicle.known.armed else Tell("to arm", to.long(Cmd.ARM_DISARM, vehicle.system, 1))


def _is_home(vehicle: StepInput) -> bool:
    if vehicle.known.armed is False:
        return True
    reach = vehicle.home_circle + vehicle.profile.reach
    return any(
        distance(_spot(vehicle), refuge) <= reach for refuge in refuges(vehicle.known, vehicle.on_board)
    )


def passing(command: Follow, vehicle: StepInput) -> int:
    """Return how many places of its path a vehicle has passed, in order, including its present position."""
    passed = vehicle.passed
    while passed < len(command.path) - 1:
        place = command.path[passed]
        if not _reached(place, waypoint(place), vehicle):
            return passed
        passed += 1
    return passed


def _reached(place: Geometry, at: Geometry, vehicle: StepInput) -> bool:
    spot = _spot(vehicle)
    if place.is_point:
        return distance(spot, at) <= max(vehicle.profile.reach, 1.2 * vehicle.circle)
    return contains(place, spot)


def height_of(
    band: Band | None, profile: Profile, known: Telemetry, position: VehiclePosition, otherwise: float
) -> float:
    """Return the height above the mission's home of the middle of a band; without one, `otherwise`."""
    if band is None or profile.takeoff is TakeOff.NONE:
        return otherwise
    home = position.altitude - position.height if known.datum is None else known.datum
    return round((band.low + band.high) / 2 - home, 2)


def _position(vehicle: StepInput) -> VehiclePosition:
    assert vehicle.known.position is not None, "plans begin with a position"
    return vehicle.known.position


def _spot(vehicle: StepInput) -> Geometry:
    position = _position(vehicle)
    return point(position.latitude, position.longitude)
