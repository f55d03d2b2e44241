"""Control races and stale-observation races (semantics.md, check 2), each of their clauses."""

from pathlib import Path
from random import Random

import pytest
from checked_missions import WORLD, kinds, load, moves, rules_of, start, verdict, violation
from hypothesis import event, given, reject
from hypothesis import strategies as st
from mission_texts import missions
from scale import examples
from stale_by_definition import Judge, chains, companies, text_of

from checker import Engine, Limits, Trace, check, explore
from checker.properties.findings import Collected
from checker.properties.races import ControlRaces, StaleObservationRaces, asked_in_words, is_stale
from checker.properties.stale_steps import stale_steps
from checker.verdicts import Outcome
from semantics import extension
from semantics.behaviours import stepping
from semantics.behaviours.expressions import OPERATORS
from semantics.behaviours.observations import Nodes, Observation
from semantics.races import monitor
from semantics.races.monitor import monitored
from semantics.races.provenance import ANY, EVERYTHING, MEMBERS, SIZE, Dependency
from semantics.races.relevance import SLOTS
from semantics.successors import expand
from specs import MissionError
from specs.elaboration import load_mission

ROOT = Path(__file__).parents[3]
MISSIONS = sorted(
    (*ROOT.glob("specs/missions/*.mission"), *ROOT.glob("tests/corpus/violated/stale*.mission"))
)

STALE = "stale-observation race"
ENTERS = moves("gate0", "b", "uav1")
"""Enters the gate without a look."""


def control_races(text):
    """Return the first message of a control race, None where there is none; ownership is not asked."""
    looked = ControlRaces()
    explore(load(text).initial, (looked,))
    first = next(iter(looked.collected.first.values()), None)
    return first and first.message


def stale(text, world=WORLD):
    """Return whose controls are found to rest on a stale observation; ownership is not asked."""
    found = set()

    class Each(StaleObservationRaces):
        def __call__(self, number, c, expansion):
            before = self.collected.count
            for transition in expansion.by_agents:
                one = type(expansion)((transition,), (), (), ())
                super().__call__(number, c, one)
                if self.collected.count > before:
                    found.add(transition.label.agent)
                    before = self.collected.count

    explore(monitored(load(text, world).initial), (Each(),))
    return found


# --- control races --------------------------------------------------------------------------------------------

PILOTS = """
BigActor a hosted_at gcs0 with_behavior { control(MOVE uav0 TO south0) }
BigActor b hosted_at gcs0 with_behavior { control(MOVE uav0 TO gate0) }
"""
HANDS_AND_MOVES = """
BigActor a hosted_at gcs0 with_behavior { control(HAND uav0 TO gcs1) }
BigActor b hosted_at gcs0 with_behavior { control(MOVE uav0 TO gate0) }
"""
MOVES_TWICE = (
    "BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO gate0) control(MOVE_HOST_TO south0) }\n"
)


def test_two_orders_that_end_differently_are_a_race():
    found = verdict(PILOTS, "race_freedom")
    assert kinds(found) == {"control race": 2}
    race = violation(found, "control race")
    assert (
        race.message
        == "CTR(a, MOVE uav0 TO south0) and CTR(b, MOVE uav0 TO gate0) end differently in the two orders"
    )
    assert rules_of(race.trace) == ["req_ctr", "req_ctr"]
    assert race.details == (
        "enabled here: ⟨actuate : CTR(a, MOVE uav0 TO south0)⟩ and ⟨actuate : CTR(b, MOVE uav0 TO gate0)⟩",
    )


def test_serving_one_that_disables_the_other_is_a_race_whichever_it_is():
    message = "serving CTR({}, HAND uav0 TO gcs1) disables CTR({}, MOVE uav0 TO gate0)"
    assert control_races(HANDS_AND_MOVES) == message.format("a", "b")
    swapped = (
        HANDS_AND_MOVES.replace("Actor a", "Actor x")
        .replace("Actor b", "Actor a")
        .replace("Actor x", "Actor b")
    )
    assert control_races(swapped) == message.format("b", "a")


def test_controls_that_commute_are_no_race():
    assert control_races(moves("gate0", "a", "uav0") + ENTERS) is None


def test_whose_turn_it_is_hides_no_race():
    assert control_races(PILOTS + "scheduler fcfs") is not None
    assert control_races(HANDS_AND_MOVES + "scheduler fcfs") is not None


def test_the_order_of_what_is_pending_makes_no_race():
    looks = " observe(PARENT(HOST)) }"
    text = (moves("gate0", "a", "uav0") + ENTERS).replace(" }", looks)
    for scheduler in ("program_order", "fcfs", "unordered"):
        assert control_races(text + f"scheduler {scheduler}") is None


def test_one_agent_races_with_itself_only_where_there_is_no_line():
    assert control_races(MOVES_TWICE) is None
    assert control_races(MOVES_TWICE + "scheduler fcfs") is None
    assert "end differently" in control_races(MOVES_TWICE + "scheduler unordered")


def test_two_equal_controls_of_one_agent_are_a_race_where_one_has_to_wait_for_the_other():
    text = moves("gate0", "a", "uav0").replace("}", "control(MOVE_HOST_TO gate0) }") + "scheduler unordered\n"
    message = "serving CTR(a, MOVE_HOST_TO gate0) disables CTR(a, MOVE_HOST_TO gate0)"
    assert control_races(text + "control timed") == message
    assert control_races(text) is None  # the second is the identity
    assert control_races(moves("gate0", "a", "uav0") + "scheduler unordered\ncontrol timed") is None


def test_one_agents_controls_that_commute_are_no_race_in_no_line_either():
    text = """
    BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO gate0) control(DISCONNECT_HOST_FROM uav1) }
    scheduler unordered
    """
    assert control_races(text) is None


def test_two_commands_for_one_vehicle_are_a_race_since_one_has_to_wait():
    message = "serving CTR(a, MOVE uav0 TO south0) disables CTR(b, MOVE uav0 TO gate0)"
    assert control_races(PILOTS + "control timed") == message


def test_a_flight_races_with_what_takes_its_authority_away():
    assert "disables FLY(b, MOVE uav0 TO gate0)" in flights_only(HANDS_AND_MOVES + "control timed")


def flights_only(text):
    """Return the message of a control race in which a flight takes part."""
    looked = []

    class Flights(ControlRaces):
        def __call__(self, number, c, expansion):
            self.collected = Collected()
            super().__call__(number, c, expansion)
            looked.extend(each.message for each in self.collected.first.values() if "FLY" in each.message)

    explore(load(text).initial, (Flights(),))
    return looked[0]


def test_flights_of_two_vehicles_into_one_place_are_no_control_race():
    assert control_races(moves("gate0", "a", "uav0") + ENTERS + "control timed") is None


def test_the_environment_is_no_partner_of_a_race():
    text = moves("gate0", "a", "uav0") + "environment { uav0 drifts among south0 gate0 vanishes }"
    assert control_races(text) is None
    assert verdict(text, "race_freedom").outcome is Outcome.HOLDS


TWO_APART = """
control timed
rule enter(u: UAV, b: Location) { u || b -> b.u }
BigActor a hosted_at uav0 with_behavior { control(enter(uav0, gate0)) }
BigActor b hosted_at uav1 with_behavior { control(enter(uav1, basin0)) }
timing { UAV flies at 300 m/s to 400 m/s }
"""


def test_what_is_remembered_of_flights_for_their_times_makes_no_race():
    apart = WORLD.replace("  gate0: ", "  basin0: Location = circle (37.00, -8.60) radius 300 m\n  gate0: ")
    for timing in (TWO_APART, TWO_APART[: TWO_APART.index("timing")]):
        assert verdict(timing, "race_freedom", apart).outcome is Outcome.HOLDS


# --- stale observations: the paper's example ------------------------------------------------------------------


def looks(host, other, agent):
    return f"""
    BigActor {agent} hosted_at {host} with_behavior {{
      observe(CHILDREN(gate0))
      react {{ case obs if not ({other} in obs) => control(MOVE_HOST_TO gate0) case obs => skip }}
    }}
    """


BOTH_LOOK = looks("uav0", "uav1", "a") + looks("uav1", "uav0", "b")


@pytest.mark.parametrize("control", ["atomic", "timed"])
@pytest.mark.parametrize("scheduler", ["unordered", "program_order", "fcfs"])
def test_two_that_look_before_they_enter_are_racing_though_their_moves_commute(scheduler, control):
    text = BOTH_LOOK + f"scheduler {scheduler}\ncontrol {control}\n"
    assert control_races(text) is None
    assert stale(text) == {"a", "b"}


def test_a_stale_observation_is_told_with_the_query_and_the_test_and_a_shortest_trace():
    found = verdict(BOTH_LOOK, "race_freedom")
    assert list(kinds(found)) == [STALE]
    race = violation(found, STALE)
    assert race.message == (
        "CTR(b, MOVE_HOST_TO gate0) rests on whether observe(CHILDREN(gate0)) shows uav0, "
        "and another agent has changed that answer since it was sensed"
    )
    assert race.details == (
        "sensed in step 7: ⟨sense : OBS(b, CHILDREN(gate0))⟩",
        "changed by a in step 8: ⟨actuate : CTR(a, MOVE_HOST_TO gate0)⟩",
        "acted on in step 12: ⟨actuate : CTR(b, MOVE_HOST_TO gate0)⟩",
    )
    assert len(race.trace) == 12  # each looks and asks in 5 steps, and both are served
    assert rules_of(race.trace).count("actuate") == 2
    assert rules_of(race.trace)[-1] == "actuate"


def test_two_that_look_at_different_places_are_not_racing():
    assert stale(looks("uav0", "uav1", "a") + looks("uav1", "uav0", "b").replace("gate0", "south0")) == set()


# --- what a control rests on ----------------------------------------------------------------------------------

WAYS = {
    "a guard": "react { case obs if not (uav1 in obs) => control(MOVE_HOST_TO gate0) case obs => skip }",
    "an earlier guard": "react { case obs if uav1 in obs => skip case obs => control(MOVE_HOST_TO gate0) }",
    "an if": "react { case obs => if uav1 in obs { skip } else { control(MOVE_HOST_TO gate0) } }",
    "an if around an if": """
      react { case obs => if not (uav1 in obs) { if true { control(MOVE_HOST_TO gate0) } } }""",
    "a match": """
      react { case obs => match size(obs) { case 0 => control(MOVE_HOST_TO gate0) case _ => skip } }""",
    "a guard in a match": """
      react { case obs => match 0 { case n if not (uav1 in obs) => control(MOVE_HOST_TO gate0) case _ => skip } }""",
    "a for": "react { case obs => for x in nodes(obs) { control(MOVE_HOST_TO gate0) } }",
    "a choice": "react { case obs => choose x in nodes(obs) { control(MOVE_HOST_TO gate0) } }",
    "a stored value": """
      let clear = false
      react { case obs => clear = not (uav1 in obs) }
      if clear { control(MOVE_HOST_TO gate0) }""",
    "a value stored under a test": """
      let clear = false
      react { case obs => if not (uav1 in obs) { clear = true } }
      if clear { control(MOVE_HOST_TO gate0) }""",
    "a stored observation": """
      let seen = 0
      react { case obs => seen = obs }
      if not (uav1 in seen) { control(MOVE_HOST_TO gate0) }""",
    "an argument": "react { case obs => control(MOVE_HOST_TO first(nodes(obs))) }",
    "an argument of a behaviour": "react { case obs => enter(not (uav1 in obs)) }",
    "the size of it": "react { case obs => if size(obs) < 2 { control(MOVE_HOST_TO gate0) } }",
    "the second half of a test": """
      react { case obs => if uav0 in obs or not (uav1 in obs) { control(MOVE_HOST_TO gate0) } }""",
}
ENTER = "def enter(clear) = { if clear { control(MOVE_HOST_TO gate0) } }\n"


@pytest.mark.parametrize("way", WAYS.values(), ids=WAYS)
def test_a_control_rests_on(way):
    text = ENTER + f"BigActor a hosted_at uav0 with_behavior {{ observe(CHILDREN(gate0)) {way} }}\n" + ENTERS
    assert stale(text) == {"a"}
    assert STALE in kinds(verdict(text, "race_freedom"))


def test_the_exit_of_a_while_is_a_test():
    text = """
    BigActor a hosted_at uav0 with_behavior {
      let full = true
      while full { observe(CHILDREN(gate0)) react { case obs => full = uav1 in obs } }
      control(MOVE_HOST_TO gate0)
    }
    """
    assert stale(text + ENTERS) == {"a"}


def test_a_query_made_of_an_observation_carries_it():
    text = """
    BigActor a hosted_at uav0 with_behavior {
      observe(CHILDREN(gate0))
      react { case obs => let seen = nodes(obs) observe(PARENT(seen)) }
      react { case place if gate0 in place => skip case place => control(MOVE_HOST_TO gate0) }
    }
    """
    assert stale(text + ENTERS) == {"a"}


UNTESTED = {
    "what is only held": "react { case obs => control(MOVE_HOST_TO gate0) }",
    "what is only displayed": "react { case obs => display(uav1 in obs) control(MOVE_HOST_TO gate0) }",
    "an answer that nobody changes": """
      react { case obs if not (drifter0 in obs) => control(MOVE_HOST_TO gate0) case o => skip }""",
    "both ways of a test alike": "react { case obs => if uav1 in obs { skip } control(MOVE_HOST_TO gate0) }",
    "a control that comes before": """
      control(MOVE_HOST_TO gate0) react { case obs if uav1 in obs => skip case obs => skip }""",
}


@pytest.mark.parametrize("way", UNTESTED.values(), ids=UNTESTED)
def test_a_control_does_not_rest_on(way):
    text = f"BigActor a hosted_at uav0 with_behavior {{ observe(CHILDREN(gate0)) {way} }}\n" + ENTERS
    assert stale(text) == set()


def test_a_relation_that_the_redex_uses_may_not_have_been_changed_by_another_since():
    text = """
    BigActor a hosted_at uav0 with_behavior {
      observe(CHILDREN(gate0))
      react { case obs if not (uav1 in obs) => control(MOVE_HOST_TO gate0) case obs => skip }
    }
    BigActor b hosted_at gcs0 with_behavior { control(MOVE uav0 TO south0) }
    """
    assert stale(text) == {"a"}
    message = violation(verdict(text, "race_freedom"), STALE).message
    assert message.endswith("another agent has changed a relation that it uses since it was sensed")


HANDS_OVER = "BigActor b hosted_at gcs0 with_behavior { control(HAND uav0 TO gcs1) }\n"
"""Changes on which links `LINKED_TO(uav1)` shows uav0, and not whom it shows: all are on one mesh."""

GOES_OFF = "BigActor b hosted_at vessel0 with_behavior { control(DISCONNECT_HOST_FROM uav1) }\n"


def looks_around(test):
    return f"""
    BigActor a hosted_at uav1 with_behavior {{
      observe(LINKED_TO(uav1))
      react {{ case obs => {test} {{ control(MOVE_HOST_TO gate0) }} }}
    }}
    """


OF_MEMBERS = {
    "their number": "if size(obs) < 9",
    "their lack": "if not empty(obs)",
    "their kind": "if not empty(obs of Vessel)",
    "the nodes": "if not empty(nodes(obs))",
    "a difference": "if not empty(obs - {gcs0})",
    "a union": "if size({gcs0} + obs) < 9",
    "the first": "if first(obs) == gcs1",
    "each": "for x in obs",
    "one": "choose x in obs",
}


@pytest.mark.parametrize("test", OF_MEMBERS.values(), ids=OF_MEMBERS)
def test_on_which_links_something_was_seen_does_not_matter_where_only_the_members_are_asked(test):
    assert stale(looks_around(test) + HANDS_OVER) == set()
    assert stale(looks_around(test) + GOES_OFF) == {"a"}


OF_ALL = ("obs == obs", "obs != 0", "size({obs, 1}) == 2", "obs in {obs}", "element((obs, 1), 1) == 1")


def test_a_number_of_members_that_stays_the_same_is_the_same_answer():
    swaps = "BigActor b hosted_at gcs1 with_behavior { control(HAND uav1 TO gcs2) }\n"
    assert stale(looks_around("if size(obs) == 4") + swaps) == set()
    assert stale(looks_around("if size(obs - {vessel0}) == 3") + swaps) == {"a"}


@pytest.mark.parametrize("test", OF_ALL)
def test_who_asks_of_a_whole_observation_or_of_one_in_a_set_rests_on_all_that_it_says(test):
    assert stale(looks_around(f"if {test}") + HANDS_OVER) == {"a"}


def test_after_a_fresh_observation_there_is_no_race():
    text = """
    BigActor a hosted_at uav0 with_behavior {
      observe(CHILDREN(gate0))
      react { case obs => display(obs) }
      react { case "in" => observe(CHILDREN(gate0)) }
      react { case obs if not (uav1 in obs) => control(MOVE_HOST_TO gate0) case obs => skip }
    }
    BigActor b hosted_at uav1 with_behavior {
      control(MOVE_HOST_TO gate0)
      observe(PARENT(HOST))
      react { case inside => send("in", a) }
    }
    """
    assert stale(text) == set()


def test_one_agents_own_controls_make_nothing_of_its_own_stale():
    text = """
    BigActor a hosted_at uav0 with_behavior {
      observe(CHILDREN(gate0))
      react { case obs if not (uav0 in obs) => control(MOVE_HOST_TO gate0) control(MOVE_HOST_TO south0) case o => skip }
    }
    """
    assert stale(text) == set()


def test_what_the_environment_changes_is_no_race():
    text = looks("uav0", "uav1", "a") + "environment { uav1 drifts among gate0 }"
    assert stale(text) == set()
    assert verdict(text, "race_freedom").outcome is Outcome.HOLDS


def test_a_loop_that_looks_again_forgets_what_it_saw_before():
    text = """
    BigActor a hosted_at uav0 with_behavior {
      loop {
        observe(PARENT(HOST))
        react { case obs if north0 in obs => control(MOVE_HOST_TO gate0) case obs => control(MOVE_HOST_TO north0) }
      }
    }
    """
    assert stale(text + ENTERS) == set()


# --- messages -------------------------------------------------------------------------------------------------

LOOKOUT = """
BigActor c hosted_at gcs0 with_behavior {
  observe(CHILDREN(gate0))
  react { case obs if not (uav1 in obs) => send("clear", a) case obs => send("full", a) }
}
"""
TOLD = """
BigActor a hosted_at uav0 with_behavior {
  react { case "clear" => control(MOVE_HOST_TO gate0) case "full" => skip }
}
"""


def test_a_message_carries_the_test_under_which_it_was_sent():
    assert stale(TOLD + LOOKOUT + ENTERS) == {"a"}


def test_a_message_carries_the_observation_that_it_holds():
    text = """
    BigActor c hosted_at gcs0 with_behavior { observe(CHILDREN(gate0)) react { case obs => send(obs, a) } }
    BigActor a hosted_at uav0 with_behavior {
      react { case seen if not (uav1 in seen) => control(MOVE_HOST_TO gate0) case seen => skip }
    }
    """
    assert stale(text + ENTERS) == {"a"}
    assert stale(text.replace("uav1 in", "drifter0 in") + ENTERS) == set()


def test_a_message_is_passed_on_with_what_it_rests_on():
    relay = "BigActor relay hosted_at gcs0 with_behavior { react { case word: Message => send(word, a) } }"
    assert stale(TOLD + relay + LOOKOUT.replace(", a)", ", relay)") + ENTERS) == {"a"}


def test_what_the_sender_changes_after_it_has_sent_makes_the_message_stale():
    text = """
    BigActor c hosted_at uav1 with_behavior {
      observe(CHILDREN(gate0))
      react { case obs if not (uav1 in obs) => send("clear", a) control(MOVE_HOST_TO gate0) case obs => skip }
    }
    BigActor a hosted_at uav0 with_behavior { react { case "clear" => control(MOVE_HOST_TO gate0) } }
    """
    assert stale(text) == {"a"}


HANDOVER = """
BigActor op1 hosted_at gcs0 with_behavior {
  observe(LINKED_TO_HOST)
  react {
    case obs if uav0 in obs =>
      control(HAND uav0 TO gcs1)
      observe(LINKED_TO(uav0))
      react { case again => send("yours", op2) }
    case obs => skip
  }
}
BigActor op2 hosted_at gcs1 with_behavior { react { case "yours" => control(HAND uav0 TO gcs2) } }
"""


def test_what_an_agent_changes_between_its_test_and_its_message_makes_no_receiver_stale():
    assert stale(HANDOVER) == set()
    assert stale(HANDOVER + "control timed") == set()
    text = HANDOVER.replace("control(HAND uav0 TO gcs2)", "control(MOVE uav0 TO gate0)")
    assert verdict(text, "race_freedom").outcome is Outcome.HOLDS


def test_what_a_third_changes_between_the_test_and_the_message_does():
    third = "BigActor op3 hosted_at gcs0 with_behavior { control(HAND uav0 TO gcs2) }\n"
    text = HANDOVER.replace("control(HAND uav0 TO gcs1)", "skip").replace(
        "HAND uav0 TO gcs2", "HAND uav1 TO gcs2"
    )
    assert stale(text) == set()
    assert stale(text + third) == {"op2"}


# --- whose doing it was ---------------------------------------------------------------------------------------

NEAR = WORLD.replace("control:gcs0, internet", "control:gcs0, internet, mesh")
RECEIVER_MOVED = {
    "while its station looked": """
      BigActor a hosted_at gcs0 with_behavior {
        control(HAND uav0 TO gcs1) observe(LINKED_TO(HOST)) react { case o if uav1 in o => send("go", b) }
      }
      BigActor b hosted_at uav0 with_behavior {
        control(MOVE_HOST_TO gate0) react { case "go" => control(MOVE_HOST_TO north0) }
      }""",
    "in no order with its looking": """
      BigActor a hosted_at uav0 with_behavior {
        control(MOVE_HOST_TO gate0) react { case "go" => control(MOVE_HOST_TO gate0) }
      }
      BigActor b hosted_at uav1 with_behavior {
        observe(CHILDREN(south0)) react { case o if vessel0 in o => send("go", a) }
      }
      scheduler unordered""",
    "to where its sender is": """
      BigActor a hosted_at uav1 with_behavior {
        control(MOVE_HOST_TO gate0) observe(CHILDREN(gate0)) react { case o if not (uav0 in o) => send("go", b) }
      }
      BigActor b hosted_at uav0 with_behavior {
        control(MOVE_HOST_TO gate0) react { case "go" => control(MOVE_HOST_TO north0) }
      }""",
}


@pytest.mark.parametrize("text", RECEIVER_MOVED.values(), ids=RECEIVER_MOVED)
def test_what_its_receiver_has_changed_itself_is_held_against_no_message(text):
    assert stale(text, NEAR) == set()
    third = "BigActor c hosted_at gcs2 with_behavior { control(MOVE uav0 TO south0) }\n"
    owned = NEAR.replace("linked control:gcs0, mesh", "linked control:gcs0, control:gcs2, mesh")
    assert len(stale(third + text, owned)) == 1  # what a third does to it is


PASSED_ON = """
BigActor a hosted_at gcs0 with_behavior {
  observe(CHILDREN(gate0)) react { case o => send(("free", size(o of UAV)), b) }
}
BigActor b hosted_at uav1 with_behavior {
  control(MOVE_HOST_TO gate0) observe(PARENT(HOST)) react { case there: Observation => skip }
  react { case (word, n) if n == 0 => send(("free", n), c) case m: Message => skip }
}
BigActor c hosted_at uav0 with_behavior {
  react { case (word, n) if n == 0 => control(MOVE_HOST_TO gate0) case m: Message => skip }
}
"""


@pytest.mark.parametrize("control", ["atomic", "timed"])
def test_what_its_receiver_has_changed_is_stale_for_whom_it_tells_the_value(control):
    text = PASSED_ON + f"control {control}\n"
    assert stale(text, NEAR) == {"c"}
    assert stale(text.replace('("free", n), c', '("free", 0), c'), NEAR) == set()
    assert stale(text.replace('send(("free", n), c)', "control(MOVE_HOST_TO north0)"), NEAR) == set()


def test_a_value_that_comes_back_is_not_stale_by_what_its_receiver_did():
    back = """
    BigActor a hosted_at uav0 with_behavior {
      observe(CHILDREN(gate0))
      react { case o => control(MOVE_HOST_TO gate0) send(("free", size(o of UAV)), b) }
      react { case (word, n) if n == 0 => control(MOVE_HOST_TO north0) case m: Message => skip }
    }
    BigActor b hosted_at uav1 with_behavior { react { case m: Message => send(m, a) } }
    """
    assert stale(back) == set()
    assert stale(back.replace("send(m, a)", "control(MOVE_HOST_TO gate0) send(m, a)")) == {"a"}
    assert stale(back + moves("gate0", "c", "uav1")) == {"a"}


def test_the_moves_of_who_is_spawned_are_others_doing_to_its_spawner():
    text = """
    def enter(n) = { control(MOVE_HOST_TO gate0) send(("free", n), a) }
    BigActor a hosted_at uav0 with_behavior {
      observe(CHILDREN(gate0))
      react { case o => spawn c hosted_at uav1 with_behavior enter(size(o of UAV)) }
      react { case (word, n) if n == 0 => control(MOVE_HOST_TO gate0) case m: Message => skip }
    }
    """
    assert stale(text) == {"a"}
    assert stale(text.replace("control(MOVE_HOST_TO gate0) send", "send")) == set()


# --- what was resolved at sense -------------------------------------------------------------------------------

COMES_BACK = """
BigActor a hosted_at uav0 with_behavior { react { case "go" => control(MOVE_HOST_TO south0) } }
BigActor b hosted_at uav1 with_behavior {
  observe(CHILDREN(PARENT(HOST)))
  react {
    case o if not (uav0 in o) =>
      control(MOVE_HOST_TO gate0)
      observe(PARENT(HOST))
      react { case there => send("go", a) control(MOVE_HOST_TO south0) }
    case o => skip
  }
}
"""


@pytest.mark.parametrize("control", ["atomic", "timed"])
@pytest.mark.parametrize("query", ["CHILDREN(south0)", "CHILDREN(PARENT(HOST))"])
def test_a_place_that_an_agent_has_left_itself_is_still_the_one_that_it_looked_at(query, control):
    assert "b" in stale(COMES_BACK.replace("CHILDREN(PARENT(HOST))", query) + f"control {control}\n")


def test_what_others_do_elsewhere_is_no_race_though_the_agent_is_on_its_own_way():
    text = """
    BigActor b hosted_at uav1 with_behavior {
      observe(CHILDREN(PARENT(HOST)))
      react { case o if not (uav0 in o) => control(MOVE_HOST_TO gate0) case o => skip }
    }
    """
    assert stale(moves("gate0", "a", "uav0") + text + "control timed\n") == set()
    assert stale(moves("south0", "a", "uav0") + text + "control timed\n") == {"b"}


def test_a_query_is_resolved_anew_where_others_have_changed_what_it_begins_with():
    text = """
    BigActor b hosted_at uav0 with_behavior {
      observe(CHILDREN(PARENT(uav1)))
      react { case o if vessel0 in o => control(MOVE_HOST_TO gate0) case o => skip }
    }
    """
    assert stale(text + moves("north0", "a", "uav1")) == {"b"}
    own = text.replace(
        "control(MOVE_HOST_TO gate0)", "control(MOVE uav1 TO north0) control(CONNECT_HOST_TO gcs0)"
    )
    own = own.replace("b hosted_at uav0", "b hosted_at gcs1")
    assert stale(own + moves("gate0", "a", "uav0")) == set()


# --- what is computed, and what is only done ------------------------------------------------------------------

FREE = """
BigActor a hosted_at uav0 with_behavior {
  observe(CHILDREN(gate0))
  react {
    case o =>
      control(MOVE_HOST_TO gate0)
      observe(PARENT(HOST))
      react { case there => send(("free", size(o of UAV)), b) }
  }
}
BigActor b hosted_at uav1 with_behavior {
  react { case (word, n) if n == 0 => control(MOVE_HOST_TO gate0) case m: Message => skip }
}
"""
TELLING = {
    "a value that is computed after it": FREE,
    "a value that was computed before it": FREE.replace(
        "case o =>\n", "case o =>\n      let n = size(o of UAV)\n"
    ).replace('"free", size(o of UAV)', '"free", n'),
    "a value that goes through others' hands": FREE.replace("UAV)), b)", "UAV)), c)")
    + 'BigActor c hosted_at uav1 with_behavior { react { case m: Message => send(m, b) } }\n',
    "the observation": FREE.replace("size(o of UAV)", "o").replace("n == 0", "not (uav0 in n)"),
    "a member that it goes through": FREE.replace(
        'send(("free", size(o of UAV)), b)', 'for x in nodes(o) { send(("free", size({x} of UAV)), b) }'
    ),
    "a member that it chooses": FREE.replace(
        'send(("free", size(o of UAV)), b)', 'choose x in nodes(o) { send(("free", size({x} of UAV)), b) }'
    ),
    "a part that it matches": FREE.replace(
        'send(("free", size(o of UAV)), b)', 'match size(o of UAV) { case k => send(("free", k), b) }'
    ),
    "an argument of a behaviour": "def tell(k) = { send((\"free\", k), b) }\n"
    + FREE.replace('send(("free", size(o of UAV)), b)', "tell(size(o of UAV))"),
    "what is seen where it led": FREE.replace(
        "case there => ", "case there => let x = first(nodes(o)) observe(CHILDREN(x)) react { case p => "
    ).replace("size(o of UAV)), b)", "size(p of UAV) - 1), b) }"),
    "an argument of who is spawned": """
    def enter(n) = { if n == 0 { control(MOVE_HOST_TO gate0) } }
    """ + FREE[: FREE.index("BigActor b")].replace(
        'send(("free", size(o of UAV)), b)', "spawn b hosted_at uav1 with_behavior enter(size(o of UAV))"
    ),
}  # fmt: skip


@pytest.mark.parametrize("control", ["atomic", "timed"])
@pytest.mark.parametrize("text", TELLING.values(), ids=TELLING)
def test_what_its_sender_has_made_stale_is_stale_for_who_is_told(text, control):
    assert stale(text + f"control {control}\n") == {"b"}


def test_who_is_spawned_rests_on_what_its_host_was_chosen_by():
    text = """
    def enter() = { control(MOVE_HOST_TO gate0) }
    BigActor a hosted_at uav0 with_behavior {
      observe(CHILDREN(south0))
      react { case o => spawn c hosted_at first(o of UAV) with_behavior enter() }
    }
    BigActor b hosted_at gcs1 with_behavior { control(MOVE uav1 TO gate0) }
    """
    assert stale(text) == {"c"}


TOLD_RIGHTLY = {
    "that something is done": FREE.replace("size(o of UAV)", "0"),
    "what is seen after it": FREE.replace("observe(PARENT(HOST))", "observe(CHILDREN(gate0))").replace(
        "case there => ", "case o => "
    ),
    "that a message has come, whatever it says": FREE.replace(
        "case (word, n) if n == 0 => control(MOVE_HOST_TO gate0) case m: Message => skip",
        "case m: Message => control(MOVE_HOST_TO gate0)",
    ),
    "another answer": FREE.replace("size(o of UAV)", "uav1 in o").replace("n == 0", "not n"),
    "a word under a test": FREE.replace("size(o of UAV)", "0").replace(
        "case o =>\n", "case o if not (uav1 in o) =>\n"
    ),
    "a word that a variable holds under a test": FREE.replace("size(o of UAV)", "n").replace(
        "case o =>\n", "case o if size(o) == 1 =>\n      let n = 0\n"
    ),
}


@pytest.mark.parametrize("text", TOLD_RIGHTLY.values(), ids=TOLD_RIGHTLY)
def test_who_is_told_may_rely_on(text):
    assert stale(text) == set()


def test_an_agent_knows_what_it_has_made_of_what_it_has_computed():
    text = """
    BigActor a hosted_at uav0 with_behavior {
      observe(CHILDREN(gate0))
      react { case o => control(MOVE_HOST_TO gate0) send(size(o), b) if size(o) == 1 { control(MOVE_HOST_TO north0) } }
    }
    BigActor b hosted_at uav1 with_behavior { react { case n => skip } }
    """
    assert stale(text) == set()


def test_no_race_of_told_values_is_hidden_by_ownership():
    for text in (FREE, COMES_BACK):
        assert STALE in kinds(verdict(text, "race_freedom"))


# --- where an agent is hosted ---------------------------------------------------------------------------------

MIGRATES = {
    "what was chosen by an observation": "case o => migrate(first(o of UAV))",
    "what was decided by a test": "case o => if uav1 in o { migrate(uav1) }",
    "what a variable holds": "case o => let h = first(o of UAV) migrate(h)",
    "where it is already": "case o => migrate(first(o of UAV)) migrate(HOST)",
}
TAKES_AWAY = "BigActor a hosted_at gcs1 with_behavior { control(MOVE uav1 TO north0) }\n"


COMES = "BigActor a hosted_at gcs0 with_behavior { control(MOVE uav0 TO south0) }\n"


def migrating(case):
    return f"""
    BigActor b hosted_at vessel0 with_behavior {{
      observe(CHILDREN(south0)) react {{ {case} }}
      observe(PARENT(HOST)) react {{ case there => control(MOVE_HOST_TO gate0) }}
    }}
    """


@pytest.mark.parametrize("control", ["atomic", "timed"])
@pytest.mark.parametrize("case", MIGRATES.values(), ids=MIGRATES)
def test_a_control_rests_on_how_its_host_came_to_be(case, control):
    text = migrating(case) + TAKES_AWAY + f"control {control}\n"
    assert stale(text) == {"b"}
    assert STALE in kinds(verdict(text, "race_freedom"))


def test_what_a_station_moves_rests_on_how_its_agent_came_there():
    text = """
    BigActor b hosted_at gcs0 with_behavior {
      observe(LINKED_TO(uav1)) react { case o => migrate(first(o of Station)) }
      observe(PARENT(HOST)) react { case there => control(MOVE uav1 TO gate0) }
    }
    BigActor a hosted_at uav0 with_behavior { control(DISCONNECT_HOST_FROM uav1) }
    """
    assert stale(text) == {"b"}
    assert stale(text.replace("first(o of Station)", "gcs1")) == set()


NOT_CHOSEN = {
    "an observation that is only held": "case o => migrate(uav1)",
    "an answer that nobody has changed": "case o => if vessel0 in o { migrate(uav1) }",
    "a host that it has left since": "case o => migrate(first(o of UAV)) migrate(uav0)",
}


@pytest.mark.parametrize("case", NOT_CHOSEN.values(), ids=NOT_CHOSEN)
def test_a_host_does_not_rest_on(case):
    assert stale(migrating(case) + COMES) == set()
    assert stale(migrating("case o => migrate(first(o of UAV))") + COMES) == {"b"}


ARRIVES = "observe(PARENT(HOST)) react { case there => skip }"
LEAVES = f"control(MOVE_HOST_TO north0) {ARRIVES}"
TELLS_ITS_HOST = {
    "what it has made stale before it went": ("let h = first(o of UAV)", LEAVES, "migrate(h)", "HOST"),
    "what it made stale on its way": ("control(MOVE_HOST_TO north0) migrate(first(o of UAV))", "", "", "HOST"),
    "what it made stale there": ("migrate(first(o of UAV))", ARRIVES, LEAVES, "HOST"),
    "a value of it": ("migrate(first(o of UAV))", ARRIVES, LEAVES, "{HOST}"),
}  # fmt: skip


@pytest.mark.parametrize("scheduler", ["program_order", "unordered"])
@pytest.mark.parametrize("steps", TELLS_ITS_HOST.values(), ids=TELLS_ITS_HOST)
def test_who_is_told_where_an_agent_is_hosted_rests_on_how_it_came_there(steps, scheduler):
    *before, told = steps
    text = f"""
    BigActor b hosted_at vessel0 with_behavior {{
      observe(CHILDREN(south0))
      react {{ case o => {" ".join(before)} }}
      observe(PARENT(HOST))
      react {{ case there => send({told}, c) }}
    }}
    BigActor c hosted_at uav0 with_behavior {{ react {{ case h: Message if h != 0 => control(MOVE_HOST_TO gate0) }} }}
    scheduler {scheduler}
    """
    assert stale(text) == {"c"}
    word = text.replace(f"send({told}, c)", 'send("go", c)')
    assert stale(word) == set()


def test_what_its_spawner_has_made_stale_of_its_host_is_stale_for_who_is_spawned():
    text = """
    def enter() = { control(MOVE_HOST_TO gate0) }
    BigActor a hosted_at vessel0 with_behavior {
      observe(CHILDREN(south0))
      react {
        case o =>
          let h = first(o of UAV)
          control(MOVE_HOST_TO north0)
          observe(PARENT(HOST))
          react { case there => spawn c hosted_at h with_behavior enter() }
      }
    }
    """
    assert stale(text) == {"c"}
    assert stale(text.replace("control(MOVE_HOST_TO north0)", "skip")) == set()


# --- what had to be passed ------------------------------------------------------------------------------------

PASSED = {
    "a guard that had to hold": """
      BigActor a hosted_at uav0 with_behavior {
        observe(CHILDREN(gate0))
        react { case obs if not (uav1 in obs) => skip }
        control(MOVE_HOST_TO gate0)
      }""",
    "a message that had to come": LOOKOUT
    + 'BigActor a hosted_at uav0 with_behavior { react { case "clear" => skip } control(MOVE_HOST_TO gate0) }',
    "the exit of a loop in a behaviour that is called": """
      def await() = {
        let full = true
        while full { observe(CHILDREN(gate0)) react { case obs => full = uav1 in obs } }
      }
      BigActor a hosted_at uav0 with_behavior { await() control(MOVE_HOST_TO gate0) }""",
    "the exit of a loop in a block": """
      BigActor a hosted_at uav0 with_behavior {
        let full = true
        if HOST == uav0 { while full { observe(CHILDREN(gate0)) react { case obs => full = uav1 in obs } } }
        control(MOVE_HOST_TO gate0)
      }""",
}


@pytest.mark.parametrize("text", PASSED.values(), ids=PASSED)
def test_what_comes_after_rests_on(text):
    assert stale(text + "\n" + ENTERS) == {"a"}


# --- what is forgotten ----------------------------------------------------------------------------------------

EVERY = frozenset(
    {(kind, ANY) for kind in ("in", "parent", "children", "links")} | SLOTS | {MEMBERS, SIZE, EVERYTHING}
)


class All:
    def __contains__(self, _):
        return True


ALL = All()


def first_races(c):
    """Return each stale-observation race with how many steps lead to it, or None where the search is cut off."""
    stale = StaleObservationRaces()
    found = explore(monitored(c), (stale,), Limits(configurations=4_000))
    if not found.complete:
        return None
    return {key: len(found.path(finding.at)) for key, finding in stale.collected.first.items()}


def remembering_everything(c):
    with pytest.MonkeyPatch.context() as patch:
        for name in ("questions_of", "anybodys", "slots_of"):
            patch.setattr(monitor, name, lambda *_: EVERY)
        for module, name in (
            (monitor, "heirs"),
            (stepping, "heirs"),
            (monitor, "possible_receivers"),
            (extension, "possible_receivers"),
        ):
            patch.setattr(module, name, lambda *_: frozenset({ANY}))
        for module in (monitor, stepping):
            patch.setattr(module, "communicated_variables", lambda *_: ALL)
        patch.setattr(stepping, "uses_host", lambda *_: True)
        return first_races(c)


@pytest.mark.long
@pytest.mark.parametrize("path", MISSIONS, ids=lambda path: path.stem)
def test_what_a_mission_lets_the_monitor_forget_would_have_made_no_race(path):
    c = load_mission(path).initial
    assert remembering_everything(c) in (None, first_races(c))


@examples(100)
@given(
    st.one_of(
        missions(("bare", "tested", "looked")),
        missions(("bare", "reports", "trusts")),
        missions(("bare", "migrates", "tested")),
    )
)
def test_what_the_monitor_forgets_would_have_made_no_race(text):
    try:
        c = start(text)
    except MissionError:
        reject()
    found = first_races(c)
    event("races" if found else "none")
    assert remembering_everything(c) in (None, found)


# --- waits that end -------------------------------------------------------------------------------------------


def impatient(cases, control="control(MOVE_HOST_TO gate0)", looks="observe(CHILDREN(gate0))"):
    return f"BigActor a hosted_at uav0 with_behavior {{ {looks} react {{ {cases} after 5 s => {control} }} }}\n{ENTERS}"


def test_a_timeout_after_a_guard_has_refused_what_was_seen_rests_on_that_guard():
    assert stale(impatient("case o: Observation if uav1 in o => skip")) == {"a"}


def test_a_timeout_where_nothing_was_tested_rests_on_nothing():
    assert stale(impatient('case "go" => skip')) == set()
    assert stale(impatient("")) == set()


def test_what_follows_a_wait_that_ends_rests_on_none_of_its_guards():
    waits = "case o: Observation if not (uav1 in o) => skip"
    follows = impatient(waits, "skip").replace("skip } }", "skip } control(MOVE_HOST_TO gate0) }")
    assert stale(follows) == set()
    assert stale(follows.replace(" after 5 s => skip", "")) == {"a"}


# --- those that are alike -------------------------------------------------------------------------------------

TWINS = """
def enter(place) = {
  observe(CHILDREN(place))
  react {
    case o: Observation if size(o) == 0 => control(MOVE_HOST_TO place)
    case o: Observation => skip
  }
}
BigActor a hosted_at uav0 with_behavior { choose p in {gate0, south0} { enter(p) } }
BigActor b hosted_at uav1 with_behavior { choose p in {gate0, north0} { enter(p) } }
"""


@pytest.mark.parametrize("engine", [Engine.REFERENCE, Engine.FAST])
def test_races_about_the_same_place_of_the_text_are_one_and_the_others_counted(engine):
    mission = load(TWINS + "check { race_freedom }")
    found = check(mission.initial, mission.properties, engine=engine).verdicts[0]
    (one,) = found.violations
    assert (one.kind, one.alike, found.different) == (STALE, 1, 2)
    assert len(one.trace) == 14


PUSHES = """
BigActor a hosted_at gcs0 with_behavior { choose p in {gate0, south0} { control(MOVE uav0 TO p) } }
BigActor b hosted_at gcs0 with_behavior {
  choose p in {gate0, south0} {
    control(MOVE uav0 TO p)
  }
}
"""


@pytest.mark.parametrize("engine", [Engine.REFERENCE, Engine.FAST])
def test_control_races_of_the_same_two_places_of_the_text_are_one(engine):
    mission = load(PUSHES + "check { race_freedom }")
    found = check(mission.initial, mission.properties, engine=engine).verdicts[0]
    (one,) = found.violations
    assert (one.kind, one.alike, found.different) == ("control race", 1, 2)


# --- by definition --------------------------------------------------------------------------------------------


@examples(300)
@given(st.one_of(companies(), chains()), st.sampled_from(["atomic", "timed"]), st.integers(0, 1 << 32))
def test_in_a_run_each_control_is_stale_that_is_so_by_definition_and_no_other(company, control, seed):
    first = WORLD.count("\n") + 1
    try:
        c = monitored(start(text_of(company, first) + f"control {control}\n"))
    except MissionError:
        reject()
    judge, choose, trace = Judge(company, first), Random(seed).choice, Trace(c)
    while allowed := expand(c).by_agents:
        taken = choose(allowed)
        trace = trace.extended(taken)
        if taken.label.rule in monitor.CONTROLS:
            races = judge.races(taken)
            event("race" if races else "no race")
            assert bool(is_stale(c, taken.served)) == bool(races)
            found = stale_steps(trace.initial, trace.steps)
            assert (found is None) == (not races)
            assert found is None or (found.sensed, found.changed) in races
        judge.take(c, taken)
        c = taken.target


@pytest.mark.parametrize("operator", sorted(OPERATORS))
def test_whatever_is_asked_of_an_observation_is_told_in_words(operator):
    seen = Observation.of(shown=["uav0"])
    for key in OPERATORS[operator].asks(*[seen] * OPERATORS[operator].arity):
        told = asked_in_words(Dependency(Nodes(("place0",)), (), asked=key))
        assert "observe(place0)" in told
        assert told.startswith(("all that ", "which ", "how ", "whether ", "where ", "what ", "the links "))
