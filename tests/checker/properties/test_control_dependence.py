"""What a control rests on: told by running the text again with another answer, and by examples."""

from random import Random

import pytest
from checked_missions import load, start
from control_dependence import MEMBERS, MOST_STEPS, WORLD, Run, Writer, rests_on
from hypothesis import event, given
from hypothesis import strategies as st
from scale import examples
from test_races import ENTERS, moves, stale

from checker import Engine, check
from checker.verdicts import Outcome
from semantics.races.monitor import monitored
from semantics.state.requests import CTR
from semantics.successors import expand


def monitors(script, most):
    """Return on which answers the monitor says that the first controls of a run rest."""
    c, found = monitored(start(script.text(), WORLD)), []
    for _ in range(10 * MOST_STEPS):
        allowed = expand(c)
        taken = [*allowed.by_agents, *allowed.by_environment][:1]
        if not taken or len(found) == most:
            break
        c = taken[0].target
        if taken[0].label.rule == "req_ctr":
            rested = [each for each in c.eta.of("a") if isinstance(each.request, CTR)][-1].rests_on
            found.append(frozenset(map(asked, rested)))
    return found


def asked(dependency):
    place = str(dependency.query).removeprefix("CHILDREN(").removesuffix(")")
    return place, MEMBERS if dependency.asked == ("members",) else dependency.asked[1]


@examples(600)
@given(st.integers(0, 1 << 32), st.booleans())
def test_a_control_rests_on_each_answer_with_another_of_which_it_would_not_have_come_to_it(seed, assigns):
    script = Writer(Random(seed), assigns).script()
    run = Run(script).go()
    found = monitors(script, min(len(run.controls), 4))
    for rank, said in enumerate(found):
        decided = rests_on(run, rank)
        event(f"rests on {min(len(decided), 3)}")
        assert decided <= said
        # The monitor asks the text whether another way may block, and not which answers are known on it. What
        # another way assigns may be what is there already.
        assert assigns or said <= rests_on(run, rank, forgets=True)


LOOKS = "observe(CHILDREN(gate0)) "
NEVER = 'react { case "never" => skip }'
ENTER = " control(MOVE_HOST_TO gate0)"
RESTS = {
    "a case whose other waits": "react { case o if not uav1 in o => skip case _ => NEVER } ENTER",
    "an if whose other way waits": "react { case o => if uav1 in o { NEVER } } ENTER",
    "an if whose other way loops": """
      react { case o => if uav1 in o { loop { LOOKS react { case x => skip } } } } ENTER""",
    "an if in an if": "react { case o => if true { if uav1 in o { NEVER } } } ENTER",
    "an if whose other way may look in vain": """react { case o => if uav1 in o {
      observe(HOST) react { case p: Observation if gate0 in p => skip } } } ENTER""",
    "an if whose other way looks until": """react { case o => if uav1 in o { let full = true while full {
      LOOKS react { case p => full = uav1 in p } } } } ENTER""",
    "an if whose other way may choose to wait": """
      react { case o => if uav1 in o { choose { skip } or { NEVER } } } ENTER""",
    "an if whose other way is told": 'react { case o => if uav1 in o { react { case "free" => skip } } } ENTER',
    "a behaviour that may wait": "react { case o => hold(o) } ENTER",
    "a match whose other case waits": "react { case o => match size(o) { case 0 => skip case _ => NEVER } } ENTER",
    "a for whose body waits": "react { case o => for x in o of UAV { NEVER } } ENTER",
    "a case beside an end of the wait that waits": """
      react { case o if not uav1 in o => skip after 5 s => NEVER } ENTER""",
    "a guard that refused and whose case waits": "react { case o if uav1 in o => NEVER after 5 s => skip } ENTER",
    "a test before a loop": "react { case o if not uav1 in o => skip } loop { ENTER NEVER }",
    "a test under which it looked": """
      react { case o => if not uav1 in o { observe(HOST) } } react { case _: Observation => ENTER }""",
    "a test under which it looked before": """
      react { case o => if not uav1 in o { observe(HOST) } } react { case _: Observation => skip } ENTER""",
    "what an if would have assigned": "react { case o => if uav1 in o { busy = true } } if not busy { ENTER }",
    "what a for would have assigned": """react { case o => for x in o { if x == uav1 { busy = true } } }
      if not busy { ENTER }""",
    "what another case would have assigned": """
      react { case o if uav1 in o => busy = true case _ => skip } if not busy { ENTER }""",
    "what would have had it migrate": """react { case o => if uav1 in o { migrate(vessel0) } } observe(HOST)
      react { case _: Observation =>
      ENTER }""",
}  # fmt: skip
FREE = {
    "an if whose other way ends": "react { case o => if uav1 in o { skip } } ENTER",
    "an if whose other way looks and goes on": """
      react { case o => if uav1 in o { LOOKS react { case p => skip } } } ENTER""",
    "an if whose other way counts": "react { case o => if uav1 in o { let n = 0 while n < 2 { n = n + 1 } } } ENTER",
    "a match whose other case ends": "react { case o => match size(o) { case 0 => skip case _ => skip } } ENTER",
    "an if whose other way gives up": """
      react { case o => if uav1 in o { react { case "free" => skip after 5 s => skip } } } ENTER""",
}  # fmt: skip


WORDS = {"LOOKS": LOOKS, "NEVER": NEVER, "ENTER": ENTER}


def entering(way):
    for word, meant in WORDS.items():
        way = way.replace(word, meant)
    hold = f"def hold(o) = {{ if uav1 in o {{ {NEVER} }} }}\n"
    return f"{hold}BigActor a hosted_at uav0 with_behavior {{ let busy = false {LOOKS} {way} }}\n{ENTERS}"


@pytest.mark.parametrize("way", RESTS.values(), ids=RESTS)
def test_a_control_rests_on(way):
    assert stale(entering(way)) == {"a"}


@pytest.mark.parametrize("way", FREE.values(), ids=FREE)
def test_a_control_does_not_rest_on(way):
    assert stale(entering(way)) == set()


def test_who_was_told_to_wait_for_rests_on_what_it_was_told():
    waits = f'{LOOKS} react {{ case o => if uav1 in o {{ react {{ case "free" => skip }} }} }} {ENTER}'
    says = 'environment { someone says "free" to a }\n'
    apart = "BigActor b hosted_at uav1 with_behavior { control(MOVE_HOST_TO south0) }\n"
    there = f"BigActor a hosted_at uav0 with_behavior {{ {waits} }}\n"
    assert stale(there + ENTERS + says) == {"a"}  # it saw nobody and went
    world_full = (
        there.replace("gate0", "south0")
        + "BigActor b hosted_at uav1 with_behavior { control(MOVE_HOST_TO gate0) }\n"
    )
    assert stale(world_full + says) == set()  # it saw somebody, and was told that it is free
    assert stale(there + apart) == set()


def test_who_is_spawned_or_told_after_a_test_whose_other_way_waits_rests_on_it():
    looks = f"{LOOKS} react {{ case o => if uav1 in o {{ {NEVER} }} }}"
    spawns = f"{looks} spawn k hosted_at uav0 with_behavior go()"
    spawned = f"def go() = {{ {ENTER} }}\nBigActor a hosted_at uav0 with_behavior {{ {spawns} }}\n"
    assert stale(spawned + ENTERS) == {"k"}
    told = f"""BigActor a hosted_at uav0 with_behavior {{ {looks} send "go" to r }}
    BigActor r hosted_at uav0 with_behavior {{ react {{ case m: Message => send "on" to c }} }}
    BigActor c hosted_at uav0 with_behavior {{ react {{ case m: Message => {ENTER} }} }}
    """
    assert stale(told + moves("gate0", "d", "uav1")) == {"c"}


@pytest.mark.parametrize("engine", [Engine.REFERENCE, Engine.FAST])
def test_both_engines_find_a_race_by_what_the_other_way_would_have_done(engine):
    text = entering(RESTS["an if whose other way waits"]) + "check { race_freedom }"
    mission = load(text)
    found = check(mission.initial, mission.properties, engine=engine).verdicts[0]
    assert found.outcome is Outcome.VIOLATED
    assert len(found.violations) == 1
