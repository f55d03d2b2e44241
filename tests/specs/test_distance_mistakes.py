"""Mistakes that a newcomer makes in claims about places and distances, and the remedy of each."""

import pytest
from elaborating import shown
from text_tables import rows

SHORE = """signature {
  kind Bay contains Boat
  kind Boat driven
}
world {
  bay0: Bay = circle (37.1, -8.64) radius 300 m
  bay1: Bay = circle (37.1, -8.56) radius 300 m
  boat0: Boat = point (37.1, -8.641)
}
BigActor sailor hosted_at boat0 with_behavior {
  control(MOVE_HOST_TO bay1)
}
environment { boat0 arrives }
control timed
check {
  invariant "near": CLAIM
}
"""
CLAIMS = r"""
boat0 at most 25 km from bay0  # most | write boat0 within 25 km of bay0
boat0 less than 2 km from bay0  # less | write boat0 within 2 km of bay0
boat0 closer than 2 NM to bay0  # closer | write boat0 within 3704 m of bay0
boat0 farther than 2 km from bay0  # farther | write boat0 at least 2 km from bay0
boat0 at least 2 km away from bay0  # away | leave it out
boat0 at least 500 ft from bay0  # ft | write 152.4 m
boat0 not in bay0  # not | write not boat0 in bay0
actually boat0 not in bay0  # not | write not actually boat0 in bay0
possibly boat0 not in bay0
    # not | write not possibly boat0 in bay0: it never is; or not surely boat0 in bay0: it may be elsewhere
actually boat0 over bay0  # over | write in: uav0 in place0
if boat0 in bay0 then boat0 in bay1  # if | an implication is written F -> G
boat0 not within 5 km of bay0  # not | write not boat0 within ...
never actually boat0 in bay0
    # never | write not actually boat0 ...: an invariant is true at all times; in ltl, always not actually boat0 ...
not never boat0 in bay0
    # not never | write boat0 in ..., without both: in reachable, it is true at some time
within 5 min boat0 in bay1  # within | a deadline is a property: within 5 min "name": formula
"""


ELSEWHERE = r"""
boat0 arrives ~> boat0 lands  # lands | write arrives: its flights end
invariant "near": CLAIM ~> no races  # no | write race_freedom or deadlock_freedom
(37.1, -8.641) ~> (37.1, -8.641) linked radio wifi  # wifi | separate channels by commas
control timed ~> control timed believes { boat0 not known }  # not | write unknown: boat0 unknown
"""


@pytest.mark.parametrize(("change", "remedy"), list(rows(ELSEWHERE)))
def test_a_mistake_beside_the_claims_has_its_remedy(change, remedy):
    was, becomes = change.split(" ~> ")
    text = SHORE.replace(was, becomes).replace("CLAIM", "boat0 in bay0")
    assert [f"{place} | {hint}" for place, _, hint in shown(text)] == [remedy]


@pytest.mark.parametrize(("claim", "remedy"), list(rows(CLAIMS)))
def test_a_mistake_is_marked_at_its_word_with_its_remedy(claim, remedy):
    assert [f"{place} | {hint}" for place, _, hint in shown(SHORE.replace("CLAIM", claim))] == [remedy]
