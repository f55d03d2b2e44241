"""Searches through small automata: layers, what is dropped, and the first run."""

from checker.engines.zones import earliest_dates
from checker.engines.zones.first_run import first_run
from checker.engines.zones.shortest_run import steps_left
from checker.engines.zones.timed_automaton import Constraint, Edge, Location, TimedAutomaton
from checker.engines.zones.zone_search import Search

STANDS = ((0, -1),)
"""No time passes."""


def searched(ways):
    """Search an automaton that goes from its first location to its second one by some tests, and on from there."""
    automaton = TimedAutomaton()
    clock = automaton.clock(9, 9)
    first, second, third = (automaton.add(Location((clock,), ends)) for ends in ((), STANDS, STANDS))
    automaton.leave(first, [Edge(step, tests, second, (1,)) for step, tests in enumerate(ways)])
    automaton.leave(second, [Edge(0, (), third, (1,))])
    automaton.leave(third, [])
    search = Search(automaton, first, (0,))
    search.finish(lambda: None)
    return search


def late(least):
    """Return what the clock has to show in the last location."""
    return lambda place: (
        [earliest_dates.tested(earliest_dates.whole(1), [Constraint(1, least)])] if place == 2 else []
    )


def test_what_another_zone_of_its_layer_holds_is_not_followed():
    search = searched([(Constraint(1, 0, 2),), ()])  # a clock of at most 2, then any
    assert [place for place, _ in search] == [0, 1, 2]
    assert search.layers[:-1] == [0, 1, 2]
    assert (search.followed, search.deepest) == (3, 2)


def test_what_no_other_zone_holds_is_followed():
    search = searched([(Constraint(1, 0, 2),), (Constraint(1, 5, 7),)])
    assert [place for place, _ in search] == [0, 1, 1, 2, 2]


def test_the_first_run_may_go_by_what_was_dropped():
    search = searched([(Constraint(1, 0, 2),), ()])
    runs = [first_run(search, late(least)).run() for least in (0, 2, 3)]
    assert [(run.steps, run.dates) for run in runs] == [((0, 0), (0, 0)), ((0, 0), (2, 2)), ((1, 0), (3, 3))]
    assert first_run(searched([(Constraint(1, 0, 2),)]), late(3)) is None


def test_the_steps_that_are_left_are_counted_backwards():
    automaton = searched([()]).automaton
    assert steps_left(automaton, [2]).tolist() == [2, 1, 0]
    assert steps_left(automaton, [0]).tolist()[0] == 0
