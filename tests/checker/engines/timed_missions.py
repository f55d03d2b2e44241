"""Missions with times, drawn at random: generated or small ones, each with a timing."""

from dataclasses import replace

from checked_missions import load
from hypothesis import strategies as st

from semantics.environment import Appears, Drifts, Drops, Leaves, Says, Vanishes
from semantics.hypothesis_strategies import initial_configurations
from semantics.properties.kinds import PropertyKind
from semantics.properties.property import Property
from semantics.properties.propositions import Inside
from semantics.state.configuration import Configuration
from semantics.state.setting import Setting
from semantics.timing.flight_history import remembered_at_first
from semantics.timing.intervals import ANY_TIME, Interval
from semantics.timing.timing import (
    ONE_HOST,
    ClauseTimes,
    Endurance,
    Every,
    Motion,
    Sayable,
    Timing,
    Window,
)

SMALL = st.integers(0, 2)


@st.composite
def intervals(draw: st.DrawFn) -> Interval:
    """Yield intervals of a few ticks, some without an end."""
    lo = draw(SMALL)
    return Interval(lo, draw(st.sampled_from([lo, lo + 1, lo + 2, None])))


@st.composite
def timings(draw: st.DrawFn, setting: Setting, tick: int = 1000) -> Timing:
    """Yield timings of a setting."""
    named = {name: draw(intervals()) for name in ("HAND", "PUT", "migrate", "spawn") if draw(st.booleans())}
    driven = setting.driven()
    places = tuple(sorted(set(setting.kinds) - set(driven)))
    endurances = {
        name: Endurance(draw(st.integers(0, 3)), draw(st.sampled_from([(), places])), draw(SMALL))
        for name in driven[:1]
        if draw(st.booleans())
    }
    motions = {name: Motion((40.0, 60.0)) for name in driven if draw(st.booleans())}
    react = draw(st.sampled_from([Interval(0, 0), Interval(0, 1), Interval(0, 2), ANY_TIME]))
    channels = ("mesh", "wifi", ONE_HOST)
    return Timing(
        tick,
        tuple(sorted(motions.items())),
        tuple(sorted(endurances.items())),
        react,
        draw(intervals()),
        tuple(sorted((name, draw(intervals())) for name in channels if draw(st.booleans()))),
        tuple(sorted(named.items())),
        tuple(draw(clause_times(each)) for each in setting.environment),
    )


@st.composite
def alike_timings(draw: st.DrawFn, setting: Setting) -> Timing:
    """Yield timings, most of them the same for robots that are alike."""
    timing = draw(timings(setting, 60_000))
    driven = setting.driven()
    motions, lasting = dict(timing.motions), dict(timing.endurances)
    if draw(st.integers(0, 5)):
        motions = dict.fromkeys(driven, Motion((40.0, 60.0)))
        places = draw(st.sampled_from([(), ("dock0",), ("dock0", "room0")]))
        one = Endurance(draw(st.integers(0, 6)), places, draw(st.integers(0, 2)))
        lasting = dict.fromkeys(driven, one) if draw(st.booleans()) else {}
    clauses = list(timing.clauses)
    for number, clause in enumerate(setting.environment if draw(st.integers(0, 5)) else ()):
        first = next(at for at, each in enumerate(setting.environment) if type(each) is type(clause))
        clauses[number] = clauses[first]
    return replace(
        timing,
        motions=tuple(sorted(motions.items())),
        endurances=tuple(sorted(lasting.items())),
        clauses=tuple(clauses),
    )


@st.composite
def clause_times(draw: st.DrawFn, clause: object) -> ClauseTimes:
    """Yield the times of a clause of the environment, or none."""
    if draw(st.booleans()) and draw(st.booleans()):
        return ClauseTimes()
    after = draw(SMALL)
    until = draw(st.none() | st.integers(after, after + 2))
    match clause:
        case Drifts():
            return ClauseTimes(Every(draw(st.integers(1, 3))))
        case Drops() | Leaves():
            returns = draw(st.none() | SMALL) if clause.returns else None
            return ClauseTimes(Every(draw(st.integers(1, 3))), returns)
        case Appears() | Vanishes():
            return ClauseTimes(Window(after, until))
        case Says():
            return ClauseTimes(Sayable(after, until))
        case _:
            return ClauseTimes()


@st.composite
def timed_missions(draw: st.DrawFn) -> Configuration:
    """Yield first configurations of missions that say how long things take."""
    return with_timing(
        c := draw(initial_configurations()), draw(timings(c.setting, draw(st.sampled_from([1000, 60_000]))))
    )


def with_timing(c: Configuration, timing: Timing) -> Configuration:
    """Return the first configuration of the same mission with times."""
    setting = c.setting.with_(timing=timing)
    return Configuration(setting, c.state).with_(remembered_at_first(setting))


FLIGHT = (
    "BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO south0) }\ncontrol timed\nscheduler fcfs"
)
ANSWERS = """
BigActor a hosted_at gcs0 with_behavior { observe(PARENT(uav0)) react { case obs => send("seen", b) } }
BigActor b hosted_at gcs1 with_behavior { react { case "seen" => } }
"""


PROGRAMS = [
    'BigActor a hosted_at gcs0 with_behavior { loop { send("on", a) react { case "on" => } } }',
    """
    BigActor a hosted_at gcs0 with_behavior { loop { send("on", b) react { case "off" => } } }
    BigActor b hosted_at gcs0 with_behavior { loop { react { case "on" => send("off", a) } } }""",
    """
    BigActor a hosted_at gcs0 with_behavior { react { case "go" => loop { send("on", a) react { case "on" => } } } }
    environment { someone says "go" to a }""",
    """
    BigActor a hosted_at gcs0 with_behavior { loop { observe(PARENT(uav0)) react { case obs => } } }
    environment { mesh drops and returns }""",
    """
    BigActor a hosted_at gcs0 with_behavior { control(HAND uav0 TO gcs1) }
    BigActor b hosted_at gcs0 with_behavior { react { case "go" => control(HAND uav0 TO gcs2) } }
    environment { someone says "go" to b }""",
    """
    BigActor a hosted_at gcs0 with_behavior { control(HAND uav0 TO gcs1) control(HAND uav0 TO gcs2) }
    BigActor b hosted_at gcs0 with_behavior { observe(ALL) react { case obs => control(HAND uav0 TO gcs2) } }""",
    ANSWERS,
    f"{FLIGHT}\nenvironment {{ drifter0 vanishes }}",
]
"""Agents that may stop time, that race, that fly and that answer."""


@st.composite
def timed_programs(draw):
    c = load(draw(st.sampled_from(PROGRAMS))).initial
    timing = draw(timings(c.setting, draw(st.sampled_from([1000, 60_000]))))
    return with_timing(c, replace(timing, **ZEROS) if draw(st.booleans()) else timing)


ZEROS = {"react": Interval(0, 0), "sense": Interval(0, 0), "messages": (("", Interval(0, 0)),)}


SOUTH = Inside("uav0", "south0", actually=True)


def within(bound, formula=SOUTH, then=None):
    return Property(PropertyKind.WITHIN, "within", formula, bound=bound, then=then)
