"""Fly a simulated vehicle: `python -m bigactors.adapters.simulated --to udpout:127.0.0.1:14550 --kind plane`."""

import argparse
import time
from contextlib import suppress
from pathlib import Path

from adapters.mavlink.signing import Signing, load
from adapters.simulated.clock import run
from adapters.simulated.serving import Disturbance, Simulator
from adapters.simulated.simulated_vehicle import Vehicle
from adapters.simulated.vehicle_state import Kind


def home(text: str) -> tuple[float, float, float]:
    """Read LATITUDE,LONGITUDE,ALTITUDE.

    >>> home("37.0,-8.6,20")
    (37.0, -8.6, 20.0)
    """
    latitude, longitude, altitude = map(float, text.split(","))
    return latitude, longitude, altitude


def arguments() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    parser = argparse.ArgumentParser(prog="python -m bigactors.adapters.simulated", description=__doc__)
    parser.add_argument(
        "--to", default="udpout:127.0.0.1:14550", help="the ground station (default %(default)s)"
    )
    kinds = [kind.name.lower() for kind in Kind if not kind.name.startswith("PX4_")]
    parser.add_argument("--kind", default="plane", choices=kinds)
    parser.add_argument("--autopilot", default="ardupilot", choices=["ardupilot", "px4"])
    parser.add_argument(
        "--home", default="37.0,-8.6,20", type=home, metavar="LAT,LON,ALT", help="default %(default)s"
    )
    parser.add_argument(
        "--system", default=1, type=int, choices=range(1, 256), metavar="ID", help="MAVLink system id"
    )
    parser.add_argument("--speed", default=1.0, type=float, help="how much faster than the clock on the wall")
    parser.add_argument(
        "--loss", default=0.0, type=float, help="the part of all packets that is lost, both ways"
    )
    parser.add_argument(
        "--delay", default=0.0, type=float, metavar="SECONDS", help="the longest delay of a packet"
    )
    parser.add_argument("--serial", default=b"", type=bytes.fromhex, metavar="HEX", help="serial number")
    parser.add_argument(
        "--key", type=Path, metavar="FILE", help="the key file that its packets are signed with"
    )
    return parser


def main() -> None:
    """Fly until interrupted."""
    parser = arguments()
    options = parser.parse_args()
    name = {"px4": "PX4_"}.get(options.autopilot, "") + options.kind.upper()
    if name not in Kind.__members__:
        parser.error(f"there is no simulated {options.kind} with PX4: take a plane or a copter")
    signed = Signing(load(options.key).key) if options.key else None
    vehicle = Vehicle(Kind[name], options.home, options.system, signing=signed)
    vehicle.serial = options.serial[:18]
    disturbance = Disturbance(options.loss, delay=(0.0, options.delay))
    simulator = Simulator(options.to, [vehicle], disturbance, epoch=time.time())
    with suppress(KeyboardInterrupt):
        run(simulator.run(), options.speed)


if __name__ == "__main__":
    main()
