"""What vehicles say, as packets: heartbeats, positions and fixes, of which a test names what matters to it."""

from adapters.mavlink.message import say


def beat(kind=1, autopilot=3, mode=0, custom=0, status=3):
    more = {"base_mode": mode, "custom_mode": custom, "system_status": status, "mavlink_version": 3}
    return say("HEARTBEAT", type=kind, autopilot=autopilot, **more)


def position(at, clock, altitude=0, height=0):
    latitude, longitude = (round(degrees * 1e7) for degrees in at)
    where = {"lat": latitude, "lon": longitude, "alt": altitude, "relative_alt": height}
    return say("GLOBAL_POSITION_INT", time_boot_ms=clock, vx=0, vy=0, vz=0, hdg=0, **where)


def fixed(at=(0.0, 0.0)):
    rest = {"alt": 0, "eph": 1, "epv": 1, "vel": 0, "cog": 0, "satellites_visible": 9}
    latitude, longitude = (round(degrees * 1e7) for degrees in at)
    return say("GPS_RAW_INT", time_usec=0, fix_type=3, lat=latitude, lon=longitude, **rest)
