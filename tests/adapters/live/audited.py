"""Missions flown by `bigactors run`'s own loop over sockets, and a witness who holds commits against the truth."""

import asyncio
import time
from contextlib import suppress
from dataclasses import dataclass, field

from live_missions import WEST, verify

from adapters.live.run_watchers import Watcher
from adapters.simulated import Disturbance, Kind, Simulator, Vehicle, run
from bigactors.arguments import parse_arguments
from bigactors.commands.run.flight import fly, prepare, record
from bigactors.flight_watchers import Terminal
from bigactors.recordings import open_recording, trace_of
from physical import box, circle, contains, point

SHUTTLE = """
mission shuttle
signature {
  kind Location contains Location, Spill, Drifter, UAV, Station
  kind Spill contains UAV
  kind UAV driven
  kind Drifter
  kind Station
}
world {
  west0: Location = box (37.02, -8.64) (37.00, -8.66)
  east0: Location = box (37.02, -8.60) (37.00, -8.62)
  gcs0: Station = point (37.05, -8.63) linked control:gcs0, internet
  gcs1: Station = point (37.06, -8.63) linked control:gcs1, internet
  uav0: UAV = point (37.01, -8.65) linked control:gcs0
  drifter0: Drifter = point (37.011, -8.651)
}
BigActor a hosted_at uav0 with_behavior {
  control(MOVE_HOST_TO east0)
  observe(CHILDREN(PARENT(HOST)))
  react { case obs => send "there" to op }
}
BigActor op hosted_at gcs0 with_behavior {
  react { case "there" => control(HAND uav0 TO gcs1) }
  observe(LINKED_TO(uav0))
  react { case obs => send "yours" to shore }
}
BigActor shore hosted_at gcs1 with_behavior {
  react { case "yours" => control(MOVE uav0 TO west0) }
  observe(CHILDREN(west0))
  react { case obs => display(obs) }
}
environment { uav0 arrives }
live {
  on broken assumption: return
  FLY anyone within 8 min: return
}
"""

THERE_AND_BACK = """
BigActor a hosted_at uav0 with_behavior {
  control(MOVE_HOST_TO east0)
  observe(CHILDREN(PARENT(HOST)))
  react { case obs => control(MOVE_HOST_TO west0) }
}
environment { uav0 arrives control:gcs0 drops and returns }
"""

PATROL = SHUTTLE[: SHUTTLE.index("BigActor")].replace("shuttle", "patrol") + THERE_AND_BACK

PLACES = {
    "west0": box((37.02, -8.64), (37.00, -8.66)),
    "east0": box((37.02, -8.60), (37.00, -8.62)),
    "searchArea0": box((37.04, -8.59), (36.94, -8.79)),
    "airfield0": circle((37.149, -8.584), 900.0),
    "oilSpill0": circle((37.0, -8.7), 700.0),
    "bay0": box((37.105, -8.57), (37.085, -8.6)),
    "northGate0": circle((37.14, -8.612), 300.0),
    "southGate0": circle((37.108, -8.612), 300.0),
    "town0": box((37.135, -8.57), (37.115, -8.6)),
    "home0": circle((37.0, -8.6), 300.0),
    "mid0": circle((37.015, -8.6), 300.0),
    "north0": circle((37.03, -8.6), 300.0),
    "side0": circle((37.015, -8.56), 300.0),
}
STATIONS = {"gcs0": 255.0, "gcs1": 254.0}
GOOD = Disturbance()
LOOK = 0.5
LATE = 3.0
"""Seconds by which what is seen may be behind the truth: delays of the link, and turns."""


@dataclass
class Witness(Watcher):
    """Holds each commit against where the vehicle was, and each hand-over against whom it obeyed."""

    vehicle: Vehicle
    truth: list = field(default_factory=list)
    rules: list = field(default_factory=list)
    commits: list = field(default_factory=list)  # how much of the truth came before each
    findings: list = field(default_factory=list)
    untrue: list = field(default_factory=list)

    async def look(self):
        while True:
            self.note()
            await asyncio.sleep(LOOK)

    def note(self):
        body = self.vehicle.body
        now, obeyed = asyncio.get_running_loop().time(), self.vehicle.parameters["SYSID_MYGCS"]
        self.truth.append((now, (body.latitude, body.longitude), obeyed))

    def recent(self):
        return [each for each in self.truth[-100:] if each[0] >= self.truth[-1][0] - LATE]

    def turned(self, turn, _now):
        self.findings += turn.findings
        if turn.steps:
            self.note()
        for step in turn.steps:
            label = step.transition.label
            self.rules.append(label.rule)
            if label.rule == "commit":
                self.commits.append(len(self.truth))
                ((_, place),) = label.about.reaction.reactum.parents
                self.check(label, any(contains(PLACES[place], point(*at)) for _, at, _ in self.recent()))
            elif label.rule == "actuate" and "HAND" in str(label):
                station = label.about.reaction.text.rpartition(" ")[2]
                self.check(label, any(obeyed == STATIONS[station] for _, _, obeyed in self.recent()))

    def check(self, label, true):
        if not true:
            self.untrue.append(str(label))

    def kinds(self):
        return {finding.kind for finding in self.findings}

    def told(self):
        return "\n".join(finding.message for finding in self.findings)


@dataclass
class Flown:
    ending: object
    witness: Witness
    vehicle: Vehicle
    broken: bool

    @property
    def ended(self):
        return self.ending.reason == "the mission has ended"

    @property
    def logical(self):
        return self.ending.state.configuration.structure.logical

    def inside(self, place):
        return contains(PLACES[place], point(self.vehicle.body.latitude, self.vehicle.body.longitude))


def flown_in(folder, mission, vehicle, *more, disturbance=GOOD, foe=None, seconds=2500):
    """Fly a mission that was checked; what was recorded replays to the same configuration."""
    name = mission
    if "\n" in mission:
        name = "flown.mission"
        (folder / name).write_text(mission)
    verdict = str(folder / "flown.verdict.json")
    verify(name, verdict)
    line = [
        "run",
        name,
        "--verdict",
        verdict,
        "--vehicle=uav0=udp:127.0.0.1:0",
        "--socket=s",
        "--record=r.mcap",
    ]
    flight = prepare(parse_arguments([*line, f"--for={seconds}", *more]))
    terminal, witness = Terminal(flight.resting), Witness(vehicle)

    def beside(simulator):
        return witness.look(), *([foe(flight, simulator, witness)] if foe else [])

    with record(flight) as tape:
        ending = run(flown_with(flight, vehicle, (terminal, tape, witness), disturbance, beside))
    assert witness.untrue == []
    trace = trace_of(open_recording("r.mcap"), flight.mission)
    assert trace.configurations[-1] == ending.state.configuration
    return Flown(ending, witness, vehicle, terminal.broken)


async def flown_with(flight, vehicle, watchers, disturbance=GOOD, beside=lambda _simulator: ()):
    """Fly a prepared mission with simulated vehicles, and what goes on beside them; return how it ended."""
    vehicles = vehicle if isinstance(vehicle, list) else [vehicle]
    flown = asyncio.ensure_future(fly(flight, watchers))
    plugin = flight.plugins[0]
    while not plugin.local and not flown.done():
        await asyncio.sleep(0.05)
    simulator = Simulator(f"udpout:127.0.0.1:{plugin.local[1]}", vehicles, disturbance, 7, time.time())
    tasks = [asyncio.ensure_future(each) for each in (simulator.run(), *beside(simulator))]
    try:
        ending = await flown
        for task in tasks:
            if task.done():
                task.result()
        return ending
    finally:
        for task in tasks:
            task.cancel()
            with suppress(asyncio.CancelledError):
                await task


def copter(**more):
    return Vehicle(Kind.COPTER, (*WEST, 20.0), **more)


async def airborne(witness, longitude=-8.64):
    """Wait until the vehicle is on its way."""
    while witness.vehicle.body.longitude < longitude:
        await asyncio.sleep(0.5)
