"""Simulated vehicles that speak MAVLink over real sockets, for tests and demonstrations.

`vehicle` moves, `protocol` and `store` answer, `reporting` sends the periodic messages. `serving` puts the vehicle on a
link with a `disturbance`, and `clock` runs everything faster than real time.
"""

from adapters.simulated.clock import run
from adapters.simulated.serving import Disturbance, Simulator
from adapters.simulated.simulated_vehicle import Vehicle
from adapters.simulated.vehicle_state import Kind

__all__ = ["Disturbance", "Kind", "Simulator", "Vehicle", "run"]
