"""Mistakes that a newcomer makes in what a mission says of times: each is told at its place, with what was meant."""

import pytest
from elaborating import elaborated, mistakes, shown
from text_tables import rows

from semantics.state.setting import Control
from specs.elaboration.variation import Variation

ORCHARD = """signature {
  kind Field contains Field, Drone, Pump
  kind Drone driven
  kind Pump
}
world {
  yard: Field = circle (41.152, -7.612) radius 150 m
  row: Field = box (41.170, -7.620) (41.166, -7.600)
  drone: Drone = point (41.152, -7.612) linked radio, control:pump
  pump: Pump = point (41.1521, -7.6121) linked radio, control:pump
}
def spray(place) = {
  control(MOVE_HOST_TO place)
  send "sprayed" to farmer
}
BigActor sprayer hosted_at drone with_behavior {
  spray(row)
}
BigActor farmer hosted_at pump with_behavior {
  react {
    case "sprayed" => skip
    after 30 min => skip
  }
}
environment { radio drops and returns }
control timed
timing {
  Drone flies at 8 m/s to 12 m/s
  drone lasts 25 min, restored in yard after 10 min
  agents react within 1 s
  sense takes 2 s to 5 s
  messages over radio takes 1 s to 2 s
}
check {
  endurance
  within 25 min "there": ended sprayer
  time "row": actually drone in row
}
"""
TOLD = r"""
Drone flies at ~> Drone moves at
    # moves | the duration of a flight follows from speeds: write flies at 18 m/s to 25 m/s
Drone flies at 8 m/s to 12 m/s ~> drone arrives within 2 min
    # arrives | the duration of a flight follows from speeds: write flies at 18 m/s to 25 m/s
12 m/s\n ~> 12 m/s, circles at 20 m\n  # at | leave it out
lasts 25 min, restored ~> lasts 25 min restored  # restored | write , restored in yard
yard after 10 min ~> yard within 10 min  # within | write after 10 min: it has to be there so long
lasts 25 ~> endurance 25  # endurance | write lasts 45 min, restored in airfield0 after 20 min
lasts 25 min ~> lasts 25 minutes  # minutes | write 25 min
at 8 m/s ~> at 8 mps  # mps | write 8 m/s
endurance\n ~> endurance 25 min\n
    # 25 | its times stand in timing { uav0 lasts 45 min, restored in base0 after 20 min }
in yard after 10 min ~> in 10 min  # 10 | write restored in base0 after 10 min
agents react ~> reaction  # reaction | bigActors have one bound together: agents react within 1 s
messages over radio takes ~> message delay  # message | write messages over wifi within 5 s, or messages on one host
control timed ~> control timing  # timing | write control timed
agents react within 1 s ~> pump vanishes at 1 h  # at | write after 1 h, within 1 h
lasts 25 ~> lasts for 25  # for | write lasts 5 min
lasts 25 min ~> lasts 1 h 25 min  # 25 | write 85 min
lasts 25 min ~> lasts "25 min"  # "25 min" | write lasts 5 min
agents react ~> sprayer reacts  # reacts | bigActors have one bound together: agents react within 1 s
agents react ~> BigActors react  # react | bigActors have one bound together: agents react within 1 s
agents react within 1 s ~> react within 1 s  # react | bigActors have one bound together: agents react within 1 s
agents react within 1 s ~> agents take at most 1 s  # most | write agents react within 5 s
sense takes 2 s to 5 s ~> sense takes at most 5 s  # most | write sense within 5 s
sense takes 2 s to 5 s ~> sense takes up to 5 s  # up | write sense within 5 s
sense takes 2 s to ~> sense takes between 2 s and  # between | write takes 2 s to 5 s
sense takes ~> observe takes  # observe | write sense within 5 s
sense takes ~> sensing takes  # sensing | write sense within 5 s
messages over radio ~> radio  # radio | write messages over radio within 5 s
1 s to 2 s ~> 1 s, 2 s  # , | write 1 s to 2 s
messages over radio ~> send  # send | write messages over wifi within 5 s, or messages on one host
sense takes ~> spray takes
    # spray | the duration of a behaviour follows from its steps: agents react within 1 s, sense within 5 s
sense takes ~> FLY takes  # FLY | give its speed: UAV flies at 18 m/s to 25 m/s
within 1 s ~> within 400 ms  # 400 ms | round it, or give timing a shorter tick: tick 200 ms
and returns } ~> and returns within 5 min }
    # within | the duration of a change stands in timing { ... }: wifi drops and returns within 5 min
and returns } ~> at most every 5 min }
    # at | the duration of a change stands in timing { ... }: wifi drops and returns within 5 min
after 30 min => ~> case after 30 min =>  # case | write after 10 min => statements
after 30 min => ~> after (30 min) =>  # ( | write after 5 min
within 25 min "there" ~> within "there" 25 min  # "there" | the duration comes first: within 25 min "there": formula
25 min "there": ~> 25 min:  # : | write a name in double quotes before the colon: "name": formula
time "row": ~> invariant:  # : | write a name in double quotes before the colon: "name": formula
within 25 min "there" ~> before 25 min "there"  # before | write within 5 min "name": formula
time "row" ~> earliest "row"  # earliest | write time "name": formula
endurance ~> battery  # battery | write endurance
ended sprayer ~> always ended sprayer  # always ended sprayer | write within 5 min "name": F, or F leads to G
control timed ~> control time  # time | write atomic or timed
control timed\n ~>   # timing | write: control timed
"""


def test_control_that_takes_no_time_is_refused_by_who_asked_for_it():
    (found,) = mistakes(ORCHARD, variation=Variation(control=Control.ATOMIC))
    assert found.hint == "the mission sets it: leave --control atomic out"


def test_a_channel_may_be_declared_behind_what_is_linked_to_it():
    elaborated(ORCHARD.replace("control:pump\n}", "control:pump\n  channel radio\n}"))


@pytest.mark.parametrize(("change", "said"), list(rows(TOLD)))
def test_a_mistake_about_times_is_told_with_what_was_meant(change, said):
    old, new = change.split(" ~> ")
    assert old in ORCHARD
    assert [f"{place} | {hint}" for place, _, hint in shown(ORCHARD.replace(old, new, 1))] == [said]
