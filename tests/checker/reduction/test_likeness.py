"""What is learned about one name holds for those that the mission does not tell from it."""

import random
from contextlib import suppress
from dataclasses import replace
from itertools import combinations, product

import pytest
from checked_missions import load, visited
from hypothesis import given
from hypothesis import strategies as st
from scale import IS_WHOLE, examples, seeds, some_long
from shipped import TIMED, UNTIMED
from swarms import swarms
from timed_missions import alike_timings, with_timing
from timed_reports import assert_alike

from checker import Engine, Limits, check, explore
from checker.engines.fast.model.interchangeable import Likeness
from checker.engines.fast.model.rule_cache import Exchange, NoImage
from checker.recording.access_recording import ColumnQuestion
from checker.reduction.configuration_renaming import Renaming
from semantics.behaviours.expressions import Fault
from semantics.behaviours.observations import Nodes, agent_key
from semantics.behaviours.values import Text, show
from semantics.properties.kinds import PropertyKind
from semantics.properties.property import Property
from semantics.state.cell_values import is_
from semantics.state.configuration import Label
from semantics.state.requests import OBS
from semantics.state.signature import REGION
from semantics.timing.timing import Endurance, Motion, Timing
from specs.elaboration import load_mission

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


def both(initial, most):
    """Explore as ever, and with nothing shared; return both, once they are alike."""
    options = {"engine": Engine.FAST, "limits": Limits(configurations=most)}
    shared = explore(initial, **options)
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(Likeness, "models", lambda *_: {})
        patched.setattr(Likeness, "agents", {})
        apart = explore(initial, **options)
    assert visited(shared) == visited(apart)
    assert zones(shared) == zones(apart)
    return shared, apart


def zones(found):
    """The number of zones in a mission with times."""
    return None if found.times is None else found.times.search.count


def runs_of(found):
    """How often rules were run, in a mission with times."""
    return found.times.network.learner.runs


@pytest.mark.parametrize("name", some_long([*UNTIMED, *TIMED]))
def test_a_mission_that_ships_is_explored_as_if_nothing_were_shared(name):
    both(load_mission(name).initial, 800 if IS_WHOLE else 400)


@given(text=swarms())
@examples(40 if IS_WHOLE else 18)
def test_generated_swarms_are_explored_as_if_nothing_were_shared(text):
    both(load(text, "").initial, 400)


@given(data=st.data(), text=swarms())
@examples(40 if IS_WHOLE else 12)
def test_generated_swarms_with_times_are_explored_as_if_nothing_were_shared(data, text):
    initial = load(text, "").initial
    both(with_timing(initial, data.draw(alike_timings(initial.setting))), 200)


def timed_fleet(speeds, lasting):
    """A fleet with the speeds of its robots, and with the ticks for which each can fly."""
    names = [f"robot{n}" for n in range(len(speeds))]
    timing = Timing(
        60_000,
        tuple((name, Motion((speed, speed))) for name, speed in zip(names, speeds, strict=True)),
        tuple((name, Endurance(each, ("room0",), 1)) for name, each in zip(names, lasting, strict=True)),
    )
    return with_timing(fleet(len(speeds), "control timed"), timing)


@pytest.mark.parametrize(
    ("speeds", "lasting", "alike"),
    [((40, 40, 40), (9, 9, 9), 3), ((40, 50, 40), (9, 9, 9), 2), ((40, 40, 40), (9, 9, 8), 2)],
)
def test_vehicles_with_equal_times_share_lessons_and_others_do_not(speeds, lasting, alike):
    initial = timed_fleet(speeds, lasting)
    likeness = Likeness(initial.setting, initial.state, frozenset(), frozenset())
    assert len(likeness.agents) == alike
    shared, apart = both(initial, 300)
    assert runs_of(shared) < runs_of(apart)


@pytest.mark.parametrize(("speeds", "lasting"), [((40, 40), (3, 3)), ((40, 90), (3, 3)), ((40, 40), (3, 2))])
def test_a_fleet_with_times_is_decided_as_by_the_reference(speeds, lasting):
    initial = timed_fleet(speeds, lasting)
    asked = [Property(PropertyKind.ENDURANCE, "endurance"), Property(PropertyKind.DEADLOCK_FREEDOM, "stuck")]
    reports = [check(initial, asked, engine=each, times=True) for each in (Engine.REFERENCE, Engine.FAST)]
    assert_alike(*(replace(each, seconds=0.0) for each in reports))


def test_a_fleet_three_times_as_large_takes_no_more_runs_of_rules():
    runs = []
    for robots in (6, 18):
        shared, apart = both(fleet(robots), 500)
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
            ColumnQuestion(("parent", "b"), None, is_, ("room0", "d")),
            ColumnQuestion(("parent", "d"), None, is_, ("room0", "b")),
        ),
        (ColumnQuestion(("mailbox", "a"), (0, "b")), ColumnQuestion(("mailbox", "a"), (0, "d"))),
        # who is hosted somewhere, as an observation says of an agent
        (
            ColumnQuestion(("mailbox", "a"), (0, agent_key("b"))),
            ColumnQuestion(("mailbox", "a"), (0, agent_key("d"))),
        ),
    ],
)
def test_a_question_is_renamed_in_all_that_it_is_about(ask, image):
    assert SWAP.ask(ask) == image
    assert SWAP.inverse.ask(image) == ask


@pytest.mark.parametrize(
    "message", ["b", Text("b"), ("at", "b", Text('say "b" \\')), (Text("d"), ("b", Text("b")))]
)
def test_a_label_under_an_exchange_names_the_others_and_leaves_texts(message):
    about, image = (f"send({show(each)}, a)" for each in (message, SWAP.renaming.value(message)))
    assert SWAP.label(Label("req_snd", "b", about)) == Label("req_snd", "d", image)


def test_what_has_an_order_of_its_own_or_may_be_no_name_is_not_renamed():
    assert SWAP.keeps_order({"a", "b"})
    assert not SWAP.keeps_order({"b", "c"})
    assert not SWAP.keeps_order({"b", "d"})
    first, second = OBS("b", Nodes(("a",))), OBS("b", Nodes(("c",)))
    assert SWAP.value(("line", "b"), (first,)) == (OBS("d", Nodes(("a",))),)
    with pytest.raises(NoImage):
        SWAP.value(("line", "b"), (first, second))
    assert len(replace(SWAP, unordered=False).value(("line", "b"), (first, second))) == 2
    assert SWAP.shown("at a") == "at a"
    with pytest.raises(NoImage):
        SWAP.shown("at b")


QUERIES = (
    "LINKED_TO(gcs0)", "LINKED_TO(HOST)", "LINKED_TO(robot1)", "CHILDREN(room0)", "CHILDREN(PARENT(HOST))",
    "HOSTED_AT(ALL)", "HOSTED_AT(LINKED_TO(HOST))", "PARENT(robot0)", "ALL", "CHILDREN(spill0)",
)  # fmt: skip


def looking_fleet(seed):
    """A fleet some of whose members differ in links, places or presence, looked at by somebody."""
    draw = random.Random(seed)
    robots = range(draw.randint(2, 4))
    links = [draw.choice(["", " linked wifi", " linked mesh, wifi"]) for _ in robots]
    there = [f"= point (0.0, {draw.choice([0.0, 0.003, 0.02])})" for _ in robots]
    there = [each if not n or draw.random() < 0.7 else "absent" for n, each in enumerate(there)]
    hosts = [n for n in robots if there[n] != "absent"]
    body = f"observe({draw.choice(QUERIES)}) react {{ case o => control({draw.choice(MOVES)}) }}"
    agents = [f"BigActor r{n} hosted_at robot{n} with_behavior {{ {body} }}" for n in hosts]
    if len(hosts) == len(robots) and draw.random() < 0.5:
        agents = [f"BigActor r[i] for u in Robot hosted_at u with_behavior {{ {body} }}"]
    looks = " ".join(f"observe({draw.choice(QUERIES)})" for _ in "ab")
    agents.append(f"BigActor base hosted_at gcs0 with_behavior {{ {looks} }}")
    clauses = draw.sample(CLAUSES, draw.randint(0, 2))
    clauses += [f"robot{n} appears at room0" for n in robots if n not in hosts]
    return LOOKING.format(
        world="\n".join(f"  robot{n}: Robot {there[n]}{links[n]}" for n in robots),
        agents="\n".join(agents),
        clauses="\n".join(clauses),
        scheduler=draw.choice(["unordered", "program_order", "fcfs"]),
    )


MOVES = ("MOVE_HOST_TO room1", "DISCONNECT_HOST_FROM gcs0", "CONNECT_HOST_TO gcs0", "MOVE_HOST_TO room0")
CLAUSES = (
    "spill0 appears at room1, room0",
    "robot0 vanishes",
    "wifi drops and returns",
    "robot1 leaves wifi",
)
LOOKING = """mission looking
signature {{
  kind Room contains Robot, Spill, Station
  kind Spill contains Robot
  kind Station
  kind Robot driven
}}
world {{
  channel wifi
  channel mesh
  room0: Room = box (0.001, 0.001) (-0.001, -0.001)
  room1: Room = box (0.001, 0.004) (-0.001, 0.002)
  gcs0: Station = point (0.0, 0.0005) linked wifi
  spill0: Spill absent
{world}
}}
{agents}
environment {{
{clauses}
}}
scheduler {scheduler}
"""


@seeds(200, 5)
def test_fleets_that_differ_in_what_is_looked_at_are_explored_as_by_the_reference(seed):
    initial = load(looking_fleet(seed), "").initial
    shared, _ = both(initial, 500)
    reference = explore(initial, engine=Engine.REFERENCE, limits=Limits(configurations=500))
    assert shared.complete is reference.complete
    if shared.complete:
        assert set(shared.configurations) == set(reference.configurations)
        assert shared.rules == reference.rules


ONE_IS_LINKED = """
signature {
  kind OilSpill contains UAV
  kind Station
  kind UAV driven
}
world {
  oilSpill0: OilSpill absent
  gcs0: Station = point (0.2, 0.5) linked wifi
  uav0: UAV = point (0.1, 0.3) linked wifi
  uav1: UAV = point (0.1, 0.4)
}
BigActor b hosted_at uav1 with_behavior { observe(LINKED_TO(gcs0)) }
environment { oilSpill0 appears at box (0.1732, 0.2754) (0.2232, 0.3154) }
"""


def test_of_two_uavs_one_may_be_on_the_link_that_is_looked_at():
    initial = load(ONE_IS_LINKED, "").initial
    fast, reference = (explore(initial, engine=each) for each in (Engine.FAST, Engine.REFERENCE))
    assert fast.rules == reference.rules == {"req_obs": 2, "sense": 2, "env": 3}
    assert set(fast.configurations) == set(reference.configurations)


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


@pytest.mark.parametrize("name", some_long(UNTIMED))
def test_beliefs_are_sorted_so_nothing_is_below_a_node_whose_kind_holds_nothing(name):
    initial = load_mission(name).initial
    signature, kind = initial.setting.signature, initial.setting.kind
    for c in explore(initial, engine=Engine.FAST, limits=Limits(configurations=600)).configurations:
        logical = c.structure.logical
        places = {node: logical.parent(node) for node in logical.nodes()}
        for node, place in places.items():
            assert place == REGION or signature[kind(place)].may_contain(kind(node))
