"""What is learned about one name holds for those that the mission does not tell from it."""

from contextlib import suppress
from dataclasses import replace
from itertools import combinations, product
from pathlib import Path

import pytest
from checked_missions import load
from hypothesis import given
from scale import examples
from shipped import UNTIMED
from test_symmetry import swarm, swarms

from checker import Engine, Limits, explore
from checker.engines.fast.lessons import Exchange, Lesson, Lessons, NoImage
from checker.engines.fast.likeness import Likeness
from checker.engines.fast.recording import Ask
from checker.engines.fast.trees import LearningError
from checker.reduction.renaming import Renaming
from semantics.behaviours.expressions import Fault
from semantics.behaviours.observations import Nodes, agent_key
from semantics.state.cells import is_
from semantics.state.requests import OBS
from semantics.state.signature import REGION
from specs.elaboration import load_mission

MISSIONS = Path(__file__).parents[3] / "specs" / "missions"

FLEET = """mission fleet
signature {{ kind Room contains Robot kind Robot driven }}
world {{
  room0: Room = box (0.001, 0.001) (-0.001, -0.001)
  room1: Room = box (0.001, 0.004) (-0.001, 0.002)
{robots}
}}
def look() = {{ loop {{ observe(CHILDREN(room1)) react {{ case seen => control(MOVE_HOST_TO room1) }} }} }}
{agents}
{rest}
"""


def fleet(robots, rest=""):
    there = "\n".join(f"  robot{n}: Robot = point (0.0, {0.0001 * n:.4f})" for n in range(robots))
    agents = "\n".join(f"BigActor r{n} hosted_at robot{n} with_behavior {{ look() }}" for n in range(robots))
    return load(FLEET.format(robots=there, agents=agents, rest=rest), "").initial


def both(initial, monkeypatch, **options):
    """Explore as ever, and with nothing shared; return both."""
    shared = explore(initial, engine=Engine.FAST, **options)
    with monkeypatch.context() as patched:
        patched.setattr(Likeness, "models", lambda *_: {})
        patched.setattr(Likeness, "agents", {})
        return shared, explore(initial, engine=Engine.FAST, **options)


def assert_alike(shared, apart):
    assert list(shared.configurations) == list(apart.configurations)
    assert list(shared.origins) == list(apart.origins)
    assert (shared.rules, shared.complete, shared.bounds) == (apart.rules, apart.complete, apart.bounds)


@pytest.mark.parametrize("name", UNTIMED)
def test_a_mission_that_ships_is_explored_as_if_nothing_were_shared(name, monkeypatch):
    initial = load_mission(MISSIONS / f"{name}.mission").initial
    assert_alike(*both(initial, monkeypatch, limits=Limits(configurations=3_000)))


HOSTS = """
control atomic
scheduler unordered
BigActor base hosted_at gcs0 with_behavior { observe(HOSTED_AT(ALL)) react { case o => skip } }
environment { robot0 vanishes robot1 vanishes }
"""


def test_who_is_hosted_where_is_learned_agent_by_agent(monkeypatch):
    assert_alike(*both(load(swarm("migrate(gcs0)", 2, HOSTS), "").initial, monkeypatch))


@given(text=swarms())
@examples(40)
def test_generated_swarms_are_explored_as_if_nothing_were_shared(text):
    with pytest.MonkeyPatch.context() as monkeypatch:
        assert_alike(*both(load(text, "").initial, monkeypatch, limits=Limits(configurations=700)))


def test_a_fleet_three_times_as_large_takes_no_more_runs_of_rules(monkeypatch):
    limits = Limits(configurations=500)
    runs = []
    for robots in (6, 18):
        shared, apart = both(fleet(robots), monkeypatch, limits=limits)
        assert_alike(shared, apart)
        assert 5 * shared.rule_runs < apart.rule_runs
        runs.append(shared.rule_runs)
    assert runs[1] <= runs[0]


def test_whom_the_text_names_is_like_nobody():
    named = 'BigActor base hosted_at robot0 with_behavior { observe(CHILDREN(PARENT("robot1"))) }'
    likeness = Likeness(fleet(4, named.replace('"', "")).setting, fleet(4).state, frozenset(), frozenset())
    assert [likeness._first(f"robot{n}") for n in range(4)] == ["robot0", "robot1", "robot0", "robot0"]


def test_what_may_appear_is_not_like_what_is_there():
    initial = fleet(3, "environment { robot2 vanishes }")
    likeness = Likeness(initial.setting, initial.state, frozenset(), frozenset())
    assert [likeness._first(f"robot{n}") for n in range(3)] == ["robot0", "robot0", "robot2"]


SWAP = Exchange(frozenset(), unordered=True).then("b", "d")


@pytest.mark.parametrize(
    ("ask", "image"),
    [
        (
            Ask(("parent", "b"), None, is_, ("room0", "d")),
            Ask(("parent", "d"), None, is_, ("room0", "b")),
        ),
        (Ask(("mailbox", "a"), (0, "b")), Ask(("mailbox", "a"), (0, "d"))),
        # who is hosted somewhere, as an observation says of an agent
        (Ask(("mailbox", "a"), (0, agent_key("b"))), Ask(("mailbox", "a"), (0, agent_key("d")))),
    ],
)
def test_a_question_is_renamed_in_all_that_it_is_about(ask, image):
    assert SWAP.ask(ask) == image
    assert SWAP.inverse.ask(image) == ask


def test_rules_go_through_names_in_their_order():
    assert SWAP.keeps_order({"a", "b"})
    assert not SWAP.keeps_order({"b", "c"})
    assert not SWAP.keeps_order({"b", "d"})


def test_what_has_an_order_of_its_own_is_not_renamed():
    first, second = OBS("b", Nodes(("a",))), OBS("b", Nodes(("c",)))
    assert SWAP.value(("line", "b"), (first,)) == (OBS("d", Nodes(("a",))),)
    with pytest.raises(NoImage):
        SWAP.value(("line", "b"), (first, second))
    assert len(replace(SWAP, unordered=False).value(("line", "b"), (first, second))) == 2


def test_a_word_that_is_displayed_may_not_be_a_name():
    assert SWAP.shown("at a") == "at a"
    with pytest.raises(NoImage):
        SWAP.shown("at b")


def test_of_those_that_are_alike_none_asks_what_another_does_not():
    lessons, lesson = Lessons(), Lesson(0, (), frozenset(), {}, {}, frozenset())
    lessons.learn({Ask(("code", "a")): (1,), Ask(("store", "a")): ()}, lesson)
    assert lessons.find({Ask(("code", "a")): (1,), Ask(("store", "a")): ()}.__getitem__) is lesson
    assert lessons.find({Ask(("code", "a")): (2,)}.__getitem__) is None
    for asked in ({Ask(("code", "a")): (1,)}, {Ask(("store", "a")): ()}, {}):
        with pytest.raises(LearningError):
            lessons.learn(asked, lesson)


# --- what likeness rests on -----------------------------------------------------------------------------------

OWN = """
rule drop(x: Robot) { x[mesh] || HOST[mesh] -> x[] || HOST[mesh] }
rule drop_first(x: Robot) { x[mesh] || robot0[mesh] -> x[] || robot0[mesh] }
"""


def tried(make, one, other, names):
    """Tell whether a rule treats two names alike, by trying it with all hosts and arguments."""
    renaming = Renaming({one: other, other: one})

    def made(*chosen):
        with suppress(Fault):
            return make(*chosen)

    return all(
        (None if (found := made(*chosen)) is None else renaming.value(found))
        == made(*map(renaming.name, chosen))
        for chosen in product(names, repeat=2)
    )


@pytest.mark.parametrize(("rule", "apart"), [("drop", set()), ("drop_first", {"robot0"})])
def test_a_rule_says_whom_it_tells_apart(rule, apart):
    uses = " ".join(f"control({each}(HOST))" for each in ("drop", "drop_first"))
    agent = f"BigActor base hosted_at robot0 with_behavior {{ {uses} }}"
    setting = fleet(3, f"{OWN}{agent}").setting
    make, names = setting.program.reactions[rule], sorted(setting.kinds)
    assert {name for name in names if name in make.mentions} == apart
    for one, other in combinations([name for name in names if setting.kind(name) == "Robot"], 2):
        assert tried(make, one, other, names) is apart.isdisjoint({one, other})


@pytest.mark.parametrize("name", UNTIMED)
def test_beliefs_are_sorted_so_nothing_is_below_a_node_whose_kind_holds_nothing(name):
    initial = load_mission(MISSIONS / f"{name}.mission").initial
    signature, kind = initial.setting.signature, initial.setting.kind
    for c in explore(initial, engine=Engine.FAST, limits=Limits(configurations=2_000)).configurations:
        logical = c.structure.logical
        places = {node: logical.parent(node) for node in logical.nodes()}
        for node, place in places.items():
            assert place == REGION or signature[kind(place)].may_contain(kind(node))
