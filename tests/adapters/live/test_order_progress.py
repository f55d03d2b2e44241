"""What becomes of orders to hold or to return: asked, sent, confirmed, refused and told again."""

import pytest
from live_missions import BETWEEN, EAST, TOUR, WEST, Run, boat, plan_of, seen
from test_command_planning import ANA, HOLD, RETURN, flying, ordered

from adapters.live.batch import GivingBack
from adapters.live.core import is_over
from adapters.live.loop import Ending
from adapters.live.order_progress import RETRY
from adapters.live.overrides import Fate
from adapters.plugin import Accepted, Arrived, Hold, Rejected, Sent, TakenOver
from bigactors.commands.run.flight import conclude
from bigactors.exits import Exit
from bigactors.vehicle_lines import standing, vehicle_line
from semantics.live_policy import LivePolicy, TimeLimit

OBEYS = "it obeys system 252, not gcs0"
REFUSES = f"refuses to hold, as {ANA} ordered: {OBEYS}"


def refused(run, request="operator-2", now=2.0, reason=OBEYS):
    run.turn(now, seen("uav0", BETWEEN, now), reports=[Rejected(request, "uav0", now, reason)])
    return run


def held():
    run = flying()
    run.turn(1.0, sayings=[ordered()])
    return run


@pytest.mark.parametrize(
    ("what", "does", "done"),
    [(HOLD, "holds", "held"), (RETURN, "returns", "sent home")],
    ids=["hold", "return"],
)
def test_an_order_is_asked_then_sent_then_confirmed_once(what, does, done):
    run = flying()
    run.turn(1.0, sayings=[ordered(what=what)])
    fates = [run.state.overrides.fates["uav0"]]
    for kind, now in ((Sent, 2.0), (Accepted, 3.0), (Accepted, 4.0), (Arrived, 5.0)):
        run.turn(now, reports=[kind("operator-2", "uav0", now)])
        fates.append(run.state.overrides.fates["uav0"])
    asked, end = f"ordered to {what.value} by {ANA}, not confirmed yet", ("confirmed", f"{done} by {ANA}")
    assert fates == [("asked", asked), ("sent", asked), end, end, end]
    assert run.messages()[1:] == [f"uav0 {does}, as {ANA} ordered"]
    assert run.state.overrides.taken == {"uav0": f"{done} by {ANA}"}


def test_a_refused_order_is_shown_as_refused_and_not_as_done():
    run = refused(held())
    run.turn(2.1, reports=[Sent("operator-2", "uav0", 2.1)])  # it was taken on before it was refused
    assert run.messages()[-1] == f"uav0 {REFUSES}; the order is repeated until it obeys"
    assert run.state.overrides.fates == {"uav0": ("refused", REFUSES)}
    assert vehicle_line("uav0", run.state, None, 3.0) == f"uav0 {REFUSES}, has not arrived in east0"
    assert standing(run.state) == f"; uav0 {REFUSES}"
    run.turn(3.0, seen("uav0", EAST, 3.0))
    assert "commit" not in run.rules


def test_while_a_refused_order_is_told_again_who_asks_hears_that_it_is_refused():
    run = refused(held())
    run.turn(2.0 + RETRY)  # it is told again
    assert run.state.overrides.orders["uav0"].fate is Fate.ASKED
    assert run.state.overrides.fates == {"uav0": ("refused", REFUSES)}
    run.turn(2.5 + RETRY, reports=[Sent("operator-2", "uav0", 2.5 + RETRY)])
    assert run.state.overrides.fates == {"uav0": ("refused", REFUSES)}
    run.turn(3.0 + RETRY, reports=[Accepted("operator-2", "uav0", 3.0 + RETRY)])
    assert run.state.overrides.fates == {"uav0": ("confirmed", f"held by {ANA}")}


def test_a_refused_order_is_told_again_until_it_is_confirmed():
    run = refused(held())
    assert run.again <= 2.0 + RETRY
    run.turn(2.0 + RETRY)
    assert run.commands[-2:] == [Hold("operator-2", "uav0")] * 2
    refused(run, now=3.0 + RETRY)
    run.turn(3.0 + 2 * RETRY)
    assert run.told == ["GoTo", "Hold", "Hold", "Hold"]
    assert (
        "refuses to hold" in run.state.overrides.taken["uav0"]
    )  # also while it is not known what comes of it now
    run.turn(4.0 + 2 * RETRY, reports=[Arrived("operator-2", "uav0", 4.0 + 2 * RETRY)])
    assert run.state.overrides.taken == {"uav0": f"held by {ANA}"}
    run.turn(100.0)
    assert run.told == ["GoTo", "Hold", "Hold", "Hold"]
    assert run.kinds() == ["ordered", "refused", "confirmed"]  # one reason is said once


def test_a_refused_fall_back_is_owed_until_it_is_confirmed():
    run = flying(precautions=LivePolicy(HOLD))
    run.turn(1.0, boat(EAST, 1.0))
    refused(run, "fallback-2")
    assert vehicle_line("uav0", run.state, None, 3.0).startswith(
        f"uav0 refuses to hold, as the mission ordered: {OBEYS}"
    )
    run.turn(2.0 + RETRY)
    assert run.told == ["GoTo", "Hold", "Hold"]
    run.turn(3.0 + RETRY, reports=[Arrived("fallback-2", "uav0", 3.0 + RETRY)])
    assert (run.findings[-1].kind, run.findings[-1].message) == (
        "confirmed",
        "uav0 holds, as the mission ordered",
    )
    run.turn(100.0)
    assert run.told == ["GoTo", "Hold", "Hold"]
    assert run.state.overrides.owing == {}


def test_a_fall_back_that_is_not_confirmed_is_in_the_last_line():
    run = flying(precautions=LivePolicy(limits=(TimeLimit("FLY", "a", 60.0, RETURN),)))
    run.turn(61.0, seen("uav0", BETWEEN, 61.0))
    assert standing(run.state) == "; uav0 ordered to return by the mission, not confirmed yet"


@pytest.mark.parametrize("ends", ["taken over", "given back", "ordered"])
def test_what_replaces_a_refused_fall_back_ends_it(ends):
    run = flying(precautions=LivePolicy(limits=(TimeLimit("FLY", "a", 60.0, HOLD),)))
    run.turn(61.0, seen("uav0", BETWEEN, 61.0))
    refused(run, "fallback-2", 62.0)
    if ends == "taken over":
        run.turn(63.0, reports=[TakenOver("uav0", 63.0, "it is in RTL")])
        assert run.state.overrides.owing == {}
    elif ends == "ordered":
        run.turn(63.0, sayings=[ordered(what=RETURN)])
        assert [each.action for each in run.state.overrides.owing.values()] == ["return"]
    else:
        run.turn(63.0, sayings=[GivingBack("uav0")])
        assert run.state.overrides.fallbacks["uav0"].fate is Fate.ASKED
    before = len(run.commands)
    run.turn(63.0 + RETRY, seen("uav0", BETWEEN, 63.0 + RETRY))
    assert len(run.commands) == before


def test_a_run_is_not_over_while_a_vehicle_owes_what_was_ordered():
    run = Run(plan_of(TOUR))
    run.turn(0.0, seen("uav0", WEST, 0.0))
    assert is_over(run.state)
    run.turn(1.0, sayings=[ordered()])
    assert not is_over(run.state)
    run.turn(2.0, reports=[Arrived("operator-1", "uav0", 2.0)])
    assert is_over(run.state)


def test_the_last_line_and_the_exit_code_say_that_an_order_was_refused(capsys):
    run = refused(held())
    assert conclude(Ending("the time is over", run.state), broken=False) is Exit.INCOMPLETE
    assert capsys.readouterr().out == f"the time is over after 3 steps; uav0 {REFUSES}\n"
