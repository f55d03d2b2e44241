"""What a control rests on, told by running the text again with another answer (examples: `stale_missions`)."""

from random import Random

import pytest
from checked_missions import load, start
from control_dependence import MEMBERS, MOST_STEPS, WORLD, Run, Writer, rests_on
from hypothesis import event, given
from hypothesis import strategies as st
from scale import IS_WHOLE, examples
from stale_missions import RESTS, beside_who_enters

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


@examples(600 if IS_WHOLE else 210)
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


@pytest.mark.parametrize("engine", [Engine.REFERENCE, Engine.FAST])
def test_both_engines_find_a_race_by_what_the_other_way_would_have_done(engine):
    text = beside_who_enters(RESTS["an if whose other way waits"]) + "check { race_freedom }"
    mission = load(text)
    found = check(mission, engine=engine).verdicts[0]
    assert found.outcome is Outcome.VIOLATED
    assert len(found.violations) == 1
