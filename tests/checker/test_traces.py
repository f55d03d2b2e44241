"""Traces: printed in the paper's notation, replayed to the same configurations, and refused where they don't fit."""

import json
import re
from functools import cache
from pathlib import Path

import pytest
from checked_missions import BOTH_LOOK, checked, load, moves, verdict_of, violation
from hypothesis import given
from hypothesis import strategies as st
from replaying import assert_replays
from scale import IS_WHOLE, crossed, examples
from shipped import ALL

from checker import Engine, Limits, ReplayError, Trace, check, explore, print_trace, replay, to_json
from checker.steps import alike, candidates, step_of
from checker.traces import MOST_STEPS, SCHEMA, trace_to
from semantics.hypothesis_strategies import initial_configurations
from semantics.state.configuration import Label
from semantics.state.setting import Scheduler
from semantics.successors import expand
from specs.elaboration import Variation, load_mission

OIL_SPILL = Path(__file__).parents[2] / "specs" / "missions" / "oil_spill.mission"


@pytest.fixture(scope="module")
def oil_spill():
    return load_mission(OIL_SPILL)


@pytest.fixture(scope="module")
def witness(oil_spill):
    report = check(oil_spill)
    return verdict_of(report, "over the spill").witness


def through_json(trace):
    return json.loads(json.dumps(to_json(trace, "m", "sha256:0")))


def test_a_trace_is_printed_in_the_papers_notation_with_what_changed_below(witness):
    assert list(print_trace(witness))[:6] == [
        "c0 --⟨req_ctr : a, control(MOVE_HOST_TO searchArea0)⟩--> c1",
        "      α  a@uav0 at observe (line 21)",
        "      η  a: CTR(a, MOVE_HOST_TO searchArea0)",
        "c1 --⟨actuate : CTR(a, MOVE_HOST_TO searchArea0)⟩--> c2",
        "      η  a: ∅",
        "      L  parent(uav0) : airfield0 ↦ searchArea0",
    ]
    steps = list(print_trace(witness, changes=False))
    assert [line.split(" --⟨")[0] for line in steps] == [f"c{number}" for number in range(8)]
    assert steps[-1] == "c7 --⟨actuate : CTR(a, MOVE_HOST_TO oilSpill0)⟩--> c8"


# --- replay ---------------------------------------------------------------------------------------------------


def test_a_trace_with_the_monitors_memory_replays_from_where_it_was_written_and_without():
    trace = violation(verdict_of(checked(BOTH_LOOK), "race_freedom"), "stale-observation race").trace
    data = through_json(trace)
    assert data["monitored"] is True
    again = replay(load(BOTH_LOOK).initial, data)
    assert [c.unmonitored() for c in again.configurations] == [c.unmonitored() for c in trace.configurations]
    assert again.initial.setting.monitored
    assert replay(again.initial, data).configurations == again.configurations


OUT_OF_TURN = """mission m
signature {
  kind Place contains UAV
  kind UAV driven
}
world {
  p0: Place = box (0.0, 0.0) (0.1, 0.1)
  p1: Place = box (0.0, 0.2) (0.1, 0.3)
  u0: UAV = point (0.05, 0.05)
}
BigActor a hosted_at u0 with_behavior {
  send "no" to b
  control(MOVE_HOST_TO p1)
}
BigActor b hosted_at u0 with_behavior { loop { react { case "no" => skip } } }
scheduler fcfs
check { local_consistency }
"""


def test_a_step_out_of_turn_does_not_replay():
    c = load(OUT_OF_TURN, "").initial
    labels = ['⟨req_snd : a, send("no", b)⟩', "⟨req_ctr : a, control(MOVE_HOST_TO p1)⟩"]
    late = [*labels, "⟨actuate : CTR(a, MOVE_HOST_TO p1)⟩"]
    for steps in (labels, [*labels, '⟨snd : SND(a, b, "no")⟩', late[-1]]):
        assert len(replay(c, {"schema": SCHEMA, "steps": [{"label": each} for each in steps]})) == len(steps)
    with pytest.raises(ReplayError) as refused:
        replay(c, {"schema": SCHEMA, "steps": [{"label": each} for each in late]})
    assert refused.value.enabled == ('⟨snd : SND(a, b, "no")⟩',)
    assert "step 3: ⟨actuate : CTR(a, MOVE_HOST_TO p1)⟩ is not enabled: it is out of turn" in str(
        refused.value
    )


EVERY_WAY = {
    f"{scheduler.value}, {engine.value}": (scheduler, engine)
    for scheduler in Scheduler
    for engine in (Engine.FAST, Engine.REFERENCE)
}


SOME = Limits(configurations=3_000 if IS_WHOLE else 250)


@crossed(ALL, EVERY_WAY)
def test_whatever_is_shown_of_a_mission_that_ships_replays(name, variation):
    scheduler, engine = variation
    mission = load_mission(name, Variation(scheduler=scheduler))
    assert_replays(check(mission, engine=engine, limits=SOME))


def test_two_messages_that_print_alike_are_told_apart():
    text = """
    BigActor a hosted_at uav0 with_behavior {
      observe(PARENT(uav0)) react { case o => send(o, b) }
      observe(PARENT(drifter0)) react { case o => send(o, b) }
    }
    BigActor b hosted_at uav0 with_behavior { loop { react { case m => skip } } }
    environment { vessel0 drifts among point (37.02, -8.69) }
    """.replace("PARENT(drifter0)", "PARENT(vessel0)")
    c = load(text).initial
    found = explore(c)
    runs = [trace_to(found, number) for number in range(1, len(found.configurations))]
    twins = [run for run in runs if run.steps[-1].label.rule == "snd" and len(candidates_of(run)) == 2]
    assert twins  # both messages are on their way, show {north0}, and hold different relations
    for trace in twins:
        assert replay(c, through_json(trace)) == trace


def candidates_of(run):
    source, last = run.configurations[-2], run.steps[-1]
    return [t for t in candidates(source) if str(t.label) == str(last.label)]


@examples(25)
@given(initial_configurations(monitored=None), st.randoms(use_true_random=False))
def test_every_configuration_of_a_generated_mission_has_a_trace_that_replays(c, random):
    found = explore(c, limits=Limits(configurations=80))
    number = random.randrange(len(found.configurations))
    trace = trace_to(found, number)
    assert trace.configurations[-1] == found.configurations[number]
    assert replay(c, through_json(trace)) == trace


@examples(25)
@given(initial_configurations(monitored=None))
def test_agents_that_a_label_does_not_name_have_no_step_of_it(c):
    for source in explore(c, limits=Limits(configurations=40)).configurations:
        found = candidates(source)
        for label in {str(transition.label) for transition in found}:
            assert alike(source, label) == [each for each in found if str(each.label) == label]


@pytest.mark.parametrize("name", ALL)
def test_an_agents_step_changes_a_cell_of_that_agent_or_of_nobody(name):
    """A step of an agent changes something of it, or the queue, so that only who changed is asked."""
    found = explore(load_mission(name).initial, limits=Limits(configurations=100))
    for source in found.configurations:
        expansion = expand(source)
        for step in expansion.transitions + expansion.out_of_turn:
            changed = step.target.state.changed(source.state)
            named = {part for cell in changed for part in cell[1:]}
            of_nobody = not changed or any(len(cell) == 1 for cell in changed)
            assert step.label.agent is None or step.label.agent in named or of_nobody


def test_to_take_a_step_again_only_the_agents_that_its_label_names_are_asked():
    agents = "".join(
        f"BigActor a{number} hosted_at uav0 with_behavior {{ display({number}) }}" for number in range(20)
    )
    c = load(agents).initial
    assert len(candidates(c)) == 20
    assert len(candidates(c, label="⟨fun : a7⟩")) == 1
    assert [step.label.agent for step in candidates(c, label="⟨fun : a17⟩")] == [
        "a1",
        "a17",
    ]  # a1 is part of it


def test_a_step_that_waits_for_its_turn_ends_no_trace():
    text = """
    BigActor a hosted_at gcs0 with_behavior { control(MOVE uav0 TO south0) }
    BigActor b hosted_at gcs0 with_behavior { control(MOVE uav0 TO gate0) }
    scheduler fcfs
    """
    found = explore(load(text).initial)
    last = next(c for c in found.configurations if len(c.eta.all()) == 2)
    first, waiting = (t for t in expand(last).enabled if t.served is not None)
    assert [t for t in candidates(last) if t.served is not None] == [first]
    assert step_of(last, first.label, first.target).choice == 0
    assert alike(last, str(waiting.label)) == []


# --- what does not fit ----------------------------------------------------------------------------------------


def test_a_changed_mission_says_at_which_step_and_what_is_enabled_instead(witness, tmp_path):
    changed = tmp_path / "changed.mission"
    changed.write_text(OIL_SPILL.read_text().replace("PARENT(HOST)", "searchArea0"))
    with pytest.raises(ReplayError) as caught:
        replay(load_mission(changed).initial, through_json(witness))
    assert caught.value.step == 3
    assert "⟨req_obs : a, observe(CHILDREN(searchArea0))⟩" in caught.value.enabled
    assert str(caught.value).splitlines() == [
        (
            "step 3: ⟨req_obs : a, observe(CHILDREN(PARENT(uav0)))⟩ is not enabled: "
            "the mission, its scheduler or its environment may have changed since the trace was written"
        ),
        "enabled instead:",
        *(f"  {label}" for label in caught.value.enabled),
    ]


def test_where_nothing_is_enabled_it_says_so():
    ended = load("BigActor a hosted_at uav0 with_behavior { }").initial
    with pytest.raises(ReplayError, match=r"(?s)step 1: ⟨fun : a⟩ is not enabled.*instead:\n  nothing"):
        replay(ended, {"schema": SCHEMA, "steps": [{"label": "⟨fun : a⟩"}]})


def test_a_choice_that_is_not_there_is_told_apart_from_a_label_that_is_not():
    c = load(moves("gate0", "a", "uav0")).initial
    label = str(candidates(c)[0].label)
    data = {"schema": "bigactors.trace/1", "steps": [{"label": label, "choice": 1}]}
    with pytest.raises(ReplayError, match="it has 1 successors here, fewer than the trace chose from"):
        replay(c, data)


# --- what is no trace -----------------------------------------------------------------------------------------

NO_TRACE = "this is no trace: it should be an object with 'schema': 'bigactors.trace/1'"
NO_STEPS = "this is no trace: 'steps' should be a list of at most 1,000,000 steps"
NO_STEP = "step {} should have a 'label' (a text) and a 'choice' (a number from 0)"
NO_TRACES = [
    *((each, NO_TRACE) for each in (None, [], {}, {"schema": "bigactors.trace/2", "steps": []})),
    ({"schema": [SCHEMA], "steps": []}, NO_TRACE),
    ({"schema": SCHEMA}, NO_STEPS),
    *(
        ({"schema": SCHEMA, "steps": each}, NO_STEPS)
        for each in ({}, "abc", [{"label": "x"}] * (MOST_STEPS + 1))
    ),
    *(({"schema": SCHEMA, "steps": [each]}, NO_STEP.format(1)) for each in ("fun", {}, {"label": 7})),
    *(
        ({"schema": SCHEMA, "steps": [{"label": "x", "choice": each}]}, NO_STEP.format(1))
        for each in (-1, True, 0.0, None)
    ),
    ({"schema": SCHEMA, "steps": [{"label": "x"}, None]}, NO_STEP.format(2)),
]


@pytest.mark.parametrize(("data", "message"), NO_TRACES, ids=map(str, range(len(NO_TRACES))))
def test_what_is_no_trace_is_told_in_words(oil_spill, data, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        replay(oil_spill.initial, data)


PLAIN = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=8), inner, max_size=3),
    max_leaves=8,
)
STEPS = st.fixed_dictionaries(
    {}, optional={"label": PLAIN | st.just("⟨fun : a⟩"), "choice": PLAIN, "changes": PLAIN}
)
TRACES = st.fixed_dictionaries(
    {"schema": st.just(SCHEMA)}, optional={"steps": PLAIN | st.lists(PLAIN | STEPS), "monitored": PLAIN}
)


@cache
def two_movers():
    return load(moves("gate0", "a", "uav0") + moves("gate0", "b", "uav1")).initial


@given(PLAIN | TRACES)
def test_whatever_is_read_is_replayed_or_refused_in_words(data):
    outcome = replayed(two_movers(), data)
    if isinstance(outcome, Trace):
        assert len(outcome) == len(data["steps"])
    elif isinstance(outcome, ReplayError):
        assert outcome.step >= 1
        assert outcome.enabled
    else:
        assert "should" in str(outcome)


@given(st.data())
def test_a_damaged_trace_replays_or_is_refused(data):
    c = two_movers()
    found = explore(c)
    written = through_json(trace_to(found, len(found.configurations) - 1))
    number = data.draw(st.integers(0, len(written["steps"]) - 1))
    key = data.draw(st.sampled_from(["label", "choice", "changes"]))
    written["steps"][number][key] = data.draw(PLAIN)
    outcome = replayed(c, written)
    if isinstance(outcome, Trace):
        assert outcome.configurations[-1] == found.configurations[-1]
    elif isinstance(outcome, ReplayError):
        assert outcome.step >= number + 1
    else:
        assert str(outcome).startswith(f"step {number + 1} should have")


def replayed(c, data):
    try:
        return replay(c, data)
    except (ReplayError, ValueError) as error:
        return error


def test_a_step_is_no_step_where_the_label_is_not_enabled():
    c = load(moves("gate0", "a", "uav0")).initial
    elsewhere = Label("fun", "a")
    with pytest.raises(ValueError, match="not in list"):
        step_of(c, elsewhere, c)
