"""Whatever telemetry, feeds and people do: live runs are runs of the rules, and commit only what was seen."""

from dataclasses import replace

from hypothesis import given
from hypothesis import strategies as st
from live_missions import BETWEEN, EAST, TOUR, WEST, Run, boat, plan_of, seen
from scale import examples

from adapters.live.batch import Acknowledging, Batch, GivingBack, Ordering, Saying
from adapters.live.core import advance, started
from adapters.plugin import GiveBack, Hold, LinkLost, LinkRestored, Rejected, Return, TakenOver
from adapters.recording.encoding import step_json
from checker import replay
from checker.steps import candidates
from checker.traces import SCHEMA
from semantics.live_policy import Fallback, LivePolicy, TimeLimit
from semantics.state.physical_model import Placed

PLAN = plan_of(
    TOUR
    + """
BigActor a hosted_at uav0 with_behavior {
  loop {
    control(MOVE_HOST_TO east0)
    observe(CHILDREN(PARENT(HOST)))
    react { case obs if boat0 in obs => display(obs)
            case obs => skip }
    control(MOVE_HOST_TO west0)
  }
}
BigActor op hosted_at gcs0 with_behavior {
  loop { react { case "hand" => control(HAND uav0 TO gcs1)
                                observe(LINKED_TO_HOST)
                                react { case view => send view to z } } }
}
BigActor z hosted_at gcs1 with_behavior { loop { react { case m: Message => display(m) } } }
environment {
  boat0 drifts among point (37.005, -8.605)
  control:gcs0 drops and returns
  says "hand" to op at most 2 times
}
""",
    LivePolicy(Fallback.CONTINUE, (TimeLimit("FLY", "a", 40.0, Fallback.HOLD),)),
)

PLACES = st.sampled_from([WEST, EAST, BETWEEN, (37.011, -8.612), (40.0, -8.0)])
AGES = st.sampled_from([0.0, 0.0, 0.0, 3.0, -2.0, -100.0])
CHANNELS = st.sampled_from([("control:gcs0",), ("control:gcs0",), ("control:gcs1",), ()])


@st.composite
def batches(draw, now):
    heard = []
    for _ in range(draw(st.integers(0, 3))):
        time = now - draw(AGES)
        what = draw(st.sampled_from(["uav", "uav", "uav", "boat", "stranger", "forged"]))
        at = draw(PLACES)
        if what == "uav":
            heard.append(seen("uav0", at, time, channels=draw(CHANNELS)))
        elif what == "forged":
            heard.append(seen("uav0", at, time, plugin="ais"))
        else:
            heard.append(boat(at, time, "boat0" if what == "boat" else "mmsi7"))
    reports = draw(
        st.lists(
            st.sampled_from(
                [
                    LinkLost("uav0", now, now - 9.0),
                    LinkRestored("uav0", now),
                    Rejected("a-1", "uav0", now, "no"),
                    TakenOver("uav0", now, "it is in RTL"),
                ]
            ),
            max_size=1,
        )
    )
    sayings = draw(
        st.lists(
            st.sampled_from(
                [
                    *(Saying("op", "hand"), Saying("op", "x"), GivingBack("uav0"), Acknowledging(1)),
                    *(Ordering(Fallback.HOLD, "uav0"), Ordering(Fallback.RETURN)),
                ]
            ),
            max_size=2,
        )
    )
    return Batch(tuple(heard), tuple(reports), tuple(sayings))


@st.composite
def histories(draw):
    times = [1000.0 + 7.0 * number for number in range(draw(st.integers(1, 12)))]
    return [(now, draw(batches(now))) for now in times]


def lived(history, plan=PLAN):
    run = Run(plan)
    for now, batch in history:
        run.turn(now, *batch.heard, reports=batch.reports, sayings=batch.sayings)
    return run


def assert_every_step_is_one_of_the_rules(steps, in_turn):
    for step in steps:
        if step.sight is None:
            found = candidates(step.source, in_turn=in_turn)
            alike = [t for t in found if str(t.label) == str(step.transition.label)]
            assert alike[step.choice].target == step.transition.target


def assert_what_is_committed_was_seen_where_it_was_to_be(run, turn):
    for step in turn.steps:
        if step.transition.label.rule == "commit":
            before, after = step.source.structure.physical, step.transition.target.structure.physical
            placed, to = after.placement("uav0"), before.transit("uav0").to
            assert isinstance(placed, Placed)
            assert placed.geometry is run.state.sightings.newest["uav0"].property.geometry
            assert after.abstract_parent("uav0") == to
            assert step.transition.target.structure.logical.parent("uav0") == to


def assert_who_was_taken_over_is_told_nothing_and_arrives_nowhere_until_it_is_given_back(before, turn, batch):
    """An order takes a vehicle only after what the same turn shows: that may be an arrival."""
    if GivingBack("uav0") in batch.sayings:
        return
    if turn.state.overrides.taken:
        ordered = any(isinstance(each, Ordering) for each in batch.sayings)
        allowed = (Hold, Return, GiveBack) if ordered else ()
        assert all(isinstance(each, allowed) for each in turn.commands)
        assert turn.state.overrides.orders.keys() <= turn.state.overrides.taken.keys()
    if before.overrides.taken or any(isinstance(each, TakenOver) for each in batch.reports):
        assert "commit" not in [step.transition.label.rule for step in turn.steps]


def assert_nothing_is_sent_before_the_vehicle_is_heard_and_requests_are_named_once(run, history):
    names = {(command.request, type(command).__name__) for command in run.commands}
    assert len(names) == len({command.request for command in run.commands})
    if not any(each.plugin == "autopilot" for _, batch in history for each in batch.heard):
        assert not {"GoTo", "HandOver"} & set(run.told)


@examples(240)
@given(histories())
def test_a_live_run_is_one_of_the_rules_and_commits_and_tells_only_what_it_may(history):
    run = Run(PLAN)
    for now, batch in history:
        before = run.state
        turn = run.turn(now, *batch.heard, reports=batch.reports, sayings=batch.sayings)
        assert_what_is_committed_was_seen_where_it_was_to_be(run, turn)
        assert_who_was_taken_over_is_told_nothing_and_arrives_nowhere_until_it_is_given_back(
            before, turn, batch
        )
    assert_every_step_is_one_of_the_rules(run.steps, in_turn=False)
    assert_nothing_is_sent_before_the_vehicle_is_heard_and_requests_are_named_once(run, history)


@examples(240)
@given(histories())
def test_under_a_verdict_for_fcfs_only_every_request_is_served_in_turn(history):
    run = lived(history, replace(PLAN, strict=True))
    assert_every_step_is_one_of_the_rules(run.steps, in_turn=True)


@given(histories(), st.booleans())
def test_the_same_happens_again_and_replays_to_the_same_configuration(history, strict):
    plan = replace(PLAN, strict=strict)
    first, second = lived(history, plan), lived(history, plan)
    assert first.labels == second.labels
    assert first.state.configuration == second.state.configuration
    assert (first.commands, first.findings) == (second.commands, second.findings)
    data = {"schema": SCHEMA, "mission": "m", "digest": "", "monitored": False, "in_turn": strict}
    trace = replay(
        PLAN.first, {**data, "steps": [{**step_json(step), "changes": []} for step in first.steps]}
    )
    assert trace.configurations[-1] == first.state.configuration


@given(histories(), st.randoms(use_true_random=False))
def test_of_an_entity_the_newest_counts_in_whatever_order_it_is_heard(history, random):
    heard = [each for _, batch in history for each in batch.heard if each.plugin == "autopilot"]
    # Of two that are equally new the later one counts: only different times say which is newer.
    known = {each.published.time: each for each in heard}
    ordered, shuffled = list(known.values()), random.sample(list(known.values()), len(known))
    now = 1000.0 + 7.0 * 12
    states = [advance(PLAN, started(PLAN), Batch(tuple(order)), now).state for order in (ordered, shuffled)]
    assert states[0].sightings.newest == states[1].sightings.newest
