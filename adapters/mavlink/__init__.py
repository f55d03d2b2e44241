"""Autopilots over MAVLink: they publish state, links and authority, and take places, paths and hand-overs.

`pilot` is the behaviour towards one vehicle: a pure state machine made of smaller ones (`telemetry`, `next_step`,
`task`, `sync`, `upload`, `download`, `command`, `streams`, `link`, `signing`). `autopilot` is the plugin that gives it
a socket and a clock, `roster` identifies vehicles, and `keys` keeps the signing key.

A command counts as carried out once the vehicle's state shows it; an answer alone proves nothing.
"""

from adapters.mavlink.mavlink_plugin import Autopilot
from adapters.mavlink.vehicle_identities import Craft, Stations

__all__ = ["Autopilot", "Craft", "Stations"]
