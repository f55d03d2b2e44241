"""Names and texts: a text that is spelled like a name is never that name, whatever a mission does with it."""

from collections.abc import Mapping
from dataclasses import fields, is_dataclass, replace
from pathlib import Path

import pytest
from checked_missions import load, verdict_of
from hypothesis import given
from scale import IS_WHOLE, crossed, examples

from checker import Engine, Limits, Outcome, check
from semantics import hypothesis_strategies
from semantics.behaviours.values import Route, Text
from semantics.environment import Says
from semantics.state.configuration import Configuration
from specs.elaboration import load_mission

FILES = Path(__file__).parent / "names_and_texts"
WORLD = """
signature standard
world {
  base: Location = circle (37.14, -8.58) radius 900 m
  uav0: UAV = point (37.14, -8.58) linked m
  uav1: UAV = point (37.141, -8.58) linked m
}
"""
SENT = """
BigActor a hosted_at uav0 with_behavior {{ {sends} }}
BigActor b hosted_at uav1 with_behavior {{ {reacts} }}
def told(p) = {{ if p == base {{ let got = 1 }} if p == "base" {{ let got = 2 }} }}
check {{ reachable "name": b.got == 1 reachable "text": b.got == 2 }}
"""
TAKES = (
    'react {{ case ("x", ={0}) => let got = 1 case ("x", "{0}") => let got = 2 }}',
    'react {{ case ("x", "{0}") => let got = 2 case ("x", ={0}) => let got = 1 }}',
    'react {{ case ("x", w) => match w {{ case "{0}" => let got = 2 case ={0} => let got = 1 }} }}',
    'react {{ case ("x", w) => if w == "{0}" {{ let got = 2 }} if w == {0} {{ let got = 1 }} }}',
    'react {{ case ("x", w) => if not (w != "{0}") {{ let got = 2 }} if not (w != {0}) {{ let got = 1 }} }}',
    'react {{ case ("x", w) if w in {{"{0}", 3}} => let got = 2 case ("x", w) if w in {{{0}, 3}} => let got = 1 }}',
    'react {{ case ("x", w) if w in ["{0}"] => let got = 2 case ("x", w) if w in [{0}] => let got = 1 }}',
    'react {{ case m: Message => if m == ("x", "{0}") {{ let got = 2 }} if m == ("x", {0}) {{ let got = 1 }} }}',
    'react {{ case m: Message => if m in {{("x", "{0}")}} {{ let got = 2 }} else {{ let got = 1 }} }}',
    'react {{ case ("x", w) => if [w] == ["{0}"] {{ let got = 2 }} if [w] == [{0}] {{ let got = 1 }} }}',
    'react {{ case ("x", w) => if not empty({{w}} - {{"{0}"}}) {{ let got = 1 }} else {{ let got = 2 }} }}',
    'react {{ case ("x", w) => if size({{w, "{0}"}}) == 1 {{ let got = 2 }} else {{ let got = 1 }} }}',
)
ENGINES = [Engine.FAST, Engine.REFERENCE]


def outcomes(sends, reacts, engine=Engine.FAST):
    mission = load(SENT.format(sends=sends, reacts=reacts), WORLD)
    report = check(mission, engine=engine)
    return {each: verdict_of(report, each).outcome is Outcome.HOLDS for each in ("name", "text")}


@crossed(TAKES, {f"{named} {engine}": (named, engine) for named in ("base", "a") for engine in ENGINES})
def test_a_name_that_is_sent_is_taken_as_a_name_and_a_text_as_a_text(name, variation):
    named, engine = variation
    reacts = name.format(named)
    assert outcomes(f'send ("x", {named}) to b', reacts, engine) == {"name": True, "text": False}
    assert outcomes(f'send ("x", "{named}") to b', reacts, engine) == {"name": False, "text": True}


@pytest.mark.parametrize(
    ("reacts", "expected"),
    [
        ('observe(ALL) react { case o => if "base" in o { let got = 2 } if base in o { let got = 1 } }', "name"),
        ('observe(ALL) react { case o => if parent(uav1, o) == "base" { let got = 2 } else { let got = 1 } }', "name"),
        ('observe(ALL) react { case o => if parent(base, o) == "region" { let got = 2 } }', ""),
        ("observe(ALL) react { case o => if parent(base, o) == region { let got = 1 } }", "name"),
        ("observe(HOST) react { case o => if parent(base, o) == unknown { let got = 1 } }", "name"),
        ('observe(HOSTED_AT(uav0)) react { case o => if "a" in o { let got = 2 } if a in o { let got = 1 } }', "name"),
        ('if kind(uav0) == "UAV" { let got = 2 }', "text"),
        ('match kind(HOST) { case "UAV" => let got = 2 case _ => let got = 1 }', "text"),
        ("if size({uav0, base, 3} of UAV) == 1 { let got = 1 }", "name"),
        ('if size({"uav0", uav0, "base"} of UAV) == 1 { let got = 1 } else { let got = 2 }', "name"),
        ("told(base)", "name"),
        ('told("base")', "text"),
    ],
)  # fmt: skip
def test_what_is_observed_is_a_name_and_a_kind_is_a_text(reacts, expected):
    assert outcomes("skip", reacts) == {"name": expected == "name", "text": expected == "text"}


@pytest.mark.parametrize("engine", ENGINES)
def test_a_pattern_with_a_text_takes_no_name(engine):
    mission = load_mission(FILES / "pattern.mission")
    found = verdict_of(check(mission, engine=engine), "text pattern takes name")
    assert found.outcome is Outcome.VIOLATED
    assert [each.hint for each in mission.warnings] == ["write the name without quotes: =base"]


@pytest.mark.parametrize("engine", ENGINES)
def test_a_property_compares_texts_with_texts_and_names_with_names(engine):
    mission = load_mission(FILES / "property.mission")
    report = check(mission, engine=engine)
    found = [verdict_of(report, name).outcome for name in ("wrong text", "right", "never text")]
    assert found == [Outcome.VIOLATED, Outcome.HOLDS, Outcome.HOLDS]
    assert [each.hint for each in mission.warnings] == ["write the name without quotes: base"] * 2


# --- whatever the texts are ---------------------------------------------------------------------------------------


def spelled_otherwise(value, texts):
    """Return a program, or a part of a mission, with other texts in the place of its own."""
    if isinstance(value, Text):
        return Text(texts[value.characters])
    if isinstance(value, Route):
        return Route(spelled_otherwise(value.stops, texts))
    if isinstance(value, tuple) and not hasattr(value, "_fields"):
        return tuple(spelled_otherwise(each, texts) for each in value)
    if isinstance(value, frozenset):
        return frozenset(spelled_otherwise(each, texts) for each in value)
    if isinstance(value, Mapping):
        return {key: spelled_otherwise(each, texts) for key, each in value.items()}
    if is_dataclass(value) and not isinstance(value, type):
        inner = {each.name: spelled_otherwise(getattr(value, each.name), texts) for each in fields(value)}
        return replace(value, **inner)
    return value


def judged(mission, engine):
    report = check(mission, limits=Limits(configurations=80), engine=engine)
    return [
        (each.property.name, each.outcome, each.examined, len(each.violations)) for each in report.verdicts
    ]


@pytest.mark.parametrize("engine", ENGINES)
@given(mission=hypothesis_strategies.missions())
@examples(60 if IS_WHOLE else 30)
def test_verdicts_do_not_depend_on_whether_texts_are_spelled_like_names(mission, engine):
    c = mission.initial
    names = sorted(c.setting.kinds)
    program, environment = c.setting.program, c.setting.environment
    texts = {"go": names[-1], names[0]: "nobody", **({names[-1]: "go"} if names[1:] else {})}
    statements = spelled_otherwise(program.statements, texts)
    clauses = (spelled_otherwise(each, texts) if isinstance(each, Says) else each for each in environment)
    setting = c.setting.with_(program=replace(program, statements=statements), environment=tuple(clauses))
    other = replace(mission, initial=Configuration(setting, c.state))
    assert judged(mission, engine) == judged(other, engine)
