"""Instances of a control: all of a few, the first of too many."""

from bigactors import read_mission
from semantics.analysis.control_instances import MOST_INSTANCES, first_instances, instances

PROGRAM = read_mission(
    """
signature { kind Location contains UAV  kind UAV driven }
world {
  a0: Location = box (37.02, -8.64) (37.00, -8.66)
  u0: UAV = point (37.01, -8.65)
}
BigActor a hosted_at u0 with_behavior { control(MOVE u0 TO a0) }
"""
).initial.setting.program


def test_of_too_many_instances_the_first_are_still_looked_at():
    hosts = ["u0"] * MOST_INSTANCES
    assert len(instances(PROGRAM, "MOVE", (hosts, ["u0"], ["a0"]))) == MOST_INSTANCES
    assert instances(PROGRAM, "MOVE", (hosts, ["u0"], ["a0", "a0"])) is None
    assert len(list(first_instances(PROGRAM, "MOVE", (hosts, ["u0"], ["a0", "a0"])))) == MOST_INSTANCES
