"""The fast explorer: it visits what the reference explorer visits, in the same order, and stops where that stops."""

from checked_missions import load, timeless, visited
from hypothesis import given
from scale import IS_WHOLE, crossed, examples
from shipped import UNTIMED

from checker import Engine, Limits, Outcome, check, explore
from checker.properties.temporal.decide import kept_graph
from semantics import Control, Scheduler, hypothesis_strategies
from semantics.races.monitor import monitored
from specs.elaboration import Variation, load_mission

FEW, CROWDED = Limits(configurations=400 if IS_WHOLE else 250), Limits(configurations=100, pending=1)

VARIATIONS = {
    "as written": Variation(),
    "timed": Variation(control=Control.TIMED),
    "unordered": Variation(scheduler=Scheduler.UNORDERED),
    "fcfs timed": Variation(scheduler=Scheduler.FCFS, control=Control.TIMED),
    "monitored, or crowded": None,
}

ENGINES = (Engine.REFERENCE, Engine.FAST)
"""Those that give the same numbers to configurations; Ray's are in `tests/checker/engines/cluster`."""


def reported(mission, limits=None):
    """Return the report that both engines come to."""
    one, other = (timeless(check(mission, limits=limits, engine=engine)) for engine in ENGINES)
    assert one == other
    return one


def explored(initial, engine, limits=FEW):
    """Return what was visited in which order, and the edges."""
    found = explore(initial, limits=limits, engine=engine, edges=True)
    graph = kept_graph(found)
    return visited(found), graph.starts.tolist(), graph.targets.tolist(), actions(graph), graph.open.tolist()


def actions(graph):
    """Return who does what, edge by edge: the fast engine doesn't say which observation is received."""
    labels = [(each.rule, each.agent) for each in graph.labels]
    return [labels[action] for action in graph.actions]


@crossed(UNTIMED, VARIATIONS)
def test_a_mission_is_explored_alike_by_both_engines(name, variation):
    initial = load_mission(name, variation or Variation()).initial
    initial = initial if variation else monitored(initial)
    assert explored(initial, Engine.FAST) == explored(initial, Engine.REFERENCE)


@given(hypothesis_strategies.initial_configurations())
@examples(100)
def test_generated_missions_are_explored_alike_by_both_engines(initial):
    limits = Limits(configurations=60)
    assert explored(initial, Engine.FAST, limits) == explored(initial, Engine.REFERENCE, limits)


@crossed(UNTIMED, VARIATIONS)
def test_both_engines_come_to_the_same_report(name, variation):
    mission = load_mission(name, variation or Variation())
    reported(mission, FEW if variation else CROWDED)


@given(hypothesis_strategies.missions())
@examples(60)
def test_generated_missions_are_judged_alike_by_both_engines(mission):
    reported(mission, Limits(configurations=60))


ROUTES = """
BigActor a hosted_at uav0 with_behavior {
  for place in [gate0, north0, gate0] {
    control(MOVE_HOST_TO place)
    observe(PARENT(uav1))
    react { case o => send [o, place] to b }
  }
}
BigActor b hosted_at uav1 with_behavior {
  let way = []
  loop {
    react {
      case m: Message =>
        way = [element(m, 1)] + (way - [gate0])
        if gate0 in way and uav1 in element(m, 0) { control(MOVE_HOST_TO gate0) }
    }
  }
}
check { race_freedom local_consistency reachable "back": b.way == [gate0, north0] }
"""


def test_routes_with_observations_in_them_are_judged_alike_by_both_engines():
    report = reported(load(ROUTES))
    assert (report.configurations, report.verdicts[2].outcome) == (310, Outcome.HOLDS)


def test_the_rules_are_run_far_less_often_than_there_are_transitions():
    found = explore(load_mission("rendezvous").initial, engine=Engine.FAST)
    assert (len(found.configurations), found.transitions) == (18_051, 73_275)
    assert found.rule_runs is not None
    assert found.rule_runs < 600
