"""Simulated vehicles that speak MAVLink over real sockets, for tests and demonstrations.

`vehicle` moves, `protocol` and `store` answer, `reporting` tells, `serving` puts it on a link that is as bad as
`disturbance` says; `clock` runs the whole faster than the clock on the wall.
"""

from adapters.simulated.clock import run
from adapters.simulated.disturbance import Disturbance
from adapters.simulated.serving import Simulator
from adapters.simulated.state import Kind
from adapters.simulated.vehicle import Vehicle

__all__ = ["Disturbance", "Kind", "Simulator", "Vehicle", "run"]
