"""Claims decided on transition systems, complete and not."""

import pytest

from bigraphs.claims import (
    ClaimOutcome,
    Quantifier,
    deadlock_verdict,
    predicate_hint,
    predicate_verdict,
    property_verdict,
)
from bigraphs.errors import BigraphError
from bigraphs.exploration import explore
from bigraphs.notation import read_bgm, read_system

COUNT = """
atomic ctrl Tick = 0; atomic ctrl Tock = 0;
big start = Tick | Tick | Tick;
react next = Tick --> Tock;
big over = Tock | Tock | Tock;
big fresh = Tick;
begin brs init start; rules = [ {next} ]; preds = { over, fresh }; end
"""


def counted(**limits):
    return explore(read_system(COUNT), **limits)


@pytest.mark.parametrize(
    ("quantifier", "label", "outcome", "state"),
    [
        (Quantifier.ALWAYS, "fresh", ClaimOutcome.VIOLATED, 3),
        (Quantifier.NEVER, "over", ClaimOutcome.VIOLATED, 3),
        (Quantifier.REACHABLE, "over", ClaimOutcome.HOLDS, 3),
    ],
)
def test_a_predicate_is_decided_by_the_nearest_state(quantifier, label, outcome, state):
    found = predicate_verdict(counted(), quantifier, label)
    assert (found.outcome, found.state) == (outcome, state)


def test_what_was_not_looked_at_decides_nothing():
    cut = counted(max_states=2)
    assert predicate_verdict(cut, Quantifier.NEVER, "over").outcome is ClaimOutcome.INCOMPLETE
    assert predicate_verdict(cut, Quantifier.REACHABLE, "over").outcome is ClaimOutcome.INCOMPLETE
    assert predicate_verdict(cut, Quantifier.ALWAYS, "fresh").outcome is ClaimOutcome.INCOMPLETE
    assert predicate_verdict(cut, Quantifier.REACHABLE, "fresh").outcome is ClaimOutcome.HOLDS
    assert deadlock_verdict(cut).outcome is ClaimOutcome.INCOMPLETE


def test_a_state_in_which_nothing_can_happen_is_a_deadlock():
    assert (deadlock_verdict(counted()).outcome, deadlock_verdict(counted()).state) == (
        ClaimOutcome.VIOLATED,
        3,
    )


def test_an_unknown_predicate_is_a_mistake():
    with pytest.raises(BigraphError, match="unknown predicate 'overr'") as found:
        predicate_verdict(counted(), Quantifier.NEVER, "overr")
    assert found.value.hint == "did you mean 'over'?"


def test_the_hint_at_predicates_says_that_there_are_none_and_does_not_list_hundreds():
    assert predicate_hint("p", []) == "the system has none: write 'preds = { ... };' before its end"
    labels = [f"at({place})" for place in range(1200)]
    assert predicate_hint("x", labels).endswith("at(6), at(7) and 1,192 more")


def test_properties_see_the_states_before_and_after():
    text = """
    %%active Box : 0; %%passive Full : 0; %%passive Empty : 0;
    Box.Full -> Box.Empty;
    Box.Full | Box.Full;
    %%property kept %s;
    %%check
    """
    held = explore(read_bgm(text % "size() == 4"))
    assert property_verdict(held, held.system.properties[0]).outcome is ClaimOutcome.HOLDS
    broken = explore(read_bgm(text % "!terminal()"))
    verdict = property_verdict(broken, broken.system.properties[0])
    assert (verdict.outcome, len(broken.path_to(verdict.state))) == (ClaimOutcome.VIOLATED, 3)
    cut = explore(read_bgm(text % "size() == 4"), max_states=1)
    assert property_verdict(cut, cut.system.properties[0]).outcome is ClaimOutcome.INCOMPLETE
