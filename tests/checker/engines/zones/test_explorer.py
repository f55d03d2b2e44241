from time import monotonic

from checked_missions import load
from timed_missions import with_timing

from checker import Engine, Limits, explore
from checker.limits import GRACE, Bound, Interruption, Stop
from semantics.timing.intervals import Interval
from semantics.timing.timing import Timing

TEXT = """BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO south0) control(MOVE_HOST_TO north0) }
control timed"""


def test_who_wants_the_end_gets_it_while_it_learns_what_leads_from_a_location():
    start = with_timing(load(TEXT).initial, Timing(1_000, react=Interval(0, 1)))
    assert explore(start, engine=Engine.FAST).complete
    interruption = Interruption()
    interruption.wished = monotonic() - GRACE
    found = explore(start, engine=Engine.FAST, limits=Limits(interruption=interruption))
    assert (found.size, found.bounds) == (1, [Bound(Stop.INTERRUPTION)])
