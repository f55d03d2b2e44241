"""Telemetry logs of one vehicle, message by message."""

from adapters.mavlink.codec import Encoder
from adapters.mavlink.message import say
from adapters.mavlink.tlog import entry

BEAT = say("HEARTBEAT", type=1, autopilot=3, base_mode=0, custom_mode=0, system_status=4, mavlink_version=3)
WHERE = {
    "lat": 474000000,
    "lon": 85400000,
    "alt": 100000,
    "relative_alt": 0,
    "vx": 0,
    "vy": 0,
    "vz": 0,
    "hdg": 0,
}
FIX = say(
    "GPS_RAW_INT",
    time_usec=0,
    fix_type=3,
    satellites_visible=9,
    eph=1,
    epv=1,
    vel=0,
    cog=0,
    lat=0,
    lon=0,
    alt=0,
)


def position(milliseconds):
    return say("GLOBAL_POSITION_INT", time_boot_ms=milliseconds, **WHERE)


def log(*messages, system=1, component=1, start=1.7e9):
    encoder = Encoder(system, component)
    return b"".join(entry(start + number, encoder.pack(message)) for number, message in enumerate(messages))
