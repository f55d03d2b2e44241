"""Properties of runs under reductions: decided as by the full search, by runs of the mission, or refused."""

from contextlib import suppress
from dataclasses import replace
from functools import reduce

import pytest
from checked_missions import load, visited
from hypothesis import given
from hypothesis import strategies as st
from mission_texts import missions
from random_formulas import atoms_of, branching, linear, shared_atoms_of, violates
from replaying import assert_replays
from scale import IS_WHOLE, examples
from swarms import LOOKS, STEPS, swarm, swarms
from test_partial_order import fleets

from checker import Engine, Limits, Outcome, Reduction, RefusedError, check, explore
from checker.reduction import Reduced
from checker.reduction.ample import Ample
from checker.reduction.configuration_renaming import Renaming
from checker.reduction.conjunct_orbits import image
from checker.reduction.visible_slots import Eyes
from semantics.properties.kinds import PropertyKind
from semantics.properties.property import Property
from semantics.properties.propositions import Ended, HasPending, Inside, Waiting
from semantics.properties.temporal import ENVIRONMENTS, Both, Enabled, Fairness, Steps, atoms
from specs import MissionError

POR, SYMMETRY = (Reduction.POR,), (Reduction.SYMMETRY,)
BOTH = POR + SYMMETRY
MOST = Limits(configurations=300)
ENGINES = [Engine.REFERENCE, Engine.FAST]


# --- beside the full search -----------------------------------------------------------------------------------


def compared(initial, asked, reductions, most=MOST, engine=Engine.REFERENCE):
    """Assert that a reduced search decides properties as the full one does, or refuses them; return how many."""
    full = check(initial, asked, limits=most, engine=Engine.REFERENCE)
    if not full.complete:
        return 0
    found = check(initial, asked, limits=most, engine=engine, reduce=reductions)
    assert_replays(found)
    decided = 0
    for one, other in zip(found.verdicts, full.verdicts, strict=True):
        if one.outcome is Outcome.INCOMPLETE:
            assert one.note.startswith("not decided under this reduction: "), one.note
            continue
        decided += 1
        assert one.outcome is other.outcome, one.property
        for each in one.violations if one.property.kind is PropertyKind.LTL else ():
            if not any(isinstance(atom, Enabled) for atom in atoms(one.property.temporal)):
                assert violates(each.trace, one.property.temporal), one.property
    return decided


def drawn(data, initial, atom, fairness=((),), *, counting=False):
    """Return some properties of runs."""
    fair = st.sampled_from(fairness)
    formulas = [linear(initial, atom, counting=counting)] * 3
    formulas += [branching(initial, atom, counting=counting)] * 2 * data.draw(st.booleans())
    kinds = [PropertyKind.LTL] * 3 + [PropertyKind.CTL] * 2
    return [
        Property(kind, f"p{number}", temporal=data.draw(formula), fairness=data.draw(fair))
        for number, (kind, formula) in enumerate(zip(kinds, formulas, strict=False))
    ]


TEXTS = st.builds(
    "{}{}".format, st.one_of(missions(), fleets()), st.sampled_from(["", "scheduler unordered\n"])
)


@given(TEXTS, st.data())
@examples(150 if IS_WHOLE else 45)
def test_por_decides_formulas_of_generated_missions_as_the_full_search_does(text, data):
    with suppress(MissionError):  # some are found wrong before they are run
        initial = load(text).initial
        compared(initial, drawn(data, initial, atoms_of(initial)), POR)


OF_ALL = (
    (),
    (),
    (Fairness(False, Steps(ENVIRONMENTS), (), "environment"),),
    (Fairness(True, Steps(("sense",)), (), "sense"),),
    (Fairness(False, Steps((), "base"), (), "base"),),
    (Fairness(False, Steps(), ("agent",), "agents"),),
    (Fairness(False, Steps((), "r0"), (), "r0"),),
)


def of_each(formula, robots):
    """Return the conjunction of a formula about robot0 and its images about the other ones."""
    swaps = (
        Renaming({"robot0": f"robot{k}", f"robot{k}": "robot0", "r0": f"r{k}", f"r{k}": "r0"})
        for k in range(1, robots)
    )
    return reduce(Both, (image(formula, swap) for swap in swaps), formula)


OWN = [each for each in STEPS if "base" not in each]
"""Steps that need no other bigActor."""


@given(st.sampled_from(OWN), st.sampled_from(OWN), st.data())
@examples(60 if IS_WHOLE else 15)
def test_conjuncts_about_each_of_a_swarm_are_decided_as_by_the_full_search(one, other, data):
    initial = load(swarm(f"choose {{ {one} }} or {{ {other} }}", 3), "").initial
    about_one = st.one_of(
        st.builds(Inside, st.just("robot0"), st.sampled_from(["room0", "dock0"]), st.booleans()),
        *(st.builds(atom, st.just("r0")) for atom in (Ended, Waiting, HasPending)),
    )
    asked = [
        replace(each, temporal=of_each(each.temporal, 3)) for each in drawn(data, initial, about_one, OF_ALL)
    ]
    with suppress(RefusedError):
        compared(initial, asked, data.draw(st.sampled_from([SYMMETRY, BOTH])), Limits(configurations=600))


@given(swarms(), st.data())
@examples(120 if IS_WHOLE else 30)
def test_symmetry_decides_formulas_of_generated_swarms_as_the_full_search_does(text, data):
    initial = load(text, "").initial
    shared = shared_atoms_of(initial)
    atom = st.one_of(shared, shared, shared, atoms_of(initial))
    asked = drawn(data, initial, atom, OF_ALL, counting=data.draw(st.booleans()))
    asked.append(Property(PropertyKind.DEADLOCK_FREEDOM, "d", fairness=data.draw(st.sampled_from(OF_ALL))))
    with suppress(RefusedError):
        compared(initial, asked, data.draw(st.sampled_from([SYMMETRY, BOTH])))


# --- what each condition is for -------------------------------------------------------------------------------

APART = """
signature standard
world {
  p0: Location = box (37.04, -8.59) (37.03, -8.60)
  p2: Location = box (37.00, -8.59) (36.99, -8.60)
  q0: Location = box (38.04, -8.59) (38.03, -8.60)
  q2: Location = box (38.00, -8.59) (37.99, -8.60)
  a0: UAV = point (38.035, -8.595)
  z0: UAV = point (37.035, -8.595)
}
"""
CIRCLES = """
BigActor a hosted_at a0 with_behavior {
  loop { observe(PARENT(HOST)) react { case o => choose { skip } or { control(MOVE_HOST_TO q2) } } }
}
BigActor z hosted_at z0 with_behavior { control(MOVE_HOST_TO p2) }
check { ltl "follows": actually z0 in p2 leads to actually a0 in q2 }
"""
"""Of a's two ways one circles: z moves before a goes away only where the search does not leave z out on that circle."""

LOOKING = "".join(
    f"BigActor {each} hosted_at {each}0 with_behavior {{ observe(PARENT(HOST)) react {{ case o => skip }} }}\n"
    for each in "az"
)
IN_TURN = f"""{LOOKING}
check {{
  ltl "a looks first": not taken sense z W taken sense a
  ltl "z looks first": not taken sense a W taken sense z
}}
"""
OPEN = """
BigActor a hosted_at a0 with_behavior { choose { control(MOVE_HOST_TO q2) } or { skip } }
BigActor z hosted_at z0 with_behavior { control(MOVE_HOST_TO p2) }
check { ctl "open": EF (actually z0 in p2 and (EF actually a0 in q2) and EF AG not actually a0 in q2) }
"""
"""Where z has moved, a may still have both ways before it."""

AGAIN = """
BigActor a hosted_at a0 with_behavior { loop { react { case "go" => skip after 5 s => skip } } }
BigActor z hosted_at z0 with_behavior { control(MOVE_HOST_TO p2) }
check { ltl "z stays": [] not actually z0 in p2 }
"""
"""A step of a leads back to the same configuration."""

CONDITIONS = pytest.mark.parametrize(
    "text", [CIRCLES, IN_TURN, OPEN, AGAIN], ids=["circles", "in turn", "open", "again"]
)


def outcomes(text, reductions=(), engine=Engine.REFERENCE, world=APART):
    """Return the outcomes of a mission's properties of runs, and whether steps were left out."""
    found = check(load(text, world), reduce=reductions, engine=engine)
    assert_replays(found)
    of_runs = [each for each in found.verdicts if each.property.is_of_runs]
    return [each.outcome for each in of_runs], found.transitions < found.allowed


@pytest.mark.parametrize("engine", ENGINES)
@CONDITIONS
def test_por_decides_what_needs_a_condition_of_its_own(text, engine):
    right, _ = outcomes(text)
    assert outcomes(text, POR, engine) == (right, True)


MUTANTS = {
    "the proviso of safety": (CIRCLES, "forward"),
    "sets of several steps": (OPEN, "single"),
    "steps that nobody sees": (IN_TURN, "eyes"),
}


@pytest.mark.parametrize(("text", "without"), MUTANTS.values(), ids=MUTANTS)
def test_without_the_condition_the_verdict_would_be_wrong(text, without, monkeypatch):
    right, make = outcomes(text)[0], Ample.__init__

    def made(ample, *given):
        make(ample, *given)
        if without != "eyes":
            setattr(ample, without, False)

    monkeypatch.setattr(Ample, "__init__", made)
    if without == "eyes":
        monkeypatch.setattr(Eyes, "names", lambda *_: False)
    assert outcomes(text, POR)[0] != right


def test_searches_without_formulas_of_runs_choose_the_sets_that_they_chose():
    text = CIRCLES.split("check", maxsplit=1)[0]
    fair = 'check { deadlock_freedom under weak fairness of environment ltl "x": X actually z0 in p2 }'
    one, other = (check(load(f"{text}{rest}", APART), reduce=POR) for rest in ("", fair))
    assert (one.configurations, one.transitions) == (other.configurations, other.transitions)


@CONDITIONS
def test_both_explorers_choose_the_same_sets_for_formulas(text):
    mission = load(text, APART)
    slow, fast = (
        explore(mission.initial, engine=engine, reduce=Reduced(mission.initial, POR, (), mission.properties))
        for engine in ENGINES
    )
    assert visited(fast) == visited(slow)


# --- symmetry -------------------------------------------------------------------------------------------------

EACH = """check {
  ctl "each may be the first to ask": forall x: agents . EX EX pending OBS x
  ltl "each is inside now and then": forall x: Robot . [] <> actually x in room0
  ltl "one looks": <> taken sense r0
  ltl "somebody looks": <> taken sense
  ctl "somebody may be the first to ask": EX EX exists x: agents . pending OBS x
  ltl "all come in": <> forall x: Robot . actually x in room0
  ltl "nobody is alone inside": not <> (exists x: Robot . actually x in room0)
}
"""


@pytest.mark.parametrize("engine", ENGINES)
def test_a_formula_of_symmetric_parts_is_decided_and_one_about_each_only_where_others_are_left(engine):
    for robots, others in ((3, True), (2, False)):
        right, _ = outcomes(swarm(LOOKS, robots, EACH), world="")
        found, _ = outcomes(swarm(LOOKS, robots, EACH), SYMMETRY, engine, world="")
        assert found == (right if others else [Outcome.INCOMPLETE] * 3 + right[3:])


def test_if_asymmetric_parts_were_taken_for_symmetric_the_verdict_would_be_wrong(monkeypatch):
    text = swarm(LOOKS, 3, EACH)
    right, _ = outcomes(text, world="")
    monkeypatch.setattr("checker.reduction.preserved_runs.changing", lambda *_: None)
    found, _ = outcomes(text, SYMMETRY, world="")
    assert (found[0], right[0]) == (Outcome.VIOLATED, Outcome.HOLDS)


def test_a_formula_about_one_leaves_the_others_interchangeable():
    asked = 'check { ltl "comes in": <> actually robot0 in room0 ltl "looks": [] not taken sense r0 }'
    mission = load(swarm(LOOKS, 3, asked), "")
    found = check(mission, reduce=SYMMETRY)
    assert [each.outcome for each in found.verdicts if each.property.is_of_runs] == outcomes(
        swarm(LOOKS, 3, asked), world=""
    )[0]
    every = check(load(swarm(LOOKS, 3, "check { deadlock_freedom }"), ""), reduce=SYMMETRY).configurations
    assert every < found.configurations < check(mission).configurations


LOOK = "observe(PARENT(HOST)) react { case o => skip }"


def test_one_conjunct_stands_for_those_that_exchanges_map_to_it():
    body = f"choose {{ control(MOVE_HOST_TO room0) {LOOK} }} or {{ skip }}"
    asked = """check {
      ltl "each comes in": forall u: Robot . <> actually u in room0
      ltl "each stays": forall u: Robot . [] (actually u in room0 -> [] actually u in room0)
      ctl "each may come in": forall u: Robot . EF actually u in room0
    }
    """
    text = swarm(body, 3, asked)
    right, _ = outcomes(text, world="")
    assert right == [Outcome.VIOLATED, Outcome.HOLDS, Outcome.HOLDS]
    for reductions in (SYMMETRY, BOTH):
        found = check(load(text, ""), reduce=reductions)
        assert [each.outcome for each in found.verdicts if each.property.is_of_runs] == right
        assert violates(
            found.verdicts["each comes in"].violations[0].trace, found.verdicts[0].property.temporal
        )


ROUNDS = swarm(
    f"loop {{ control(MOVE_HOST_TO room0) {LOOK} control(MOVE_HOST_TO dock0) {LOOK} }}",
    2,
    """check {
  ltl "both inside only finitely often": not [] <> (forall u: Robot . actually u in room0)
  ltl "never somebody inside for ever": not <> [] (exists u: Robot . actually u in room0)
}
""",
)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("reductions", [SYMMETRY, BOTH], ids=["symmetry", "both"])
def test_a_loop_of_representatives_goes_round_until_the_mission_s_own_run_closes(reductions, engine):
    mission = load(ROUNDS, "")
    found = check(mission, reduce=reductions, engine=engine)
    assert_replays(found)
    for verdict in found.verdicts:
        for each in verdict.violations:
            assert each.trace.configurations[each.trace.loop] == each.trace.configurations[-1]
            assert violates(each.trace, verdict.property.temporal)
    assert [len(each.violations) for each in found.verdicts if each.property.is_of_runs] == [1, 1]


WAITS = swarm('send "on" to base', 2, "BigActor base hosted_at gcs0 with_behavior { skip }\n"
    "environment { mesh drops }\ncheck { deadlock_freedom under weak fairness of environment }")  # fmt: skip


@pytest.mark.parametrize("reductions", [POR, SYMMETRY, BOTH], ids=["por", "symmetry", "both"])
def test_a_deadlock_under_fairness_is_told_in_the_names_of_its_run(reductions):
    mission = load(WAITS, "")
    right, found = (check(mission, reduce=each).verdicts["deadlock_freedom"] for each in ((), reductions))
    assert right.outcome is found.outcome is Outcome.VIOLATED
    for each in found.violations:
        pending = {str(one.request) for one in each.trace.configurations[-1].eta.all()}
        assert any(request in each.message for request in pending)


# --- refused --------------------------------------------------------------------------------------------------

REFUSED = {
    "X": (POR, 'ltl "p": X actually robot0 in room0', "'X' counts steps"),
    "next in ctl": (POR, 'ctl "p": EX actually robot0 in room0', "'X' counts steps"),
    "enabled": (POR, 'ltl "p": [] not enabled sense r0', "'enabled' asks which steps are possible"),
    "the next step": (POR, 'ltl "p": taken req_obs r0', "'taken' asks here for the very next step"),
    "fairness": (POR, 'ltl "p" under weak fairness of agents: <> ended r0', "fairness asks which steps stay enabled"),
    "progress": (POR, "progress", "fairness asks which steps stay enabled"),
    "progress of likes": (SYMMETRY, "progress", "progress follows each request by its name"),
    "fairness to likes": (
        SYMMETRY,
        'ltl "p" under weak fairness of agents: <> exists x: agents . ended x',
        "weak fairness of agents is owed to each by its name",
    ),
    "each": (SYMMETRY, 'ltl "p": forall x: agents . <> ended x', "it asks of 'r0' at some moment what it does not"),
}  # fmt: skip


@pytest.mark.parametrize("why", REFUSED)
def test_it_is_incomplete_with_the_reason(why):
    reductions, asked, reason = REFUSED[why]
    verdict = check(load(swarm(LOOKS, 2, f"check {{ {asked} }}"), ""), reduce=reductions).verdicts[0]
    assert verdict.outcome is Outcome.INCOMPLETE
    assert reason in verdict.note


def test_without_a_deadlock_none_is_left_under_a_fairness_that_is_not_preserved():
    text = swarm(LOOKS, 2, "check { deadlock_freedom under weak fairness of agents }")
    (verdict,) = (each for each in check(load(text, ""), reduce=SYMMETRY).verdicts if each.property.fairness)
    assert verdict.outcome is Outcome.HOLDS
