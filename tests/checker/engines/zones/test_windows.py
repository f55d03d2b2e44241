"""Many appearances in one mission, each with its times."""

import pytest
from checked_missions import load
from timed_reports import assert_alike

from checker import Engine, ZoneClock, check
from checker.engines.contract import WindowsError
from checker.engines.zones.timed_automaton_of import MOST_WINDOWS


def appearing(count):
    """Return a mission in which boats appear one after the other, a second apart."""
    boats = range(count)
    return load(
        f"""
signature {{ kind Sea contains Boat, Station kind Boat kind Station }}
world {{
  sea0: Sea = box (0.0, 0.0) (0.001, 0.001)
  gcs0: Station = point (0.0009, 0.0001)
  {" ".join(f"boat{i}: Boat absent" for i in boats)}
}}
BigActor a hosted_at gcs0 with_behavior {{ react {{ after 3 s => skip }} }}
environment {{ {" ".join(f"boat{i} appears at sea0" for i in boats)} }}
control timed
timing {{
  agents react within 0 s
  {" ".join(f"boat{i} appears after {i + 1} s, within {i + 1} s" for i in boats)}
}}
check {{
  deadlock_freedom
  time "all are there": present boat{count - 1}
  within {count} s "in time": present boat{count - 1}
  within {count - 1} s "too soon": present boat{count - 1}
}}
""",
        "",
    )


@pytest.mark.parametrize("clock", ZoneClock)
def test_a_location_may_have_more_deadlines_than_clocks(clock):
    mission = appearing(8)
    right = check(mission, engine=Engine.REFERENCE)
    assert right.verdicts["all are there"].note == "at 0:08 at the earliest, at 0:08 at the latest"
    assert_alike(right, check(mission, engine=Engine.FAST, clock=clock))


def test_too_many_times_of_appearances_are_refused():
    with pytest.raises(WindowsError, match="40 appearances and disappearances with times are more than the"):
        check(appearing(MOST_WINDOWS + 1), engine=Engine.FAST)
