"""Missions with times, drawn at random: what `semantics.strategies` draws, and a timing for it."""

from hypothesis import strategies as st

from semantics.environment import Appears, Drifts, Drops, Leaves, Says, Vanishes
from semantics.state.configuration import Configuration
from semantics.state.setting import Setting
from semantics.strategies import initial_configurations
from semantics.timing.flight_history import remembered_at_first, vehicles
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
    driven = vehicles(setting)
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
