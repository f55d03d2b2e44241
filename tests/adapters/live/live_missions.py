"""Missions on which live runs are tested, and what plugins would tell of them."""

from pathlib import Path

from adapters.live.batch import Batch, Heard
from adapters.live.commanded import Commanded
from adapters.live.core import advance, started
from adapters.live.ground_formulas import about_ways
from adapters.live.live_state import LiveState
from adapters.live.plan import Plan
from adapters.plugin import Accepted, Aged
from bigactors.cli import main
from physical import PhysicalProperty, point
from semantics.live_policy import LivePolicy
from semantics.state.setting import Control, Scheduler
from specs.diagnostics import Source
from specs.elaboration import Variation, elaborate
from specs.parser import parse

LIVE = Variation(Scheduler.FCFS, Control.TIMED)

TOUR = """
signature {
  kind Location contains Location, Vessel, UAV, Station
  kind UAV driven
  kind Vessel
  kind Station
}
world {
  west0: Location = box (37.02, -8.64) (37.00, -8.66)
  east0: Location = box (37.02, -8.60) (37.00, -8.62)
  gcs0: Station = point (37.05, -8.63) linked control:gcs0
  gcs1: Station = point (37.06, -8.63) linked control:gcs1
  uav0: UAV = point (37.01, -8.65) linked control:gcs0
  boat0: Vessel = point (37.03, -8.63)
}
"""

TWO = TOUR.replace("boat0: Vessel", "uav1: UAV = point (37.012, -8.652) linked control:gcs0\n  boat0: Vessel")
WEST, EAST, BETWEEN, BESIDE = (37.01, -8.65), (37.01, -8.61), (37.01, -8.63), (37.012, -8.652)


VERDICTS = {}


def verify(name, verdict, *more):
    """Leave the verdict on a mission in a file; each text is checked once, and `run` holds it against what it flies."""
    path = Path(name)
    asked = (path.read_text() if path.suffix else name, *more)
    if asked not in VERDICTS:
        line = ["check", "--no-traces", "--control", "timed", "--verdict", str(verdict), str(name), *more]
        assert main(line) == 0
        VERDICTS[asked] = Path(verdict).read_bytes()
    Path(verdict).write_bytes(VERDICTS[asked])


def mission(text, name="tour.mission"):
    source = Source(name, text)
    return elaborate(parse(source), source, Path(), LIVE)


def plan_of(text, precautions=None, strict=False):
    found = mission(text)
    watched = {"invariants": about_ways(*found.properties), "fixed": found.fixed}
    return Plan(found.initial, {"uav0": "autopilot"}, precautions or LivePolicy(), strict, **watched)


def seen(entity, at, time, plugin="autopilot", kind="UAV", channels=("control:gcs0",), **more):
    said = PhysicalProperty(entity, kind, point(*at), channels=channels, time=time, source=plugin, **more)
    return Heard(plugin, said)


def boat(at, time, name="boat0"):
    return seen(name, at, time, "ais", "Vessel", ())


def known_of(state, **more):
    """What a recording of a run knows of its state."""
    return LiveState(
        state.configuration, state.number, commanded=Commanded(count=state.commanded.count), **more
    )


class Run:
    """A live run in which the test is the world; vehicles do what they are told as long as they are `willing`."""

    def __init__(self, plan, willing=True):
        self.plan, self.state, self.willing = plan, started(plan), willing
        self.steps, self.commands, self.findings, self.answers = [], [], [], []
        self.again = None

    def turn(self, now, *heard, reports=(), sayings=(), missed=0.0):
        reports = (*self.accepted(now), *reports)
        turn = advance(self.plan, self.state, Batch(heard, reports, tuple(sayings), missed), now)
        self.state, self.again = turn.state, turn.again
        self.steps += turn.steps
        self.commands += turn.commands
        self.findings += turn.findings
        self.answers += turn.answers
        return turn

    def accepted(self, now):
        """What vehicles report of what they are to do."""
        told = [
            order.command
            for order in self.state.commanded.flights.values()
            if not (order.obeyed or order.refused)
        ]
        return [Accepted(command.request, command.entity, now) for command in told if self.willing]

    @property
    def labels(self):
        return [str(step.transition.label) for step in self.steps]

    @property
    def rules(self):
        return [step.transition.label.rule for step in self.steps]

    @property
    def shown(self):
        return [text for step in self.steps for text in step.transition.shown]

    @property
    def told(self):
        return [type(command).__name__ for command in self.commands]

    @property
    def refusals(self):
        return [answer.refusal for answer in self.answers]

    def kinds(self):
        return [finding.kind for finding in self.findings]

    def messages(self, *kinds):
        return [finding.message for finding in self.findings if not kinds or finding.kind in kinds]


def flying(text=TOUR, precautions=None, willing=True, **more):
    """A run whose vehicle was heard where it begins."""
    run = Run(plan_of(text, precautions, **more), willing)
    run.turn(0.0, seen("uav0", WEST, 0.0))
    return run


def flying_two(text):
    """A run whose two vehicles were heard where they begin, beside each other."""
    run = Run(Plan(plan_of(text).first, {"uav0": "autopilot", "uav1": "autopilot"}))
    run.turn(0.0, seen("uav0", WEST, 0.0), seen("uav1", BESIDE, 0.0))
    return run


def aged(heard, seconds):
    """What was heard, which is too old after some seconds."""
    return Heard(heard.plugin, Aged(heard.published, seconds))
