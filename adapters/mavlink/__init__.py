"""Autopilots over MAVLink: publishes state, links and control authority; takes places, paths and hand-overs.

`pilot` is the whole behaviour towards one vehicle, as a pure state machine made of smaller ones (`telemetry`, `plan`,
`task`, `sync`, `upload`, `download`, `command`, `streams`, `link`, `signing`); `autopilot` is the plugin that
gives it a socket and a clock, `roster` identifies vehicles, `keys` keeps the signing key.

A vehicle's state confirms what it does, never an answer alone.
"""

from adapters.mavlink.autopilot import Autopilot
from adapters.mavlink.fleet import Craft, Stations

__all__ = ["Autopilot", "Craft", "Stations"]
