"""Measure the cost of MAVLink: frames of many vehicles through decoder and pilot, per message and per core.

`python -m benchmarks.link [VEHICLES]`: positions at 10 Hz and six other messages at 1 Hz, of vehicles that carry out a
command; simulators and sockets outside the account.
"""

import sys
import time

from adapters.mavlink import Craft, Stations, pilot
from adapters.mavlink.codec import Decoder, Encoder, Garbage
from adapters.mavlink.pilot import Pilot
from adapters.plugin import GoTo
from adapters.simulated import Kind, Vehicle
from adapters.simulated.reporting import Reporter, parameter_value
from physical import box

SECONDS = 10
AREA = box((37.1, -8.5), (36.9, -8.7))


def frames_of(system: int) -> list[bytes]:
    """Return what one vehicle says in ten seconds."""
    vehicle, reporter, encoder = (
        Vehicle(Kind.PLANE, (37.0, -8.6, 20.0), system),
        Reporter(),
        Encoder(system, 1),
    )
    reporter.every("GLOBAL_POSITION_INT", 0.1)
    reporter.every("POSITION_TARGET_GLOBAL_INT", 1.0)
    vehicle.move(100.0)
    said = [
        encoder.pack(parameter_value(vehicle, "SYSID_MYGCS"))
    ]  # whom it obeys: nothing is published before
    for step in range(SECONDS * 10):
        vehicle.move(100.0 + step / 10)
        said += [encoder.pack(message) for message in reporter.due(vehicle)]
    return said


def main() -> None:
    """Measure and say."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 100
    pilots = [Pilot(Craft(f"uav{n}"), Stations(), n % 250 + 1) for n in range(count)]
    pilots = [pilot.command(each, GoTo("r1", each.craft.entity, AREA), 0.0).pilot for each in pilots]
    traffic = [(Decoder(), frames_of(each.system)) for each in pilots]
    messages = published = 0
    start = time.process_time()
    for index, (decoder, frames) in enumerate(traffic):
        for number, frame in enumerate(frames):
            now = number * SECONDS / len(frames)
            for message in decoder.feed(frame):
                assert not isinstance(message, Garbage)
                outcome = pilot.hear(pilots[index], message, now)
                pilots[index] = outcome.pilot
                messages += 1
                published += len(outcome.published)
        for tick in range(SECONDS * 5):
            pilots[index] = pilot.tick(pilots[index], tick / 5).pilot
    spent = time.process_time() - start
    assert published >= 0.9 * count * SECONDS * 10
    sys.stdout.write(
        f"{count} vehicles, {messages / SECONDS:.0f} messages/s, {published / SECONDS:.0f} properties/s: "
        f"{spent / messages * 1e6:.0f} µs a message with its share of the ticks, {spent / SECONDS:.0%} of a core\n"
    )


if __name__ == "__main__":
    main()
