"""Recordings of real runs, and what a console makes of them message by message."""

from functools import cache

from live_missions import BETWEEN, EAST, TOUR, WEST, Run, boat, mission, plan_of, seen

from adapters.console.console_view import NOTHING
from adapters.console.facts import Facts
from adapters.console.fold import take, time_of
from adapters.console.history import History
from adapters.console.sections import view_of
from adapters.live.batch import Saying
from adapters.plugin import LinkLost, LinkRestored, TakenOver
from adapters.recording.foxglove import OTHERS
from adapters.recording.mcap_files import McapReader, McapWriter
from adapters.recording.schemas import SCHEMAS
from adapters.recording.writing import Recorder
from bigactors.commands.console.recorded_history import rules_of
from bigactors.mission_lookup import digest_of

FLIGHT = f"""mission tour
{TOUR}
BigActor a hosted_at uav0 with_behavior {{
  control(MOVE_HOST_TO east0)
  observe(CHILDREN(east0))
  react {{ case obs => display(obs) send "there" to op }}
}}
BigActor op hosted_at gcs0 with_behavior {{
  react {{ case "there" => skip }}
  react {{ case "handover" => skip }}
  control(HAND uav0 TO gcs1)
}}
environment {{
  says "handover" to op at most 2 times
  says "status" to op at most 3 times
}}
live {{
  on broken assumption: continue
  FLY a within 100 s: continue
}}
"""
NOBODY = {"svg": None, "drawn": None}


class Tape:
    """A run that is recorded as it goes, in which the test is the world."""

    def __init__(self, path, text=FLIGHT, willing=True, **more):
        self.mission = mission(text)
        self.run = Run(plan_of(text, self.mission.precautions), willing)
        header = {
            "mission": "tour.mission",
            "text": text,
            "digest": digest_of(self.mission),
            "version": "0",
            "verified": True,
            "vehicles": {"uav0": "autopilot"},
            **more,
        }
        self.path = path
        self.ends, self.now = False, 0
        self.recorder = Recorder(path, header, 1000.0, self.mission.setting.kinds)

    def __enter__(self):
        return self

    def __exit__(self, *_error):
        if not self.ends:
            self.end(self.now)

    def end(self, now, reason="the mission has ended"):
        self.ends = True
        self.recorder.close(reason, 1000.0 + now)

    def turn(self, now, *heard, reports=(), sayings=()):
        """Let some arrivals and reports come, and a turn be made of them, `now` seconds after the beginning."""
        self.now = now
        now += 1000.0
        for each in heard:
            self.recorder.arrival(each, now)
        for report in reports:
            self.recorder.report(report, now)
        for report in self.run.accepted(now):
            self.recorder.report(report, now)
        said = [Saying(*each) if isinstance(each, tuple) else each for each in sayings]
        turn = self.run.turn(now, *heard, reports=reports, sayings=said)
        self.recorder.turn(turn, now, lambda _finding: ("deadlock_freedom",))
        return turn

    def history(self):
        """Return all that is recorded so far."""
        return read(self.path)

    def shown(self, at=None):
        """Return the sections that are shown, of now or of a time."""
        history = self.history()
        view = history.newest() if at is None else history.at(1000.0 + at).forward(1000.0 + at)
        return view.sections

    def card(self, at=None):
        """Return the vehicle's card, now or at a time."""
        return self.shown(at)["vehicles"]["uav0"]

    def actions(self):
        return list(self.shown()["actions"].values())


def read(path, **more):
    """Return the history of a recording, read to its end."""
    history = History(path, rules_of_once, **more)
    while history.read_on(0.01):
        pass
    return history


def uav(at, now):
    return seen("uav0", at, 1000.0 + now)


def eventful(path):
    """Record a run in which much happens, up to its end; return its tape."""
    tape = Tape(path)
    tape.turn(0, uav(WEST, 0), boat((37.04, -8.7), 1000.0))
    for k in range(1, 40):
        tape.turn(k, uav((37.01, -8.65 + k * 0.0005), k), boat(EAST, 1000.0 + k, f"mmsi{k % 7}"))
    tape.turn(41, reports=[LinkLost("uav0", 1041.0, 1039.0)])
    tape.turn(44, uav(BETWEEN, 44), reports=[LinkRestored("uav0", 1044.0)])
    tape.turn(50, sayings=[("op", "status"), ("op", "nonsense")])
    tape.turn(60, uav(EAST, 60))
    tape.turn(61, sayings=[("op", "handover")])
    tape.turn(62, uav(EAST, 62), reports=[TakenOver("uav0", 1062.0, "its pilot has taken over")])
    tape.end(63)
    return tape


def messages(path):
    return [message for message in McapReader(path).messages() if not message.topic.startswith(OTHERS)]


def folded(told, until=float("inf"), facts=None):
    """Fold messages, none of which is after a time, at one go: what every other way has to come to."""
    draft = (facts or Facts()).copy()
    for message in told:
        if time_of(draft, message) > until:
            break
        take(draft, message, rules_of_once)
    return draft


@cache
def _rules_of(text):
    return rules_of(dict(text))


def rules_of_once(run):
    """Elaborate a mission once for all folds."""
    return _rules_of(tuple((key, run[key]) for key in ("mission", "text", "folder") if key in run))


def shown(facts, now, head=None):
    return view_of(facts, now, head or facts, {}, NOTHING).sections


def plain(view):
    """Return the sections of a view without the picture, which is drawn when there is time."""
    bigraph = {key: value for key, value in view.sections["bigraph"].items() if key not in NOBODY}
    return {**view.sections, "bigraph": bigraph}


def written(path, run, told):
    """Write messages of topics that this run has not: as other versions do."""
    topics = dict.fromkeys((topic for topic, _, _ in told), ("x", {}))
    writer = McapWriter(path, {**topics, **SCHEMAS})
    writer.write("run", 1000.0, run)
    for topic, time, data in told:
        writer.write(topic, time, data)
    writer.flush()
    return writer


RUN = {
    "schema": "bigactors.run/1",
    "mission": "tour.mission",
    "text": FLIGHT,
    "digest": digest_of(mission(FLIGHT)),
    "version": "0",
    "verified": True,
    "vehicles": {"uav0": "autopilot"},
}


def told(path, *told, copied=()):
    """Return what is shown of a run in which messages are recorded after the first arrival; `copied` come before it."""
    arrival = {"plugin": "autopilot", "entity": "uav0", "kind": "UAV", "ring": [[370100000, -86500000]]}
    writer = written(path, RUN, [*copied, ("arrivals", 1001.0, arrival), *told])
    sections = read(path).newest().sections
    writer.close()
    return sections
