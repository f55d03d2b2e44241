"""Local time beside one clock: the same answers from fewer zones, and what fails with fewer participants."""

from dataclasses import replace

import numpy as np
import pytest
from checked_missions import load
from hypothesis import HealthCheck, assume, given
from scale import examples, seeds, some_long
from shipped import TIMED
from timed_missions import timed_missions
from timed_reports import assert_alike
from timed_texts import text_of

from checker import Engine, Keeping, Limits, ZoneClock, check, explore
from checker.engines.fast.model.decision_leaves import FIRST, LEAF
from checker.engines.fast.model.learner import TransitionGroup
from checker.engines.zones.participants import WORD, Participants
from checker.engines.zones.timed_automaton import EDGE, EDGES, EDGES_END, FOOTPRINT, LEARNED, LOCATION
from checker.engines.zones.timed_automaton_of import Network
from semantics.state.setting import Scheduler
from semantics.successors import by_clause, moves, served
from semantics.timing.actor_clocks import of_clause, of_moves, of_requests
from specs.elaboration import load_mission


def under(name, scheduler=Scheduler.PROGRAM_ORDER):
    mission = load_mission(name)
    return mission.under(scheduler, mission.setting.control)


def explored(c, clock):
    found = explore(c, engine=Engine.FAST, clock=clock, limits=Limits(configurations=5_000))
    assert found.complete
    return found


def assert_same(c):
    """Look whether local time reaches the same configurations in the same order, by the same steps."""
    one, other = (explored(c, clock) for clock in (ZoneClock.GLOBAL, ZoneClock.LOCAL))
    assert not one.times.search.is_local
    assert list(one.configurations) == list(other.configurations)
    assert (one.origins, one.depth, one.rules) == (other.origins, other.depth, other.rules)
    return one, other


@pytest.mark.parametrize("name", some_long(TIMED, every=2))
def test_a_shipped_mission_gets_the_same_report_in_local_time(name):
    mission = under(name)
    reports = [check(mission, engine=Engine.FAST, clock=clock, times=True) for clock in ZoneClock]
    assert_alike(*reports)
    assert_same(mission.initial)


def test_under_one_queue_the_clock_is_global():
    found = explored(load_mission("handover_timed").initial, ZoneClock.LOCAL)
    assert not found.times.search.is_local


@examples(90, 15, deadline=None, suppress_health_check=list(HealthCheck))
@given(timed_missions())
def test_a_generated_mission_has_the_same_configurations_in_local_time(c):
    limits = Limits(configurations=400)
    assume(explore(c, engine=Engine.FAST, clock=ZoneClock.GLOBAL, limits=limits).complete)
    assert_same(c)


@seeds(400, 6)
def test_a_generated_text_gets_the_same_report_in_local_time(seed):
    mission = load(text_of(seed), "")
    right = check(mission, limits=Limits(configurations=120), engine=Engine.FAST, clock=ZoneClock.GLOBAL)
    if not right.complete:
        pytest.skip("too large")
    assert_alike(right, check(mission, engine=Engine.FAST))


CROWDED = """
BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO south0) send("x", b) send("x", b) }
BigActor b hosted_at uav1 with_behavior { control(MOVE_HOST_TO south0) control(MOVE_HOST_TO north0) }
scheduler program_order
control timed
timing { UAV flies at 20 m/s agents react within 5 s messages over mesh take 0 s }
"""


@pytest.mark.parametrize("most", [None, 1])
def test_a_search_that_goes_over_to_one_clock_goes_on_from_its_checkpoint(most, tmp_path):
    """An agent has more messages pending than may be: after the checkpoint if that is of a search cut short."""
    c, kept = load(CROWDED).initial, Keeping(str(tmp_path))
    first = explore(c, engine=Engine.FAST, limits=Limits(configurations=most, pending=1), keeping=kept)
    assert first.times.search.is_local == (most is not None)
    for _ in range(2):
        again = explore(c, engine=Engine.FAST, limits=Limits(pending=1), keeping=replace(kept, resumed=True))
        assert not again.times.search.is_local
        right = explore(c, engine=Engine.FAST, limits=Limits(pending=1), clock=ZoneClock.GLOBAL)
        assert list(again.configurations) == list(right.configurations)
        assert again.bounds == right.bounds


# --- fewer participants

ORIGINAL = Participants.take


def only_who_steps(participants, begun, end):
    """Let a step have only one participant: its agent or clause."""
    ORIGINAL(participants, begun, end)
    learner, edges = participants.learner, participants.automaton.edges.room
    owners = [*learner.still.read(("agents",)), *learner.setting.environment]
    for at in range(EDGE * begun, EDGE * end, EDGE):
        actor = learner.whose[int(edges[at + LEARNED])]
        assert isinstance(actor, TransitionGroup)
        bits = 1 << owners.index(actor.about)
        edges[at + FOOTPRINT] = participants._number(bits.to_bytes(8 * participants.size, "little"))
    participants._join()


def reaches_more(c, monkeypatch, name, change):
    """Return whether local time with a change reaches more than is reachable in time."""
    right, _ = assert_same(c)
    monkeypatch.setattr(Participants, name, change)
    return set(explored(c, ZoneClock.LOCAL).configurations) > set(right.configurations)


def test_a_step_of_which_only_its_actor_is_a_participant_comes_when_no_time_allows_it(monkeypatch):
    assert reaches_more(under("handover_timed").initial, monkeypatch, "take", only_who_steps)


ONE_VEHICLE = """
BigActor a hosted_at uav1 with_behavior { control(MOVE_HOST_TO south0) control(MOVE_HOST_TO north0) send("off", a) }
BigActor b hosted_at uav1 with_behavior {
  react { case "on" => control(MOVE_HOST_TO south0) after 4 s => control(MOVE_HOST_TO south0) }
  send("off", a)
}
scheduler program_order
control timed
timing { uav1 flies at 200 m/s to 1000 m/s agents react within 2 s messages over mesh take 0 s }
"""


def test_without_shared_columns_steps_come_in_an_order_that_no_time_allows(monkeypatch):
    assert reaches_more(load(ONE_VEHICLE).initial, monkeypatch, "shared", lambda *_: np.zeros(0, np.int64))


def only_what_steps_touch(participants, begun, end):
    """Let no shared column take part because a participant begins or ceases to read it."""
    ORIGINAL(participants, begun, end)
    edges, records = (
        participants.automaton.edges.room,
        participants.automaton.locations.used.reshape(-1, LOCATION),
    )
    begin = WORD * (participants.size - participants.words)
    for at in range(begun, end):
        (location,) = np.flatnonzero((records[:, EDGES] <= at) & (at < records[:, EDGES_END]))
        record = edges[EDGE * at : EDGE * (at + 1)]
        whole = int.from_bytes(participants.found[record[FOOTPRINT]], "little")
        touched = columns_of(
            participants, int(record[LEARNED]), int(participants.automaton.rows.room[location])
        )
        kept = whole & ((1 << begin) - 1) | sum(1 << begin + each for each in touched)
        assert whole & kept == kept
        record[FOOTPRINT] = participants._number(kept.to_bytes(8 * participants.size, "little"))
    participants._join()


def columns_of(participants, step, row):
    """Return the columns that a step of a row reads and writes."""
    network, learner = participants.network, participants.learner
    rules, about = learner.whose[step]
    clocks = {served: of_requests, moves: of_moves, by_clause: of_clause}[rules]
    key = clocks, learner.setting.environment.index(about) if rules is by_clause else about
    parts = [tree for tree in learner.leaves.parts_of(step) if tree in learner.writing_trees]
    trees = [learner.tree(learner.whose[step]), network.questions[key], *parts]
    leaves = [int(network.model.classify(tree, np.array([row]))[0]) for tree in trees]
    steps = [step, *(int(learner.leaves.leaves.room[LEAF * leaf + FIRST]) for leaf in leaves[2:])]
    reads, writes, copies = (
        participants.bits(each.used)
        for each in (participants.reads, participants.writes, participants.copies)
    )
    touched = reads[leaves].any(axis=0) | writes[steps].any(axis=0) | copies[step]
    return np.flatnonzero(touched).tolist()


HANDED_ON = """
BigActor a hosted_at gcs1 with_behavior { control(HAND uav0 TO gcs2) }
BigActor b hosted_at gcs0 with_behavior { control(HAND uav0 TO gcs1) }
BigActor c hosted_at gcs0 with_behavior { react { case "never" => after 50 s => } }
scheduler program_order
control timed
timing { HAND takes 100 s to 400 s agents react within 100 s }
"""


def test_a_participant_that_begins_to_read_a_column_must_not_be_ahead_of_who_wrote_it(monkeypatch):
    """Both take 100 s to hand it on, so it is in gcs2 after 200 s, and c waits no longer than 150 s.

    The clock of a's request starts when uav0 comes to gcs1. If a request at 0 s could find it there already, as it is
    at 100 s, its clock would run since 0 s.
    """
    run = Network._run

    def with_its_network(network, loop):
        if network.participants is not None:
            network.participants.network = network
        run(network, loop)

    monkeypatch.setattr(Network, "_run", with_its_network)
    assert reaches_more(load(HANDED_ON).initial, monkeypatch, "take", only_what_steps_touch)
