"""What autopilots and other languages write is refused once, where it stands, with what to write here."""

import pytest
from elaborating import elaborated, shown
from text_tables import rows

MISSION = """mission m
signature { kind Cell kind UAV driven kind Spill }
world {
  base: Cell = box (37.1, -8.7) (37.0, -8.6)
  north: Cell = box (37.2, -8.7) (37.1, -8.6)
  uav0: UAV = point (37.05, -8.65) linked wifi
  spill: Spill = point (37.06, -8.65)
  channel wifi
}
environment { spill drifts within base }
def go(a) = {
  skip
}
BigActor desk hosted_at uav0 with_behavior { skip }
BigActor b hosted_at uav0 with_behavior { go(base) }
check { deadlock_freedom }
"""


REFUSED = r"""
wait(10 min)  # wait | not a word of the language here | react { after 10 min => ... }
sleep(5 s)  # sleep | not a word of the language here | react { after 10 min => ... }
takeoff(50 m)  # takeoff | not a word of the language here | takes off and lands as its flights need
land()  # land | unknown behaviour 'land' | takes off and lands as its flights need
go(50 m)  # m | is no part of a value | units stand in after 10 min
control(LAND)  # LAND | is no control action | takes off and lands as its flights need
control(TAKEOFF 50 m)  # TAKEOFF | is no control action | takes off and lands
control(RTL)  # RTL | is no control action | an operator orders that in flight
/* a\n   b { */ skip  # /* a\n   b { */ | '/*' begins no comment here | write // before each line
/* open\n  skip  # /* open | '/*' begins no comment here | write // before each line
send "found", spill to desk  # , | a message is one value | send ("found", spill) to desk
send "a", b, base to desk  # , | a message is one value | send ("a", b, base) to desk
match a { case base => skip default => skip }  # default | not a word of | write case _ => statements
control(MOVE_HOST_TO (37.0, -8.7))  # 37.0 | names an entity, and here are coordinates | declare target
control(MOVE_HOST_TO point (37.0, -8.7))  # 37.0 | names an entity | declare target
control(MOVE uav0 TO (37.0, -8.7))  # 37.0 | names an entity | declare target
drifts within base ~> drifts 3 km in base  # 3 | no distance and no direction | drifts within base
drifts within base ~> drifts 3 km  # 3 | no distance and no direction | drifts within place
spill drifts within base ~> operator says "go"  # operator | expected 'someone' | someone says "go"
spill: Spill ~> spill-1: Spill  # spill-1 | '-' is not part of names | write spill_1
BigActor b hosted_at ~> BigActor b-north hosted_at  # b-north | '-' is not part of names | write b_north
def go(a) ~> def go(to)  # to | is a word of the language and cannot be a name | another name
def go(a) ~> def go(a, in)  # in | is a word of the language and cannot be a name | another name
"""


def told(was, now):
    assert was in MISSION
    return shown(MISSION.replace(was, now))


@pytest.mark.parametrize(("written", "said"), list(rows(REFUSED)))
def test_what_others_write_is_refused_once_with_what_to_write(written, said):
    was, _, now = written.rpartition(" ~> ")
    place, message, remedy = said.split(" | ")
    found, *others = told(was, now) if was else told("  skip\n", f"  {now}\n")
    assert found[0] == place
    assert message in found[1]
    assert remedy in found[2]
    assert was or not others


def test_a_subtraction_is_no_hyphen():
    elaborated(MISSION.replace("  skip\n", "  let n = 3\n  n = n-1\n"))


def test_many_comments_that_do_not_end_are_read_in_linear_time():
    (_, said, _), *_ = told("  skip\n", "/*" * 20_000)
    assert said == "'/*' begins no comment here"
