"""A property of runs that a reduction does not preserve is incomplete, and the others are decided."""

import pytest
from checked_missions import load
from replaying import assert_replays
from swarms import LOOKS, swarm

from checker import Engine, Outcome, Reduction, check

ROBOTS = swarm(
    LOOKS,
    rest="""check {
  reachable "both inside": actually robot0 in room0 and actually robot1 in room0
  ctl "each robot may be the first to ask": forall x: agents . EX EX pending OBS x
  ctl "each may be alone inside": forall u: Robot . EF (actually u in room0 and exists v: Robot . actually v in dock0)
  ltl "who has ended has ended": forall x: agents . [] (ended x -> [] ended x)
  ltl "inside at last" under weak fairness of agents, rules: <> actually robot0 in room0
  progress
  deadlock_freedom
}
""",
)
TWO_APART = """
signature standard
world {
  p0: Location = box (37.04, -8.59) (37.03, -8.60)
  p2: Location = box (37.00, -8.59) (36.99, -8.60)
  q0: Location = box (38.04, -8.59) (38.03, -8.60)
  q2: Location = box (38.00, -8.59) (37.99, -8.60)
  a0: UAV = point (38.035, -8.595)
  z0: UAV = point (37.035, -8.595)
}
BigActor a hosted_at a0 with_behavior {
  loop { control(MOVE_HOST_TO q2) observe(PARENT(HOST)) react { case o => control(MOVE_HOST_TO q0) } }
}
BigActor z hosted_at z0 with_behavior { control(MOVE_HOST_TO p2) }
check {
  ltl "z arrives" under weak fairness of agents, requests: <> actually z0 in p2
  ltl "z arrives, whoever is served": <> actually z0 in p2
  reachable "z is there": actually z0 in p2
}
"""


PRESERVED = ("z arrives, whoever is served",)


@pytest.mark.parametrize("engine", [Engine.REFERENCE, Engine.FAST])
@pytest.mark.parametrize(("text", "reduction"), [(ROBOTS, Reduction.SYMMETRY), (TWO_APART, Reduction.POR)])
def test_properties_that_are_not_preserved_are_incomplete_and_the_others_are_decided(text, reduction, engine):
    mission = load(text, "")
    reduced, whole = check(mission, engine=engine, reduce=[reduction]), check(mission, engine=engine)
    assert_replays(reduced)
    for found, right in zip(reduced.verdicts, whole.verdicts, strict=True):
        incomplete = found.property.is_of_runs and found.property.name not in PRESERVED
        assert found.outcome is (Outcome.INCOMPLETE if incomplete else right.outcome), found.property.name
        assert right.outcome is not Outcome.INCOMPLETE
