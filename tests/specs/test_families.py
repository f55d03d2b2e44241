"""Families of bigActors, and quantifiers over bigActors: what they come to."""

import pytest
from elaborating import elaborated, reachable, told

from semantics.behaviours.expressions import Apply, Literal, Variable
from semantics.behaviours.statements import ControlBy, Send
from semantics.behaviours.values import Text
from semantics.environment import Says
from semantics.properties.propositions import Ended, Exists, HostedAt, Not, Or, Waiting, holds
from semantics.properties.temporal import Steps
from specs.elaboration.initial_actors import MOST_WRITTEN

WORLD = """
signature {
  kind Location contains Location, UAV
  kind UAV driven
  kind Station
  kind Ship
}
world {
  a0: Location = box (37.04, -8.59) (36.94, -8.79)
  b0: Location = box (37.24, -8.59) (37.14, -8.79)
  uav1: UAV = point (37.3, -8.6) linked mesh
  uav0: UAV = point (37.3, -8.6) linked mesh
  gcs0: Station = point (37.3, -8.5) linked mesh
}
def visit(place) = { control(MOVE_HOST_TO place) }
"""


def agents_of(text):
    alpha = elaborated(WORLD + text).initial.alpha
    return {name: alpha.host(name) for name in alpha.names()}


def statements(text, sort):
    found = elaborated(WORLD + text).setting.program.statements
    return [each for each in found if isinstance(each, sort)]


def family(body, head="f[i] for u in UAV hosted_at u"):
    return f"BigActor {head} with_behavior {{ {body} }}\n"


# --- members


@pytest.mark.parametrize(
    ("head", "members"),
    [
        ("f[i] for u in UAV hosted_at u", {"f[uav0]": "uav0", "f[uav1]": "uav1"}),
        ("f[u] for u in {uav1} hosted_at u", {"f[uav1]": "uav1"}),
        ("f[i] for p in [b0, a0] hosted_at gcs0", {"f[a0]": "gcs0", "f[b0]": "gcs0"}),
    ],
)
def test_a_family_has_a_member_for_each_entity_called_by_it(head, members):
    assert agents_of(family("skip", head)) == members


@pytest.mark.parametrize(
    ("among", "members"),
    [("UAV", ["uav0", "uav1"]), ("{uav1, uav0}", ["uav0", "uav1"]), ("[uav1, uav0]", ["uav1", "uav0"])],
)
def test_members_are_numbered_in_the_order_of_names_or_of_the_route(among, members):
    sent = statements(family("send 1 to f[i] send i to f[u]", f"f[i] for u in {among} hosted_at u"), Send)
    numbered = [pair for number, name in enumerate(members) for pair in ((name, 1), (name, number))]
    assert [(each.to.value, each.message.value) for each in sent] == [
        (f"f[{name}]", n) for name, n in numbered
    ]


def test_entity_and_number_stand_in_arguments_queries_patterns_and_rules():
    body = """
      visit(u) observe(PARENT(u))
      react { case ("to", =u, n) if n == i => control({ u || a0.$0 -> a0.(u | $0) }) }
    """
    ruled = [each for each in statements(family(body), ControlBy) if each.name != "MOVE_HOST_TO"]
    assert [each.arguments for each in ruled] == [(Literal("uav0"),), (Literal("uav1"),)]


def test_a_variable_hides_the_entity_and_a_member_does_not_change_it():
    (sent, _) = statements(family("let u = 3 send u to f[0]"), Send)
    assert not isinstance(sent.message, Literal)
    ((_, message, hint),) = told(WORLD + family("i = 3"))
    assert message == "'i' stands for the same throughout the member"
    assert hint == "bind another name: let other = i"


def test_a_member_may_be_reckoned_and_is_looked_up_in_the_run_where_it_must_be():
    sent = statements(
        family('if i < 1 { send 1 to f[i + 1] } react { case ("x", v) => send 2 to f[v] }'), Send
    )
    table = Literal(frozenset({("uav0", "f[uav0]"), ("uav1", "f[uav1]")}))
    assert [each.to.value for each in sent[:1]] == ["f[uav1]"]
    assert [each.to.operator for each in sent[1:]] == ["[]", "[]", "[]"]
    assert all(isinstance(each.to, Apply) and each.to.arguments[0] == table for each in sent[1:])


def test_members_are_named_wherever_bigactors_are():
    text = (
        family("react { case m: Message => skip }")
        + """
    environment { says "go" to f[uav1] says f[1] to f[0] }
    live { OBS f[uav1] within 10 s: hold }
    check {
      ltl "steps" under weak fairness of f[uav1], fun f[0]: [] <> taken rcv_msg f[uav0] or enabled f[1]
      invariant "each": forall u: UAV . waiting f[u] or ended f[u]
    }
    """
    )
    mission = elaborated(WORLD + text)
    said = [(each.agent, each.message) for each in mission.setting.environment if isinstance(each, Says)]
    assert said == [("f[uav1]", Text("go")), ("f[uav0]", "f[uav1]")]
    assert [each.agent for each in mission.precautions.limits] == ["f[uav1]"]
    fair = [(each.steps, each.word) for each in mission.properties[0].fairness]
    assert fair == [(Steps((), "f[uav1]"), "f[uav1]"), (Steps(("fun",), "f[uav0]"), "fun f[0]")]
    assert mission.properties[1].formula.formulas[1] == Or((Waiting("f[uav1]"), Ended("f[uav1]")))


def test_families_written_out_are_bounded():
    many = "\n".join(f"  x{number}: Ship = point (37.0, -8.0)" for number in range(200))
    body = "send 1 to f[0] " * (MOST_WRITTEN // 800)
    text = WORLD.replace("world {", f"world {{\n{many}") + family(body, "f[i] for s in Ship hosted_at gcs0")
    ((code, message, _),) = told(text)
    assert (code, message) == ("LS408", "written out, the families have more than 100,000 words")


# --- quantifiers over bigActors

CREW = """
BigActor f[i] for u in UAV hosted_at u with_behavior visit(a0)
BigActor boss hosted_at gcs0 with_behavior { spawn late hosted_at uav1 with_behavior visit(b0) migrate(uav0) }
"""


def formula(text, rest=CREW):
    return elaborated(f'{WORLD}{rest}check {{ invariant "f": {text} }}').properties[0].formula


def late(body):
    return Or((Not(Exists("late", implied=True)), body))


@pytest.mark.parametrize(
    ("among", "expected"),
    [
        ("agents", [Ended("boss"), Ended("f[uav0]"), Ended("f[uav1]"), late(Ended("late"))]),
        ("f", [Ended("f[uav0]"), Ended("f[uav1]")]),
        ("agents with_behavior visit", [Ended("f[uav0]"), Ended("f[uav1]"), late(Ended("late"))]),
        ("f hosted_at uav1", [Ended("f[uav1]")]),
        (
            "agents hosted_at uav1",
            [
                Or((Not(HostedAt("boss", "uav1")), Ended("boss"))),
                Ended("f[uav1]"),
                Or((Not(HostedAt("late", "uav1")), Ended("late"))),
            ],
        ),
        ("f hosted_at UAV", [Ended("f[uav0]"), Ended("f[uav1]")]),
    ],
)
def test_a_quantifier_goes_through_bigactors_of_a_family_a_behaviour_or_a_host(among, expected):
    assert list(formula(f"forall x: {among} . ended x").formulas) == expected


def test_a_kind_called_agents_is_a_kind():
    text = WORLD.replace("kind Ship", "kind Ship kind agents")
    text = text.replace("gcs0: Station", "gcs1: agents = point (37, -8)\n gcs0: Station")
    mission = elaborated(text + CREW + 'check { invariant "f": forall x: agents . known x }')
    assert [str(each) for each in mission.properties[0].formula.formulas] == ["known gcs1"]


def test_a_quantified_host_stands_in_a_restriction():
    found = formula("forall u: UAV . exists x: f hosted_at u . waiting x")
    assert [str(each) for each in found.formulas] == ["waiting f[uav0]", "waiting f[uav1]"]


def test_of_a_spawned_bigactor_nothing_is_said_before_it_is_there():
    mission = elaborated(
        f'{WORLD}{CREW}check {{ reachable "f": exists x: agents with_behavior visit . x.place == b0 }}'
    )
    found = mission.properties[0].formula
    seen, _ = reachable(mission)
    assert {holds(found, c) for c in seen} == {True, False}
    assert all("late" in c.alpha for c in seen if holds(found, c))


def test_quantifiers_at_the_beginning_of_runs_do_not_leave_out_who_is_spawned():
    text = '{}{}check {{ ltl "f": {} }}'
    ((code, message, hint),) = told(text.format(WORLD, CREW, "forall x: agents . <> ended x"))
    assert (code, message) == ("LS611", "this is about the beginning of runs, and 'late' is spawned in them")
    assert hint == "write always (forall ...), or quantify over others: agents with_behavior visit"
    elaborated(text.format(WORLD, CREW, "always forall x: agents . <> ended x"))
    elaborated(text.format(WORLD, CREW, "forall x: f . <> ended x"))


# --- brackets


def test_brackets_behind_a_variable_give_an_element():
    body = "let way = [b0, a0] control(MOVE_HOST_TO way[1]) let f = (a0, b0) control(MOVE_HOST_TO f[i])"
    found = statements(family(body), ControlBy)[:2]
    assert [each.arguments for each in found] == [
        (Apply("element", (Variable("way"), Literal(1))),),
        (Apply("element", (Variable("f"), Literal(0))),),
    ]


@pytest.mark.parametrize(
    "head", ["f for u in UAV hosted_at u", "f[] for u in UAV", "f[uav0] hosted_at uav0", "[u] for u in UAV"]
)
def test_a_family_that_is_written_otherwise_is_shown_how(head):
    ((code, _, hint),) = told(WORLD + family("skip", head))
    assert code in {"LS101", "LS121"}
    assert hint == "a family is written BigActor patrol[i] for u in UAV hosted_at u with_behavior { ... }"
