"""The answers of a simulated vehicle: commands, parameters, missions, signing; and its controlling station."""

from __future__ import annotations

import math
import struct
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Final

from adapters.mavlink.command import ANYWHERE
from adapters.mavlink.constants import AUTOPILOT_VERSION, INTEGERS, STREAMS, Cmd, Fence, Result
from adapters.mavlink.message import MavlinkMessage, is_for, say
from adapters.mavlink.profiles import TakeOff, mode_number
from adapters.mavlink.signing import EPOCH, UNITS, Signing, Verdict, check
from adapters.simulated.body import Target, metres_to
from adapters.simulated.mission_flight import missing
from adapters.simulated.reporting import Reporter, parameter_value
from adapters.simulated.simulated_vehicle import Vehicle

Answer = list[MavlinkMessage]

_NAMES: Final[Mapping[float, str]] = MappingProxyType(
    {**{number: name for name, (number, _) in STREAMS.items()}, AUTOPILOT_VERSION: "AUTOPILOT_VERSION"}
)

FARTHEST: Final = 50_000.0
"""Metres from home beyond which it rejects a target."""

CHANGE_MODE: Final = 1
"""MAV_DO_REPOSITION_FLAGS: into guided mode from any other."""

FLAGS: Final = 0xFFFF
"""The largest accepted set of flags; NaN is rejected, too."""

HIGHEST: Final = 10_000.0
LARGEST: Final = 1e6
LONGEST: Final = 3.6e9
"""The longest interval of a message, in microseconds."""


def hear(vehicle: Vehicle, reporter: Reporter, message: MavlinkMessage, now: float) -> Answer:
    """Answer a message, if it is authentic, addressed to this vehicle, and from the station that it obeys."""
    if not _believed(vehicle, message) or not is_for(message, vehicle.system):
        return []
    enforces = vehicle.enforce and vehicle.kind.profile.dialect.authority
    if enforces and message.system != round(vehicle.parameters[vehicle.authority_parameter]):
        return []
    if message.name == "MISSION_SET_CURRENT":
        _make_current(vehicle, message["seq"])
        return []
    if message.name.startswith("MISSION_"):
        return vehicle.store.hear(message, ready=vehicle.up, now=now)
    answer = _ANSWERS.get(message.name)
    return [] if answer is None else answer(vehicle, reporter, message)


def _believed(vehicle: Vehicle, message: MavlinkMessage) -> bool:
    if vehicle.signing is None:
        return True
    vehicle.signing, verdict = check(vehicle.signing, message)
    return verdict is Verdict.GOOD or (verdict is Verdict.UNSIGNED and vehicle.accept_unsigned)


# --- messages ---------------------------------------------------------------------------------------


def _setup_signing(vehicle: Vehicle, _reporter: Reporter, message: MavlinkMessage) -> Answer:
    vehicle.signing = Signing(bytes(message["secret_key"]), message["initial_timestamp"])
    return []


def _read_parameter(vehicle: Vehicle, _reporter: Reporter, message: MavlinkMessage) -> Answer:
    return (
        [parameter_value(vehicle, message["param_id"])] if message["param_id"] in vehicle.parameters else []
    )


def _set_parameter(vehicle: Vehicle, _reporter: Reporter, message: MavlinkMessage) -> Answer:
    name, value = message["param_id"], message["param_value"]
    if vehicle.kind.profile.dialect.typed and message["param_type"] in INTEGERS:
        value = float(int.from_bytes(struct.pack("<f", value), "little", signed=True))
    if name not in vehicle.parameters or not abs(value) <= LARGEST:
        return []
    switched = name == "FENCE_ENABLE" and value != vehicle.parameters[name]
    vehicle.parameters[name] = value
    if switched:
        vehicle.switch_fences(~Fence.ALT_MIN, on=bool(value))
    return [parameter_value(vehicle, name)]


def _command(vehicle: Vehicle, reporter: Reporter, message: MavlinkMessage) -> Answer:
    try:
        known = _PX4_COMMANDS if vehicle.kind.profile.dialect.typed else _COMMANDS
        carry_out = known[Cmd(message["command"])]
    except (ValueError, KeyError):
        return [_ack(message, Result.UNSUPPORTED)]
    result = carry_out(vehicle, reporter, message)
    return [_ack(message, result)]


def _ack(message: MavlinkMessage, result: Result) -> MavlinkMessage:
    return say(
        "COMMAND_ACK",
        command=message["command"],
        result=int(result),
        target_system=message.system,
        target_component=message.component,
    )


_ANSWERS: Final[Mapping[str, Callable[[Vehicle, Reporter, MavlinkMessage], Answer]]] = MappingProxyType(
    {
        "COMMAND_INT": _command,
        "COMMAND_LONG": _command,
        "PARAM_REQUEST_READ": _read_parameter,
        "PARAM_SET": _set_parameter,
        "SETUP_SIGNING": _setup_signing,
    }
)

# --- commands ---------------------------------------------------------------------------------------


def _set_mode(vehicle: Vehicle, _reporter: Reporter, message: MavlinkMessage) -> Result:
    mode = message["param2"]
    if mode not in vehicle.kind.profile.modes:
        return Result.FAILED
    vehicle.mode = int(mode)
    if mode == vehicle.kind.profile.guided and vehicle.armed:
        here = vehicle.body
        vehicle.target = Target(here.latitude, here.longitude, here.height, vehicle.circle)
    return Result.ACCEPTED


def _arm(vehicle: Vehicle, reporter: Reporter, message: MavlinkMessage) -> Result:
    if message["param1"] < 0.5:
        vehicle.arm(armed=vehicle.flies and vehicle.kind.profile.takeoff is not TakeOff.NONE)
        return Result.FAILED if vehicle.armed else Result.ACCEPTED
    if not vehicle.ready:
        lacks_item = vehicle.up and missing(vehicle)
        reporter.text(f"PreArm: {'Missing mission item' if lacks_item else vehicle.fault or 'not ready'}")
        return Result.FAILED
    vehicle.arm(armed=True)
    return Result.ACCEPTED


def _take_off(vehicle: Vehicle, _reporter: Reporter, message: MavlinkMessage) -> Result:
    profile = vehicle.kind.profile
    if profile.takeoff is not TakeOff.COMMAND:
        return Result.UNSUPPORTED
    if not vehicle.armed or vehicle.mode != profile.guided or vehicle.flies:
        return Result.FAILED
    height = message["param7"]
    if not abs(height) <= HIGHEST:
        return Result.DENIED
    vehicle.target = Target(vehicle.body.latitude, vehicle.body.longitude, height, profile.circle)
    return Result.ACCEPTED


def _reposition(vehicle: Vehicle, _reporter: Reporter, message: MavlinkMessage) -> Result:
    profile = vehicle.kind.profile
    if message.name != "COMMAND_INT" or not vehicle.armed:
        return Result.DENIED
    latitude, longitude = message["x"] / 1e7, message["y"] / 1e7
    height = vehicle.height_in(message["z"], message["frame"])
    flags, circle = message["param2"], message["param3"] or vehicle.circle
    far = metres_to(vehicle.body, latitude, longitude)[0] > FARTHEST
    if far or not abs(height) <= HIGHEST or not 0 < circle <= FARTHEST or not 0 <= flags <= FLAGS:
        return Result.DENIED
    if vehicle.mode != profile.guided and not int(flags) & CHANGE_MODE:
        return Result.FAILED if profile.takeoff is TakeOff.MISSION else Result.DENIED
    if profile.takeoff is not TakeOff.NONE and not vehicle.holds(latitude, longitude, height):
        return Result.DENIED if profile.takeoff is TakeOff.MISSION else Result.FAILED
    vehicle.mode = profile.guided
    vehicle.target = Target(latitude, longitude, height, circle)
    return Result.ACCEPTED


def _set_home(vehicle: Vehicle, reporter: Reporter, message: MavlinkMessage) -> Result:
    """Move its home to a place, or to its position; it reports that at once."""
    here = vehicle.body.latitude, vehicle.body.longitude, vehicle.home[2] + vehicle.body.height
    if message["param1"] == 1:
        vehicle.set_home(*here)
    elif message.name != "COMMAND_INT" or not abs(message["z"]) <= HIGHEST:
        return Result.FAILED
    else:
        vehicle.set_home(message["x"] / 1e7, message["y"] / 1e7, message["z"])
    reporter.once("HOME_POSITION")
    return Result.ACCEPTED


def _keep_fence(vehicle: Vehicle, _reporter: Reporter, message: MavlinkMessage) -> Result:
    if not 0 <= message["param2"] < 16:
        return Result.FAILED
    meant = Fence(int(message["param2"])) if vehicle.version >= (4, 6, 0) else Fence(0)
    meant = meant or ~Fence(0)
    on = message["param1"] > 0.5
    if on and not vehicle.configured & meant:
        return Result.FAILED
    vehicle.switch_fences(meant, on=on)
    return Result.ACCEPTED


def _set_current(vehicle: Vehicle, _reporter: Reporter, message: MavlinkMessage) -> Result:
    return Result.ACCEPTED if _make_current(vehicle, message["param1"]) else Result.FAILED


def _make_current(vehicle: Vehicle, index: float) -> bool:
    there = index in range(len(vehicle.store.mission))
    vehicle.current = int(index) if there else vehicle.current
    return there


def _start_mission(vehicle: Vehicle, _reporter: Reporter, _message: MavlinkMessage) -> Result:
    if not vehicle.store.mission:
        return Result.FAILED
    vehicle.mode = vehicle.kind.profile.auto
    return Result.ACCEPTED


def _request_message(_vehicle: Vehicle, reporter: Reporter, message: MavlinkMessage) -> Result:
    name = _NAMES.get(message["param1"])
    if name is None:
        return Result.FAILED
    reporter.once(name)
    return Result.ACCEPTED


def _set_interval(_vehicle: Vehicle, reporter: Reporter, message: MavlinkMessage) -> Result:
    name = _NAMES.get(message["param1"])
    if name is None or not 0 <= message["param2"] <= LONGEST:
        return Result.FAILED
    reporter.every(name, message["param2"] / 1e6)
    return Result.ACCEPTED


_COMMANDS: Final[Mapping[Cmd, Callable[[Vehicle, Reporter, MavlinkMessage], Result]]] = MappingProxyType(
    {
        Cmd.ARM_DISARM: _arm,
        Cmd.DO_SET_HOME: _set_home,
        Cmd.DO_SET_MODE: _set_mode,
        Cmd.FENCE_ENABLE: _keep_fence,
        Cmd.MISSION_START: _start_mission,
        Cmd.REPOSITION: _reposition,
        Cmd.REQUEST_MESSAGE: _request_message,
        Cmd.SET_MESSAGE_INTERVAL: _set_interval,
        Cmd.SET_MISSION_CURRENT: _set_current,
        Cmd.TAKEOFF: _take_off,
    }
)


# --- PX4's commands, after commander/Commander.cpp and navigator/navigator_main.cpp ------------------


def _px4_set_mode(vehicle: Vehicle, _reporter: Reporter, message: MavlinkMessage) -> Result:
    main, sub = message["param2"], message["param3"]
    if not (0 <= main < 256 and 0 <= sub < 256):
        return Result.TEMPORARILY_REJECTED
    mode = mode_number(int(main), int(sub))
    if mode not in vehicle.kind.profile.modes:
        return Result.TEMPORARILY_REJECTED
    if mode == vehicle.kind.profile.hold and vehicle.mode != mode:
        vehicle.stay()
    vehicle.mode = mode
    return Result.ACCEPTED


def _px4_arm(vehicle: Vehicle, reporter: Reporter, message: MavlinkMessage) -> Result:
    arms = message["param1"] > 0.5
    if arms and not vehicle.ready:
        reporter.text("Arming denied: Resolve system health failures first")
    if (arms and not vehicle.ready) or (not arms and vehicle.flies):
        return Result.TEMPORARILY_REJECTED
    vehicle.arm(armed=arms)
    return Result.ACCEPTED


def _px4_take_off(vehicle: Vehicle, _reporter: Reporter, message: MavlinkMessage) -> Result:
    altitude = message["param7"]
    height = vehicle.parameters["MIS_TAKEOFF_ALT"] if math.isnan(altitude) else altitude - vehicle.home[2]
    if not abs(height) <= HIGHEST:
        return Result.DENIED
    assert vehicle.kind.profile.climb is not None, "PX4 has a mode for it"
    if not vehicle.flies:
        vehicle.mode = vehicle.kind.profile.climb
        vehicle.target = Target(vehicle.body.latitude, vehicle.body.longitude, height, vehicle.circle)
    return Result.ACCEPTED


def _px4_reposition(vehicle: Vehicle, reporter: Reporter, message: MavlinkMessage) -> Result:
    """Go to a target above sea level; without the flag PX4 1.14 to 1.17 do not know the command."""
    flags = message["param2"]
    if message.name != "COMMAND_INT" or not 0 <= flags <= FLAGS or not int(flags) & CHANGE_MODE:
        return Result.UNSUPPORTED
    if not vehicle.armed:
        vehicle.mode = vehicle.kind.profile.hold
        return Result.ACCEPTED  # without a target
    if message["x"] == message["y"] == ANYWHERE:
        vehicle.stay()
        return Result.ACCEPTED
    latitude, longitude, height = message["x"] / 1e7, message["y"] / 1e7, message["z"] - vehicle.home[2]
    circle = message["param3"] if abs(message["param3"]) > 0 else vehicle.circle
    far = metres_to(vehicle.body, latitude, longitude)[0] > FARTHEST
    if far or not abs(height) <= HIGHEST or not abs(circle) <= FARTHEST:
        return Result.DENIED
    vehicle.mode = vehicle.kind.profile.guided
    if vehicle.holds(latitude, longitude, height):
        vehicle.target = Target(latitude, longitude, height, circle)
    else:
        reporter.text("Reposition is outside geofence")  # PX4 accepts it nevertheless
    return Result.ACCEPTED


_PX4_COMMANDS: Final[Mapping[Cmd, Callable[[Vehicle, Reporter, MavlinkMessage], Result]]] = MappingProxyType(
    {
        Cmd.ARM_DISARM: _px4_arm,
        Cmd.DO_SET_HOME: _set_home,
        Cmd.DO_SET_MODE: _px4_set_mode,
        Cmd.MISSION_START: _start_mission,
        Cmd.REPOSITION: _px4_reposition,
        Cmd.REQUEST_MESSAGE: _request_message,
        Cmd.SET_MESSAGE_INTERVAL: _set_interval,
        Cmd.TAKEOFF: _px4_take_off,
    }
)


def timestamp(now: float) -> int:
    """Return a signature's time stamp for a time in seconds since 1970."""
    return int((now - EPOCH) * UNITS)
