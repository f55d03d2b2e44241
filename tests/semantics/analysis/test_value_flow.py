"""The value flow of a mission bounds every run, from its first configuration and from any later one."""

from itertools import islice

import pytest
from elaborating import elaborated
from shipped import ALL, LOADED

from semantics.analysis.overapproximation import Overapproximation
from semantics.analysis.value_flow import ValueFlow
from semantics.behaviours.expressions import Variable
from semantics.behaviours.statements import Assign, ControlBy, Send
from semantics.successors import successors

LATER = 12
"""The number of a later configuration from which the value flow is asked too."""


def visited(first):
    """Yield configurations, breadth first."""
    seen, waiting = {first}, [first]
    for c in waiting:  # it grows meanwhile
        yield c
        new = [step.target for step in successors(c) if step.target not in seen]
        seen.update(new)
        waiting += dict.fromkeys(new)


def outside(flow, c):
    """Yield all of a configuration's agents that the value flow does not expect there."""
    fits = flow.vocabulary_of(c.setting).fits
    for a in c.alpha.names():
        code, host = set(c.alpha.code(a)) <= flow[a].statements, c.alpha.host(a) in flow.hosts(a)
        mail = all(fits(message, flow.messages(a)) for message in c.alpha.mailbox(a))
        store = all(fits(value, flow.variable(a, name)) for name, value in c.alpha.store(a))
        if not (code and host and mail and store):
            yield a, code, host, mail, store


@pytest.mark.parametrize("name", ALL)
def test_all_that_a_shipped_mission_comes_to_is_in_its_value_flow(name):
    first = LOADED[name].initial
    later = list(islice(visited(first), LATER))[-1]
    for start in (first, later):
        flow = ValueFlow(first.setting, Overapproximation(start))
        assert [each for c in islice(visited(start), 60) for each in outside(flow, c)] == []


TEXT = """
signature { kind Location contains UAV kind UAV driven }
world {
  a0: Location = box (37.10, -8.80) (37.00, -8.70)
  b0: Location = box (37.10, -8.60) (37.00, -8.50)
  uav0: UAV = point (37.05, -8.75) linked radio
  uav1: UAV = point (37.05, -8.55) linked radio
}
BigActor first hosted_at uav0 with_behavior { send ("to", a0) to second }
BigActor second hosted_at uav1 with_behavior {
  react { case ("to", place) => control(MOVE_HOST_TO place) }
  observe(CHILDREN(a0))
  react { case seen: Observation => for each in seen of UAV { let last = each } }
  send ("to", b0) to first
}
"""


def test_a_variable_holds_what_is_sent_to_its_agent_and_the_members_of_what_it_sees():
    first = elaborated(TEXT).initial
    flow = ValueFlow(first.setting, Overapproximation(first))
    statements = first.setting.program.statements
    (move,) = (each for each in statements if isinstance(each, ControlBy))
    (last,) = (each for each in statements if isinstance(each, Assign))
    assert flow.named_entities("second", move.arguments[0]) == ("a0",)
    assert flow.named_entities("second", Variable(last.variable)) == ("uav0", "uav1")
    assert [str(each.moves) for each in flow.reactions("second", move)] == ["(('uav1', 'a0'),)"]
    there = [each for each in statements if isinstance(each, Send)]
    assert [flow.receivers("first", each.to) for each in there] == [("second",), ("first",)]
