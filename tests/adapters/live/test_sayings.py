"""What people say to a live run: messages to bigActors, and where a vehicle is heard."""

import pytest
from live_missions import TOUR, WEST, Run, plan_of, seen

from adapters.live.batch import GivingBack, Saying
from adapters.plugin import LinkLost, LinkRestored, Rebind, TakenOver
from semantics.live_policy import Fallback, LivePolicy

GOES_ON = LivePolicy(Fallback.CONTINUE)
TALK = (
    TOUR
    + """
BigActor op hosted_at gcs0 with_behavior { loop { react { case "go" => display("gone") } } }
environment { says "go" to op at most once }
"""
)


def test_what_the_mission_says_may_be_said_is_heard_and_not_too_often():
    run = Run(plan_of(TALK))
    run.turn(0.0)
    run.turn(1.0, sayings=[Saying("op", "go"), Saying("op", "go"), Saying("nobody", "stop")])
    assert run.rules == ["say", "rcv_msg", "fun"]
    assert [bool(answer.refusal) for answer in run.answers] == [False, True, True]
    assert run.shown == ["gone"]


def test_a_member_of_a_family_is_spoken_to_by_its_name():
    family = """
    BigActor op[i] for g in Station hosted_at g with_behavior { loop { react { case ("go", way) => display(way) } } }
    environment { says ("go", [gcs1, gcs0, gcs1]) to op[gcs1] }
    """
    run = Run(plan_of(TOUR + family))
    run.turn(0.0)
    said = "(go, [gcs1, gcs0, gcs1])"
    run.turn(1.0, sayings=[Saying("op[gcs1]", said), Saying("op[1]", said), Saying("op", said)])
    assert run.rules == ["say", "rcv_msg", "fun"]
    assert run.shown == ["[gcs1, gcs0, gcs1]"]
    assert [answer.refusal.partition(";")[0] for answer in run.answers] == [
        "",
        "there is no bigActor 'op[1]'",
        "there is no bigActor 'op'",
    ]


@pytest.mark.parametrize(
    ("said", "heard"),
    [("gcs1", ["gcs1"]), ('"gcs1"', ["a text"]), ("stop", ["a stop"]), ('"stop"', ["a stop"])],
)
def test_an_operator_types_quotes_only_where_a_name_is_said_too(said, heard):
    talk = """
    BigActor op hosted_at gcs0 with_behavior { loop { react {
      case "gcs1" => display("a text") case "stop" => display("a stop") case m: Message => display(m)
    } } }
    environment { says "gcs1" to op says gcs1 to op says "stop" to op }
    """
    run = Run(plan_of(TOUR + talk))
    run.turn(0.0)
    run.turn(1.0, sayings=[Saying("op", "what?"), Saying("op", said)])
    assert run.answers[0].refusal.endswith('permitted now: "gcs1" to op, gcs1 to op, stop to op')
    assert run.shown == heard


def test_an_operator_says_that_a_vehicle_is_heard_from_another_address():
    run = Run(plan_of(TOUR, GOES_ON))
    run.turn(0.0, reports=[LinkLost("uav0", 0.0, -5.0)])
    for number, at in enumerate(("127.0.0.1:5555", "home", "[::1]:99", "::1", "127.0.0.1:65536")):
        run.turn(float(number), sayings=[GivingBack("uav0", at)])
    no = "' is no HOST:PORT with HOST as a number, such as 192.168.1.7:14555 or [fd00::7]:14555"
    assert run.refusals == [
        "", f"'home{no}", "", f"'::1{no}", f"'127.0.0.1:65536{no}",
    ]  # fmt: skip
    assert run.commands == [
        Rebind("operator-1", "uav0", "127.0.0.1:5555"),
        Rebind("operator-2", "uav0", "[::1]:99"),
    ]
    assert [str(step.transition.label) for step in run.steps] == ["⟨env : uav0 is off control:gcs0⟩"]


def test_who_was_taken_over_stays_so_though_an_operator_says_where_it_is():
    run = Run(plan_of(TOUR, GOES_ON))
    run.turn(0.0, reports=[TakenOver("uav0", 0.0, "it is in RTL"), LinkLost("uav0", 0.0, -5.0)])
    run.turn(1.0, sayings=[GivingBack("uav0", "127.0.0.1:5555")])
    assert run.state.overrides.taken == {"uav0": "it is in RTL"}
    assert run.commands == [Rebind("operator-1", "uav0", "127.0.0.1:5555")]


def test_a_vehicle_has_no_mailbox():
    run = Run(plan_of(TOUR))
    run.turn(0.0, sayings=[Saying("uav0", "go")])
    (answer,) = run.answers
    assert answer.refusal.startswith(
        "there is no bigActor 'uav0', which is a vehicle; the mission does not permit"
    )


def test_a_vehicle_is_believed_elsewhere_only_while_its_link_is_lost():
    run = Run(plan_of(TOUR, GOES_ON))
    said = GivingBack("uav0", "127.0.0.1:5555")
    run.turn(1.0, seen("uav0", WEST, 1.0), sayings=[said])
    run.turn(9.0, reports=[LinkLost("uav0", 9.0, 1.0)], sayings=[said])
    run.turn(10.0, reports=[LinkRestored("uav0", 10.0)], sayings=[said])
    no = "the link to uav0 is not lost; another address is accepted once the known one is silent"
    assert run.refusals == [no, "", no]
    assert run.commands == [Rebind("operator-1", "uav0", "127.0.0.1:5555")]
