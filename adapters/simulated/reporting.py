"""The periodic messages of a simulated vehicle: heartbeats, positions, states, each at its interval."""

from __future__ import annotations

import math
import struct
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any, Final

from adapters.mavlink.constants import GEOFENCE, PREARM_HEALTHY, Landed, ModeFlag
from adapters.mavlink.message import MavlinkMessage, say
from adapters.mavlink.texts import CHUNK
from adapters.simulated.simulated_vehicle import Vehicle
from adapters.simulated.vehicle_state import WARNING

DEFAULT: Final = {
    "HEARTBEAT": 1.0,
    "SYS_STATUS": 1.0,
    "GPS_RAW_INT": 1.0,
    "SYSTEM_TIME": 1.0,
    "MISSION_CURRENT": 1.0,
}
"""The default seconds between two messages of a kind."""

WHOLE: Final = ("COM_LOW_BAT_ACT", "GF_ACTION", "MIS_TKO_LAND_REQ")
"""PX4's parameters that are integers: their four bytes are sent as if they were a float's."""

GOOD: Final = 831
NO_POSITION: Final = 165
"""ArduPilot's EKF_STATUS_FLAGS with a position, and without."""

SHORTEST: Final = 0.05
CAPABILITIES: Final = 2 | 4 | 8 | 8192 | 16384
"""MAV_PROTOCOL_CAPABILITY: float parameters, MISSION_INT, COMMAND_INT, MAVLink 2, fences by the mission protocol."""


class Reporter:
    """The intervals of a vehicle's messages, and its messages to send once."""

    def __init__(self) -> None:
        self._every = dict(DEFAULT)
        self._said: dict[str, float] = {}
        self._texts: list[str] = []
        self._once: list[str] = []
        self._mode: int | None = None
        self._chunked = 0

    def every(self, name: str, seconds: float) -> None:
        """Send a message at another interval; never if it isn't positive."""
        self._every.pop(name, None)
        if seconds > 0:
            self._every[name] = max(SHORTEST, seconds)

    def once(self, name: str) -> None:
        """Send a message once."""
        self._once = [*self._once, name][-8:]

    def text(self, text: str) -> None:
        """Send a text once."""
        self._texts = [*self._texts, text][-8:]

    def reset(self) -> None:
        """Reset all requests, as a reboot does."""
        self.__init__()  # type: ignore[misc]

    def due(self, vehicle: Vehicle) -> list[MavlinkMessage]:
        """Return the messages to send now, by the vehicle's own clock."""
        names = [name for name, period in self._every.items() if self._is_due(name, period, vehicle.uptime)]
        if vehicle.mode != self._mode:  # a change is sent at once
            names, self._mode = ["HEARTBEAT", *names], vehicle.mode
        words = [*((WARNING, text) for text in self._texts), *vehicle.words]
        texts = [message for severity, text in words for message in self._chunks(severity, text.encode())]
        reached = [say("MISSION_ITEM_REACHED", seq=index) for index in vehicle.reached]
        names += self._once
        if vehicle.second is not None and self._is_due("GPS2_RAW", 1.0, vehicle.uptime):
            names.append("GPS2_RAW")
        self._texts.clear()
        self._once.clear()
        vehicle.reached.clear()
        vehicle.words.clear()
        return [*(_MESSAGES[name](vehicle) for name in names), *texts, *reached]

    def _chunks(self, severity: int, text: bytes) -> list[MavlinkMessage]:
        """Return the messages of a text; a long one has a number, and ends with a chunk that is not full."""
        if len(text) <= CHUNK:
            return [say("STATUSTEXT", severity=severity, text=text)]
        self._chunked = self._chunked % 65_535 + 1
        return [
            say(
                "STATUSTEXT", severity=severity, text=text[at : at + CHUNK], id=self._chunked, chunk_seq=index
            )
            for index, at in enumerate(range(0, len(text) + 1, CHUNK))
        ]

    def _is_due(self, name: str, period: float, uptime: float) -> bool:
        last = self._said.get(name)
        if last is not None and uptime - last < period - 1e-6:
            return False
        # Keeps to the grid, so that intervals don't drift by the length of a step.
        self._said[name] = uptime if last is None or uptime - last > 2 * period else last + period
        return True


def parameter_value(vehicle: Vehicle, name: str) -> MavlinkMessage:
    """Return the message with a parameter's value."""
    names, value = list(vehicle.parameters), vehicle.parameters[name]
    whole = vehicle.kind.profile.dialect.typed and name in WHOLE
    return say(
        "PARAM_VALUE",
        param_id=name.encode(),
        param_value=struct.unpack("<f", struct.pack("<i", round(value)))[0] if whole else float(value),
        param_type=6 if whole else 9,
        param_count=len(names),
        param_index=names.index(name),
    )


def _heartbeat(vehicle: Vehicle) -> MavlinkMessage:
    flags = ModeFlag.CUSTOM_MODE | 80 | (ModeFlag.ARMED if vehicle.armed else 0)
    return say(
        "HEARTBEAT",
        type=vehicle.kind.value[0],
        autopilot=vehicle.kind.profile.dialect.number,
        base_mode=int(flags),
        custom_mode=vehicle.mode,
        system_status=5 if vehicle.failed_safe else 4 if _is_active(vehicle) else 3,
        mavlink_version=3,
    )


def _is_active(vehicle: Vehicle) -> bool:
    """Return whether its HEARTBEAT says active: PX4's as soon as it is armed (mavlink/streams/HEARTBEAT.hpp)."""
    return vehicle.armed if vehicle.kind.profile.dialect.lands_by_state else vehicle.flies


def _extended(vehicle: Vehicle) -> MavlinkMessage:
    rises = vehicle.mode == vehicle.kind.profile.climb
    landed = (Landed.TAKEOFF if rises else Landed.IN_AIR) if vehicle.flies else Landed.ON_GROUND
    return say("EXTENDED_SYS_STATE", vtol_state=0, landed_state=int(landed))


def _status(vehicle: Vehicle) -> MavlinkMessage:
    sensors = {
        "onboard_control_sensors_present": PREARM_HEALTHY | GEOFENCE,
        "onboard_control_sensors_enabled": PREARM_HEALTHY
        | (GEOFENCE if vehicle.fences & vehicle.configured else 0),
        "onboard_control_sensors_health": PREARM_HEALTHY if vehicle.ready else 0,
    }
    rest = dict.fromkeys(
        ["load", "current_battery", "drop_rate_comm", "errors_comm"]
        + [f"errors_count{number}" for number in range(1, 5)],
        0,
    )
    return say(
        "SYS_STATUS",
        **sensors,
        voltage_battery=round(vehicle.volts * 1000),
        battery_remaining=round(100 * vehicle.charge),
        **rest,
    )


def _gps(vehicle: Vehicle) -> MavlinkMessage:
    return say("GPS_RAW_INT", **_receiver(vehicle, fix=vehicle.fixed and vehicle.has_fix))


def _second_gps(vehicle: Vehicle) -> MavlinkMessage:
    fix = bool(vehicle.second) and vehicle.has_fix
    return say("GPS2_RAW", **_receiver(vehicle, fix=fix), dgps_numch=0, dgps_age=0)


def _receiver(vehicle: Vehicle, *, fix: bool) -> dict[str, Any]:
    """Return the fields of a receiver's message."""
    return {
        "time_usec": int(vehicle.uptime * 1e6),
        "fix_type": 6 if fix else int(vehicle.uptime > 6),
        "lat": _e7(vehicle.body.latitude) if fix else 0,
        "lon": _e7(vehicle.body.longitude) if fix else 0,
        "alt": _altitude(vehicle) if fix else 0,
        "eph": 120 if fix else 65_535,
        "epv": 200 if fix else 65_535,
        "vel": round(vehicle.body.speed * 100),
        "cog": round(vehicle.body.course * 100) % 36_000,
        "satellites_visible": 10 if fix else 0,
    }


def _estimate(vehicle: Vehicle) -> int:
    """Return the flags of its filter: all estimates good, or only its attitude, without a position."""
    return GOOD if vehicle.has_fix else NO_POSITION


def _filter(vehicle: Vehicle) -> MavlinkMessage:
    kinds = ("velocity", "pos_horiz", "pos_vert", "compass", "terrain_alt")
    return say(
        "EKF_STATUS_REPORT",
        flags=_estimate(vehicle),
        **{f"{kind}_variance": 0.0 for kind in kinds},
    )


def _estimator(vehicle: Vehicle) -> MavlinkMessage:
    ratios = dict.fromkeys(
        [f"{each}_ratio" for each in ("vel", "pos_horiz", "pos_vert", "mag", "hagl", "tas")], 0.0
    )
    return say(
        "ESTIMATOR_STATUS",
        time_usec=int(vehicle.uptime * 1e6),
        flags=_estimate(vehicle),
        **ratios,
        pos_horiz_accuracy=1.0,
        pos_vert_accuracy=1.0,
    )


def _position(vehicle: Vehicle) -> MavlinkMessage:
    where, fix = vehicle.body, vehicle.has_fix
    course = math.radians(where.course)
    return say(
        "GLOBAL_POSITION_INT",
        time_boot_ms=_milliseconds(vehicle),
        lat=_e7(where.latitude) if fix else 2_900,  # as the recorded vehicle before its fix
        lon=_e7(where.longitude) if fix else 80,
        alt=_altitude(vehicle) if fix else 100,
        relative_alt=round(where.height * 1000),
        vx=round(where.speed * 100 * math.cos(course)),
        vy=round(where.speed * 100 * math.sin(course)),
        vz=round(-where.climb * 100),
        hdg=round(where.course * 100) % 36_000,
    )


def _attitude(vehicle: Vehicle) -> MavlinkMessage:
    roll, pitch = map(math.radians, vehicle.tilt)
    yaw = math.remainder(math.radians(vehicle.body.course), math.tau)
    rates = {"rollspeed": 0.0, "pitchspeed": 0.0, "yawspeed": math.radians(vehicle.body.turn)}
    return say("ATTITUDE", time_boot_ms=_milliseconds(vehicle), roll=roll, pitch=pitch, yaw=yaw, **rates)


def _time(vehicle: Vehicle) -> MavlinkMessage:
    return say("SYSTEM_TIME", time_unix_usec=0, time_boot_ms=_milliseconds(vehicle))


def _current(vehicle: Vehicle) -> MavlinkMessage:
    home = vehicle.kind.profile.dialect.home_is_item
    total = max(0, len(vehicle.store.mission) - home)
    return say("MISSION_CURRENT", seq=vehicle.current, total=total)


def _target(vehicle: Vehicle) -> MavlinkMessage:
    at = vehicle.target
    nothing: dict[str, Any] = dict.fromkeys(["vx", "vy", "vz", "afx", "afy", "afz", "yaw", "yaw_rate"], 0.0)
    return say(
        "POSITION_TARGET_GLOBAL_INT",
        time_boot_ms=_milliseconds(vehicle),
        coordinate_frame=0,
        type_mask=65_016,
        lat_int=_e7(at.latitude) if at else 0,
        lon_int=_e7(at.longitude) if at else 0,
        alt=vehicle.home[2] + at.height if at else 0.0,
        **nothing,
    )


def _home(vehicle: Vehicle) -> MavlinkMessage:
    latitude, longitude, altitude = vehicle.home
    known = vehicle.has_fix
    nothing: dict[str, Any] = dict.fromkeys(["x", "y", "z", "approach_x", "approach_y", "approach_z"], 0.0)
    return say(
        "HOME_POSITION",
        latitude=_e7(latitude) if known else 0,
        longitude=_e7(longitude) if known else 0,
        altitude=round(altitude * 1000),
        q=[1.0, 0.0, 0.0, 0.0],
        **nothing,
    )


def _version(vehicle: Vehicle) -> MavlinkMessage:
    numbers = ["capabilities", "flight_sw_version", "middleware_sw_version", "os_sw_version", "board_version"]
    nothing: dict[str, Any] = dict.fromkeys([*numbers, "vendor_id", "product_id", "uid"], 0)
    custom = {f"{part}_custom_version": [0] * 8 for part in ("flight", "middleware", "os")}
    nothing["capabilities"] = CAPABILITIES
    nothing["flight_sw_version"] = int.from_bytes(bytes((*vehicle.version, 255)))
    return say("AUTOPILOT_VERSION", uid2=list(vehicle.serial.ljust(18, b"\0")), **nothing, **custom)


def _e7(degrees: float) -> int:
    return round(degrees * 1e7)


def _altitude(vehicle: Vehicle) -> int:
    return round((vehicle.home[2] + vehicle.body.height) * 1000)


def _milliseconds(vehicle: Vehicle) -> int:
    return int(vehicle.uptime * 1000) % 2**32


_MESSAGES: Final[Mapping[str, Callable[[Vehicle], MavlinkMessage]]] = MappingProxyType(
    {
        "HEARTBEAT": _heartbeat,
        "SYS_STATUS": _status,
        "GPS_RAW_INT": _gps,
        "GPS2_RAW": _second_gps,
        "EKF_STATUS_REPORT": _filter,
        "ESTIMATOR_STATUS": _estimator,
        "GLOBAL_POSITION_INT": _position,
        "SYSTEM_TIME": _time,
        "MISSION_CURRENT": _current,
        "POSITION_TARGET_GLOBAL_INT": _target,
        "HOME_POSITION": _home,
        "AUTOPILOT_VERSION": _version,
        "EXTENDED_SYS_STATE": _extended,
        "ATTITUDE": _attitude,
    }
)
