"""Stale-observation races: by small missions, by the definition on runs, and by a monitor that forgets nothing."""

from pathlib import Path
from random import Random

import pytest
from checked_missions import BOTH_LOOK, WORLD, load, start, verdict, violation
from hypothesis import event, given, reject
from hypothesis import strategies as st
from mission_texts import missions
from scale import IS_WHOLE, examples
from stale_by_definition import Judge, chains, companies, text_of
from stale_missions import (
    CHANGED_BY_ITS_HOLDER,
    FREE,
    HOSTED,
    NEAR,
    RECEIVER_MOVED,
    RESTS,
    SEEN,
    TELLS_ITS_HOST,
    TOLD,
    beside_who_enters,
    telling_its_host,
    written,
)

from checker import Engine, Limits, Trace, check, explore
from checker.properties.races import STALE, StaleObservationRaces, asked_in_words, is_stale
from checker.properties.stale_steps import stale_steps
from semantics import bigactor_rules
from semantics.behaviours import process_conversion
from semantics.behaviours.expressions import OPERATORS
from semantics.behaviours.observations import All as Everyone
from semantics.behaviours.observations import Nodes, Observation, Of, QueryOperator, QueryStep
from semantics.behaviours.queries import answers, denoted, resolve
from semantics.races import monitor
from semantics.races.monitor import monitored
from semantics.races.provenance import ANY, EVERYTHING, MEMBERS, SIZE, Dependency, differences
from semantics.races.relevance import SLOTS
from semantics.successors import expand
from specs import MissionError
from specs.elaboration import load_mission, read_mission

ROOT = Path(__file__).parents[3]
MISSIONS = sorted(
    (*ROOT.glob("specs/missions/*.mission"), *ROOT.glob("tests/corpus/violated/stale*.mission"))
)
CONTROLS = ("atomic", "timed")


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


def under_controls(cases):
    """Return cases under both ways of control; `make test` takes one of them, by turns."""
    return [
        pytest.param(*each.values, control, id=f"{each.id}-{control}")
        for at, each in enumerate(cases)
        for turn, control in enumerate(CONTROLS)
        if IS_WHOLE or at % 2 == turn
    ]


def is_reported(text, world=WORLD):
    return any(each.kind == STALE for each in verdict(text, "race_freedom", world).violations)


# --- small missions -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("way", RESTS.values(), ids=RESTS)
def test_a_control_rests_on(way):
    assert stale(beside_who_enters(way)) == {"a"}
    assert is_reported(beside_who_enters(way))


@pytest.mark.parametrize("way", FREE.values(), ids=FREE)
def test_a_control_does_not_rest_on(way):
    assert stale(beside_who_enters(way)) == set()


@pytest.mark.parametrize(("text", "found", "world"), [*SEEN, *CHANGED_BY_ITS_HOLDER])
def test_a_control_is_stale_if_another_changed_what_it_rests_on(text, found, world):
    assert stale(text, world) == found
    assert is_reported(text, world) is bool(found)


@pytest.mark.parametrize(("text", "found", "world", "control"), under_controls(TOLD))
def test_what_is_told_is_as_stale_as_what_it_was_computed_from(text, found, world, control):
    assert stale(f"{text}control {control}\n", world) == found


@pytest.mark.parametrize(("text", "found", "world", "control"), under_controls(HOSTED))
def test_a_control_rests_on_how_its_host_came_to_be(text, found, world, control):
    assert stale(f"{text}control {control}\n", world) == found


@pytest.mark.parametrize("scheduler", ["program_order", "unordered"])
@pytest.mark.parametrize("steps", TELLS_ITS_HOST.values(), ids=TELLS_ITS_HOST)
def test_who_is_told_where_an_agent_is_hosted_rests_on_how_it_came_there(steps, scheduler):
    *before, told = steps
    for message, found in ((told, {"c"}), ('"go"', set())):
        text = written(telling_its_host(*before, message))
        assert stale(f"{text}scheduler {scheduler}\n") == found


@pytest.mark.parametrize("text", RECEIVER_MOVED.values(), ids=RECEIVER_MOVED)
def test_what_its_receiver_has_changed_itself_is_held_against_no_message(text):
    assert stale(written(text), NEAR) == set()
    third = f"{text}c@gcs2: control(MOVE uav0 TO south0)"
    both_own = NEAR.replace("linked control:gcs0, mesh", "linked control:gcs0, control:gcs2, mesh")
    assert len(stale(written(third), both_own)) == 1  # what a third does to it is


def looks_around(test, other):
    return written(f"""
    a@uav1: observe(LINKED_TO(uav1)) react {{ case obs => {test} {{ ENTER }} }}
    {other}""")


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
"""Tests that ask of an observation who is shown, and not on which links."""

OF_ALL = ("obs == obs", "obs != 0", "size({obs, 1}) == 2", "obs in {obs}", "element((obs, 1), 1) == 1")
"""Tests that ask for all that an observation says."""
HANDS_OVER = "b@gcs0: control(HAND uav0 TO gcs1)"
"""Changes on which links `LINKED_TO(uav1)` shows uav0, and not whom it shows: all are on one mesh."""

GOES_OFF = "b@vessel0: control(DISCONNECT_HOST_FROM uav1)"


@pytest.mark.parametrize("test", OF_MEMBERS.values(), ids=OF_MEMBERS)
def test_on_which_links_something_was_seen_does_not_matter_where_only_the_members_are_asked(test):
    assert stale(looks_around(test, HANDS_OVER)) == set()
    assert stale(looks_around(test, GOES_OFF)) == {"a"}


@pytest.mark.parametrize("test", OF_ALL)
def test_who_asks_of_a_whole_observation_or_of_one_in_a_set_rests_on_all_that_it_says(test):
    assert stale(looks_around(f"if {test}", HANDS_OVER)) == {"a"}


# --- what is told of them -------------------------------------------------------------------------------------

MOVED_BY_A_PILOT = written("""
a@uav0: LOOKS react { case o if not (uav1 in o) => ENTER case o => skip }
b@gcs0: control(MOVE uav0 TO south0)
""")


@pytest.mark.parametrize("control", CONTROLS)
@pytest.mark.parametrize("scheduler", ["unordered", "program_order", "fcfs"])
def test_two_that_look_before_they_enter_are_racing_though_their_moves_commute(scheduler, control):
    text = BOTH_LOOK + f"scheduler {scheduler}\ncontrol {control}\n"
    assert stale(text) == {"a", "b"}
    assert {each.kind for each in verdict(text, "race_freedom").violations} == {STALE}


def test_a_stale_observation_is_told_with_the_query_and_the_test_and_a_shortest_trace():
    race = violation(verdict(BOTH_LOOK, "race_freedom"), STALE)
    assert race.message == (
        "CTR(b, MOVE_HOST_TO gate0) depends on whether observe(CHILDREN(gate0)) shows "
        "uav0, and another agent has changed that answer since then"
    )
    assert race.details == (
        "sensed in step 7: ⟨sense : OBS(b, CHILDREN(gate0))⟩, asked in line 31",
        "changed by a in step 8: ⟨actuate : CTR(a, MOVE_HOST_TO gate0)⟩, asked in line 27",
        "acted on in step 12: ⟨actuate : CTR(b, MOVE_HOST_TO gate0)⟩, asked in line 32",
    )
    assert len(race.trace) == 12  # each looks and asks in 5 steps, and both are served
    pilot = violation(verdict(MOVED_BY_A_PILOT, "race_freedom"), STALE)
    assert pilot.message.endswith("another agent has changed a relation that it uses since then")


@pytest.mark.parametrize("operator", sorted(OPERATORS))
def test_whatever_is_asked_of_an_observation_is_told_in_words(operator):
    seen = Observation.of(shown=["uav0"])
    for key in OPERATORS[operator].asks(*[seen] * OPERATORS[operator].arity):
        told = asked_in_words(Dependency(Nodes(("place0",)), (), asked=key))
        assert "observe(place0)" in told
        assert told.startswith(("all that ", "which ", "how ", "whether ", "where ", "what ", "the "))


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
check { race_freedom }
"""
PUSHES = """
BigActor a hosted_at gcs0 with_behavior { choose p in {gate0, south0} { control(MOVE uav0 TO p) } }
BigActor b hosted_at gcs0 with_behavior {
  choose p in {gate0, south0} {
    control(MOVE uav0 TO p)
  }
}
check { race_freedom }
"""


@pytest.mark.parametrize("engine", [Engine.REFERENCE, Engine.FAST])
@pytest.mark.parametrize(("text", "kind"), [(TWINS, STALE), (PUSHES, "control race")])
def test_races_about_the_same_places_of_the_text_are_one_and_the_others_counted(text, kind, engine):
    mission = load(text)
    found = check(mission, engine=engine).verdicts[0]
    (one,) = found.violations
    assert (one.kind, one.alike, found.different) == (kind, 1, 2)


WAITS_IN_THE_QUEUE = """\
mission queued

signature {
  kind Location contains Location, UAV
  kind UAV driven
}

world {
  west0: Location = box (37.04, -8.7) (36.94, -8.79)
  middle0: Location = box (37.04, -8.61) (36.94, -8.69)
  east0: Location = box (37.04, -8.51) (36.94, -8.59)
  uav0: UAV = point (37.0, -8.65)
  uav1: UAV = point (37.0, -8.62)
}

BigActor a hosted_at uav0 with_behavior {
  observe(CHILDREN(east0))
  react { case o => control(MOVE_HOST_TO west0) if not (uav1 in o) { control(MOVE_HOST_TO east0) } }
}

BigActor b hosted_at uav1 with_behavior {
  react { after 20 s => control(MOVE_HOST_TO east0) }
}

scheduler fcfs
control timed

timing {
  tick 5 s
  uav0 flies at 20 m/s to 20 m/s
  uav1 flies at 100 m/s to 100 m/s
  agents react within 5 s
  sense within 5 s
}

check { race_freedom }
"""
"""The second request of `a` waits in the queue while `b` changes what `a` has seen; it was asked for before that."""


def test_a_request_goes_stale_while_it_waits_in_the_one_queue_of_all():
    found = check(read_mission(WAITS_IN_THE_QUEUE, "."), engine=Engine.REFERENCE).verdicts["race_freedom"]
    assert found.violations[0].message.startswith("CTR(a, MOVE_HOST_TO east0) depends on whether")


# --- what is forgotten ----------------------------------------------------------------------------------------

EVERY = frozenset(
    {(kind, ANY) for kind in ("in", "parent", "children", "links")} | SLOTS | {MEMBERS, SIZE, EVERYTHING}
)


class All:
    def __contains__(self, _):
        return True


def first_races(c):
    """Return each stale-observation race with how many steps lead to it, or None where the search is cut off."""
    races = StaleObservationRaces()
    found = explore(monitored(c), (races,), Limits(configurations=4_000))
    if not found.complete:
        return None
    return {key: len(found.path(finding.at)) for key, finding in races.collected.first.items()}


def remembering_everything(c):
    with pytest.MonkeyPatch.context() as patch:
        for name in ("questions_of", "anybodys", "slots_of"):
            patch.setattr(monitor, name, lambda *_: EVERY)
        for module, name in (
            (monitor, "heirs"),
            (process_conversion, "heirs"),
            (monitor, "possible_receivers"),
            (bigactor_rules, "possible_receivers"),
        ):
            patch.setattr(module, name, lambda *_: frozenset({ANY}))
        for module in (monitor, process_conversion):
            patch.setattr(module, "communicated_variables", lambda *_: All())
        patch.setattr(process_conversion, "uses_host", lambda *_: True)
        return first_races(c)


@pytest.mark.long
@pytest.mark.parametrize("path", MISSIONS, ids=lambda path: path.stem)
def test_what_a_mission_lets_the_monitor_forget_would_have_made_no_race(path):
    c = load_mission(path).initial
    assert remembering_everything(c) in (None, first_races(c))


@examples(100 if IS_WHOLE else 30)
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


KEPT_TO_ITSELF = written("""
look@gcs0: LOOKS react { case o => send(("free", size(o of UAV)), a) }
a@uav0: LOOKS ENTER react { case (word, n) if n == 0 => NORTH }
        react { case o: Observation if uav0 in o => control(MOVE_HOST_TO south0) }
""")


def test_what_its_holder_changes_is_not_remembered_where_it_tells_nobody():
    held = []
    for c in explore(monitored(load(KEPT_TO_ITSELF).initial)).configurations:
        for step in expand(c).by_agents:
            if step.label.rule in monitor.CONTROLS and step.label.agent == "a":
                assert received(step.target) == received(c)
                held.append(received(c))
    assert any(mail for mail, _ in held)
    assert any(seen for _, seen in held)


def received(c):
    """Return what it rests on that a has in its mailbox, and that it has been shown."""
    return list(filter(None, c.alpha.watch("a").mailbox)), [each.rests_on for each in c.eta.ready("a")]


# --- what is asked again --------------------------------------------------------------------------------------

CHANGES = written("""
a@gcs0: control(MOVE uav0 TO gate0)
b@gcs0: control(HAND uav0 TO gcs1)
c@vessel0: control(MOVE_HOST_TO gate0)
d@vessel0: control(DISCONNECT_HOST_FROM uav0)
""")
"""Controls that move a node, with or without cargo, or change its links."""

WIDE = WORLD.replace("kind Vessel driven carries", "kind Vessel driven contains UAV carries").replace(
    "point (36.975, -8.69)", "circle (36.98, -8.70) radius 100 m"
)
"""The vessel is a place too: it goes away from under uav1."""


def queries(operators):
    """Return the queries of some nodes with so many operators."""
    if operators == 0:
        return (Everyone(), *(Nodes((name,)) for name in ("uav0", "vessel0", "gate0")))
    return tuple(Of(operator, inner) for operator in QueryOperator for inner in queries(operators - 1))


def asked_in_full(before, after, steps):
    """Return what has changed of a query, by asking all of it before and after; and its steps resolved anew."""
    (old, was), (new, now) = ((c.structure.physical, c.alpha) for c in (before, after))
    anew, same = steps[:1], True
    for step in steps[1:]:
        same = same and denoted(anew, old, was) == denoted(anew, new, now)
        anew += (step if same else QueryStep(step.operator, denoted(anew, new, now)),)
    keys = set(differences(answers(steps, old, was), answers(anew, new, now)))
    for name in old.entities():
        places = {p.abstract_parent(name) for p in (old, new)}
        if len(places) > 1:
            keys |= {("slot parent", name), *(("slot children", place) for place in places)}
        if old.links(name) != new.links(name):
            keys.add(("slot links", name))
    return frozenset(keys), anew


@pytest.mark.parametrize("world", [WORLD, WIDE], ids=["point", "place"])
def test_of_each_query_what_a_control_changes_is_what_asking_all_of_it_again_shows(world):
    first, served = start(CHANGES, world), {}
    for c in explore(first).configurations:
        for step in expand(c).by_agents:
            if step.label.rule in monitor.CONTROLS:
                served[step.label.agent] = (c, step.target)  # the last: much has changed before
    assert len(served) == 4
    changed = 0
    for before, after in served.values():
        for query in (each for operators in range(3) for each in queries(operators)):
            steps = resolve(query, first.structure.physical, first.alpha)
            found, anew = asked_in_full(before, after, steps)
            assert monitor.asked_again(before, after, steps, EVERY) == (found, anew)
            for key in sorted(found)[:: len(steps)]:
                assert monitor.asked_again(before, after, steps, frozenset({key})) == ({key}, anew)
            changed += bool(found)
    assert changed > 100


# --- by definition --------------------------------------------------------------------------------------------


@examples(300 if IS_WHOLE else 120)
@given(
    st.one_of(companies(), chains()),
    st.sampled_from(CONTROLS),
    st.sampled_from(["", "", "environment { observe may miss UAV, gate0, vessel0 }"]),
    st.integers(0, 1 << 32),
)
def test_in_a_run_each_control_is_stale_that_is_so_by_definition_and_no_other(company, control, missed, seed):
    first = WORLD.count("\n") + 1
    try:
        c = monitored(start(text_of(company, first) + f"control {control}\n{missed}"))
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
