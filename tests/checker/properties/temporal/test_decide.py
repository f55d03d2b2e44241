"""Temporal properties of missions: verdicts, what they say, and the runs that show them."""

import json
import re

import pytest
from checked_missions import checked, load

from checker import Limits, ReplayError, check, print_trace, replay, to_json
from checker.verdicts import Outcome

THERE_AND_BACK = """
BigActor a hosted_at uav0 with_behavior {
  loop { control(MOVE_HOST_TO gate0) control(MOVE_HOST_TO north0) observe(HOST) react { case o => skip } }
}
BigActor g hosted_at gcs0 with_behavior { observe(HOST) }
"""
ONCE = "BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO gate0) }"


def verdict(text, claim, limits=None):
    """Return the verdict on one property, which has a name if it is not progress."""
    report = checked(f"{text}\ncheck {{ {claim} }}", limits=limits or Limits())
    return report.verdicts[0]


HOLDS = [
    (THERE_AND_BACK, 'ltl "q" under weak fairness of agents: [] <> uav0 in gate0'),
    (THERE_AND_BACK, 'ltl "q" under weak fairness of a: infinitely often taken actuate a'),
    (THERE_AND_BACK, 'ltl "q" under weak fairness of rules: pending OBS g leads to not pending OBS g'),
    (THERE_AND_BACK, 'ltl "q": uav0 in north0 U (uav0 in gate0 or pending CTR a) or [] uav0 in north0'),
    (THERE_AND_BACK, 'ltl "q": taken req_obs g -> X pending OBS g'),
    (THERE_AND_BACK, 'ltl "q": [] (enabled sense g <-> pending OBS g)'),
    (THERE_AND_BACK, 'ctl "q": AG EF uav0 in gate0'),
    (THERE_AND_BACK, 'ctl "q": EG not ended g'),
    (THERE_AND_BACK, 'ctl "q": E (uav0 in north0 U uav0 in gate0) and not AF ended g'),
    (THERE_AND_BACK, 'ctl "q" under weak fairness of agents: AF uav0 in gate0 and AG AF ended g'),
    (THERE_AND_BACK, "progress"),
    (ONCE, 'ltl "q": eventually always uav0 in gate0'),
    (ONCE, 'ctl "q": AF AG (uav0 in gate0 and ended a)'),
    (ONCE, 'ltl "q": [] (ended a -> not enabled a or taken a)'),
    (ONCE + " control timed environment { uav0 arrives }", 'ltl "q": eventually uav0 in gate0'),
    (ONCE + " control timed environment { uav0 arrives }", "progress"),
    (ONCE + " control timed", 'ltl "q" under weak fairness of commit: eventually uav0 in gate0'),
    (ONCE, 'ltl "q": forall u: UAV . always (present u and (u in gate0 -> <> u in gate0))'),
]
VIOLATED = [
    (THERE_AND_BACK, 'ltl "q": pending OBS g leads to taken sense g'),
    (THERE_AND_BACK, 'ltl "q" under weak fairness of a: <> ended g'),
    (THERE_AND_BACK, 'ltl "q" under weak fairness of agents: <> [] uav0 in gate0'),
    (THERE_AND_BACK, 'ltl "q": [] not uav0 in gate0'),
    (THERE_AND_BACK, 'ltl "q": X X uav0 in gate0'),
    (THERE_AND_BACK, 'ctl "q": AF ended g'),
    (THERE_AND_BACK, 'ctl "q": AG (uav0 in gate0 -> AX uav0 in gate0)'),
    (THERE_AND_BACK, 'ctl "q": EF AG uav0 in gate0'),
    (ONCE, 'ltl "q": [] <> uav0 in north0'),
    (ONCE + " control timed", 'ltl "q": eventually uav0 in gate0'),
    (ONCE + " control timed", 'ltl "q" under weak fairness of agents, rules: eventually uav0 in gate0'),
    (ONCE + " environment { uav0 drifts among north0, south0 }", "progress"),
]


@pytest.mark.parametrize(("text", "claim"), HOLDS)
def test_it_holds(text, claim):
    found = verdict(text, claim)
    assert (found.outcome, found.violations) == (Outcome.HOLDS, ())


def test_progress_that_holds_shows_a_shortest_run_that_ends_as_a_request_is_served():
    found = verdict(THERE_AND_BACK, "progress")
    assert found.examined == 4  # two controls and an observation of a, one observation of g
    assert [step.label.rule for step in found.witness.steps] == ["req_ctr", "actuate"]
    assert found.witness.shortest


@pytest.mark.parametrize(("text", "claim"), VIOLATED)
def test_it_is_violated_by_a_run_that_replays(text, claim):
    found = verdict(text, claim)
    assert found.outcome is Outcome.VIOLATED
    (violation,) = found.violations
    data = json.loads(json.dumps(to_json(violation.trace, "m", "sha256:0")))
    assert replay(load(text).initial, data) == violation.trace


def run_of(text, claim):
    return verdict(text, claim).violations[0].trace


def test_what_can_be_seen_early_is_shown_by_a_shortest_trace_without_a_loop():
    trace = run_of(THERE_AND_BACK, 'ltl "q": [] not uav0 in gate0')
    assert (len(trace), trace.loop) == (2, None)


def test_what_goes_on_for_ever_is_shown_by_a_loop():
    trace = run_of(THERE_AND_BACK, 'ltl "q": <> ended g')
    assert (trace.loop, len(trace)) == (2, 9)  # where the first flight ended, not where it began
    assert trace.configurations[9] == trace.configurations[2]
    assert list(print_trace(trace))[-1] == "c9 = c2: the 7 steps from there on, again and again"


def test_a_run_stays_where_nothing_has_to_happen():
    for text in (ONCE, ONCE + " control timed"):
        trace = run_of(text, 'ltl "q": infinitely often taken actuate a')
        assert trace.loop == len(trace) == 2
        assert list(print_trace(trace))[-1] == "c2 stays for ever: nothing has to happen"


def test_a_stay_of_a_moment_is_told_and_takes_no_loop_out_of_place():
    text = ONCE + " environment { uav0 drifts among north0, south0 }\n"
    paused = "not pending a and ended a and not taken env and X taken env"
    ended = verdict(text, f'ltl "q": [] not ({paused})').violations[0]
    assert (len(ended.trace), ended.trace.loop) == (3, None)
    assert ended.details == ("it stays at c2 for a moment before it goes on",)
    again = verdict(text, f'ltl "q": not infinitely often ({paused})').violations[0]
    assert again.trace.configurations[again.trace.loop] == again.trace.configurations[-1]
    assert len(again.details) == 1


# --- what was cut off -----------------------------------------------------------------------------------------

CUT = Limits(configurations=8)


@pytest.mark.parametrize(("text", "claim"), [each for each in HOLDS if each[0] == THERE_AND_BACK])
def test_what_was_cut_off_never_holds(text, claim):
    assert verdict(text, claim, CUT).outcome is Outcome.INCOMPLETE


@pytest.mark.parametrize(
    "claim",
    ["progress", "progress under strong fairness of actuate", 'ltl "q" under weak fairness of a: true'],
)
def test_nothing_is_said_never_to_be_where_not_everything_was_explored(claim):
    slow = ONCE.replace("{ ", "{ let n = 1  n = n + 1  observe(HOST)  ")
    found = verdict(slow, claim, Limits(configurations=1))
    assert (found.outcome, found.remarks) == (Outcome.INCOMPLETE, ())


def test_a_violation_within_what_was_explored_is_one():
    found = verdict(THERE_AND_BACK, 'ltl "q": [] not uav0 in gate0', CUT)
    assert (found.outcome, len(found.violations[0].trace)) == (Outcome.VIOLATED, 2)
    assert verdict(THERE_AND_BACK, 'ctl "q": AX uav0 in gate0', CUT).outcome is Outcome.VIOLATED


# --- what is said ---------------------------------------------------------------------------------------------


def test_fairness_to_what_never_is_is_pointed_out():
    found = verdict(ONCE, 'ltl "q" under strong fairness of sense a: <> ended a')
    assert found.remarks == ("strong fairness of sense a covers no step of any run",)


def test_a_formula_that_is_too_large_is_not_decided():
    parts = " or ".join(
        f"[] <> (pending {sort} a and uav{n} in gate0)" for sort in ("CTR", "OBS", "SND") for n in (0, 1)
    )
    both = " and ".join(
        f"<> (pending {sort} g or [] uav{n} in south0)"
        for sort in ("CTR", "OBS", "FLY", "MGR", "SND")
        for n in (0, 1)
    )
    found = verdict(THERE_AND_BACK, f'ltl "q": not (({parts}) and {both})')
    assert found.outcome is Outcome.INCOMPLETE
    assert found.note.startswith("not decided: it")


# --- traces with a loop ---------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def loop_data():
    return to_json(run_of(THERE_AND_BACK, 'ltl "q": <> ended g'), "m", "sha256:0")


def test_a_run_that_does_not_come_round_there_is_refused(loop_data):
    with pytest.raises(
        ReplayError, match=re.escape("step 9: coming round to c3 is not enabled: its last step")
    ):
        replay(load(THERE_AND_BACK).initial, loop_data | {"loop": 3})


def test_a_run_that_has_to_go_on_cannot_stay(loop_data):
    with pytest.raises(ReplayError, match="staying for ever is not enabled: some step has to be taken"):
        replay(load(THERE_AND_BACK).initial, loop_data | {"loop": 9})


@pytest.mark.parametrize("loop", [-1, 10, True, "0", 0.0])
def test_a_loop_that_is_no_number_of_a_configuration_is_refused(loop_data, loop):
    with pytest.raises(ValueError, match="'loop' should be the number"):
        replay(load(THERE_AND_BACK).initial, loop_data | {"loop": loop})


def test_formulas_are_told_as_they_were_written():
    text = """BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO gate0) }
    check {
      invariant "i": forall u: UAV . // of both
        not u in gate0
      reachable "r": exists u: UAV . u in gate0 and u in south0
      ltl "l" under weak fairness of a: always forall u: UAV . not (u in gate0)
      ctl "c": EF exists u: UAV . u in gate0 and ended a and u in south0
    }"""
    mission = load(text)
    verdicts = check(mission).verdicts
    told = [each.violations[0].message if each.violations else each.note for each in verdicts[:4]]
    assert told == [
        "not true here: forall u: UAV . not u in gate0",
        "no reachable configuration satisfies: exists u: UAV . u in gate0 and u in south0",
        "false, whatever follows: always forall u: UAV . not (u in gate0)",
        "false at c0: EF exists u: UAV . u in gate0 and ended a and u in south0",
    ]


UNFAIR = "only unfair runs violate it: it holds under weak fairness of rules, requests"


@pytest.mark.parametrize(
    ("claim", "told"),
    [
        ('ltl "q": <> ended g', [UNFAIR]),
        ('ctl "q": AF ended g', [UNFAIR]),
        ('ltl "q": [] not uav0 in gate0', []),
        ('ltl "q" under weak fairness of a: <> ended g', []),
    ],
)
def test_what_only_unfair_runs_violate_is_told_the_fairness_that_would_do(claim, told):
    (violation,) = verdict(THERE_AND_BACK, claim).violations
    assert [each for each in violation.details if "unfair" in each] == told


def test_a_deadlock_while_a_link_is_down_that_returns_names_the_fairness_that_counts_on_it():
    talks = """BigActor a hosted_at uav0 with_behavior { send "x" to b }
    BigActor b hosted_at uav1 with_behavior { react { case "x" => skip } }
    environment { mesh drops and returns }"""
    (violation,) = verdict(talks, "deadlock_freedom").violations
    assert violation.details[0] == (
        'SND(a, b, "x"): their hosts, uav0 and uav1, share no link: mesh is down; '
        "it may return: deadlock_freedom under weak fairness of environment counts on that"
    )
    (violation,) = verdict(talks.replace(" and returns", ""), "deadlock_freedom").violations
    assert violation.details[0].endswith("share no link: mesh is down")
