"""The formatter keeps meaning and comments, and changes nothing twice."""

import itertools
import re
from dataclasses import fields
from functools import cache, reduce
from operator import or_
from pathlib import Path
from types import NoneType, UnionType
from typing import get_args, get_origin, get_type_hints

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scale import examples

from semantics.behaviours.commands import COMMANDS
from semantics.behaviours.observations import QueryOperator
from specs import syntax as s
from specs.diagnostics import Source
from specs.elaboration import read_mission
from specs.formatter import format_mission, write_mission
from specs.grammar import RESERVED, keywords
from specs.missions import shipped_missions
from specs.parser import parse

CORPUS = Path(__file__).parents[1] / "corpus"

# --- generated syntax trees: what the types of the nodes' fields say, but for the words and numbers below

words = st.from_regex(r"[a-zA-Z][a-zA-Z0-9_]{0,6}", fullmatch=True).filter(
    lambda word: word not in RESERVED and word not in keywords() and word not in {"m", "km"}
)
names = st.builds(s.Name, words)
linked = st.from_regex(r"[a-z0-9]{1,4}([:.-][a-z0-9]{1,3}){0,2}", fullmatch=True)
channels = st.builds(s.Name, linked.filter(lambda word: word not in RESERVED))
printed = st.characters(codec="utf-8", exclude_categories=["Cc", "Cs"])
special = st.sampled_from(['"', "\\", "\n", "\t", "//", "# {", "\\n"])
strings = st.builds(s.TextLiteral, st.text(printed, max_size=8) | special)
integers = st.builds(s.IntegerLiteral, st.integers(0, 10**9 - 1))
signed = st.builds(s.IntegerLiteral, st.integers(-(10**9) + 1, 10**9 - 1))
floats = st.floats(allow_nan=False, allow_infinity=False).map(lambda value: value or 0.0)
positive = st.floats(0, allow_infinity=False).map(lambda value: value or 0.0)
MOST_DEEP = 6
REQUESTS, FALLBACKS = ["OBS", "CTR", "FLY", "SND", "MGR"], ["hold", "return", "continue"]
ONE_OF = {
    (s.UnaryOperation, "operator"): ["not", "-"],
    (s.BinaryOperation, "operator"): [
        "or",
        "and",
        "in",
        "not in",
        "==",
        "!=",
        "<",
        "<=",
        ">",
        ">=",
        "+",
        "-",
    ],
    (s.Connective, "operator"): ["and", "or", "->", "<->"],
    (s.Quantified, "quantifier"): ["forall", "exists"],
    (s.Quantified, "joined"): [False],
    (s.PathPrefix, "operator"): ["[]", "<>", "X", "always", "eventually", "next", "infinitely often"],
    (s.PathOperation, "operator"): ["U", "W", "R", "until"],
    (s.PathQuantifier, "quantifier"): ["A", "E"],
    (s.TemporalProperty, "logic"): ["ltl", "ctl"],
    (s.Fairness, "strength"): ["weak", "strong"],
    (s.Stored, "operator"): ["==", "<", "<=", ">", ">="],
    (s.Pending, "request"): [None, "READY", *REQUESTS],
    (s.TimeLimit, "request"): [None, *REQUESTS],
    (s.TimeLimit, "fallback"): FALLBACKS,
    (s.OnBroken, "fallback"): FALLBACKS,
    (s.OnBroken, "what"): ["assumption", "property"],
    (s.StandardProperty, "name"): ["local_consistency", "race_freedom", "deadlock_freedom", "arrival"],
    (s.Scheduler, "name"): ["program_order", "unordered", "fcfs"],
    (s.ControlMode, "name"): ["atomic", "timed"],
    (s.Length, "unit"): ["m", "km"],
    (s.Duration, "value"): [0.0, 1.5, 90.0],
    (s.Duration, "unit"): ["s", "min", "h"],
    (s.RuleBody, "text"): ["a -> b", "u[c] || b.$0 -> b.(u[c] | $0)", "a_UAV.1 -> a_UAV"],
}
FIELDS = {key: st.sampled_from(values) for key, values in ONE_OF.items()} | {
    (s.Length, "value"): positive,
    (s.Says, "times"): st.integers(0, 99),
    (s.FromSource, "limit"): st.none() | st.integers(0, 10**6),
    (s.Drops, "channel"): channels,
    (s.Steps, "words"): st.tuples(names) | st.tuples(names, names),
    (s.FairDeadlockFreedom, "fairness"): st.deferred(
        lambda: st.lists(trees(s.Fairness, 1), min_size=1, max_size=2).map(tuple)
    ),
    (s.Leaves, "channel"): channels,
    (s.ChannelDeclaration, "name"): channels,
    (s.LinkedTo, "other"): channels,
    (s.LiteralPattern, "value"): strings | signed | st.builds(s.TruthLiteral, st.booleans()),
}
LEAST = {
    s.Fairness: 1,
    s.TupleLiteral: 2,
    s.TuplePattern: 2,
    s.Polygon: 1,
    s.Choose: 1,
    s.DriftsAmong: 1,
    s.Misses: 1,
    (s.Appears, "placements"): 1,
}
IN_TUPLES = s.VariablePattern | s.Wildcard | s.LiteralPattern | s.ConstantPattern | s.TuplePattern
SPECIAL = {
    s.Name: names,
    s.TextLiteral: strings,
    s.IntegerLiteral: integers,
    s.Agent: names | st.builds(s.Member, names, names | integers),
    bool: st.booleans(),
    float: floats,
    QueryOperator: st.sampled_from(list(QueryOperator)),
}


def members(type_):
    """Return the types of a union, or the type alone."""
    return [each for each in getattr(type_, "__args__", ()) or [type_] if each is not s.Timing]


def is_recursive(type_):
    """Tell whether a tree needs a smaller one of a kind that may have it as its part."""
    needs = set(getattr(type_, "__annotations__", {}).values())
    return bool(needs & {"Expression", "Formula", "Query"}) or LEAST.get(type_) == 2


@cache
def trees(type_, depth):
    """Return trees of a type that are at most so deep."""
    if type_ in SPECIAL or type_ is NoneType:
        return SPECIAL.get(type_, st.none())
    if isinstance(type_, UnionType):
        some = members(type_)
        if NoneType in some:
            return st.none() | trees(reduce(or_, [each for each in some if each is not NoneType]), depth)
        return st.one_of([trees(each, depth) for each in some if depth > 0 or not is_recursive(each)])
    if type_ is s.Command:
        return st.one_of([commanding(command, depth) for command in COMMANDS.values()])
    hints = get_type_hints(type_)
    return st.builds(
        type_, **{each.name: part(type_, each.name, hints[each.name], depth - 1) for each in compared(type_)}
    )


def compared(type_):
    return [each for each in fields(type_) if each.compare]


def part(owner, name, type_, depth):
    """Return the values of a field."""
    if (owner, name) in FIELDS:
        return FIELDS[owner, name]
    if get_origin(type_) is not tuple:
        return st.deferred(lambda: trees(type_, max(depth, 0)))
    item, _ = get_args(type_) if owner is not s.TuplePattern else (IN_TUPLES, ...)
    least = LEAST.get(owner, LEAST.get((owner, name), 0))
    items = channels if name == "channels" else st.deferred(lambda: trees(item, max(depth, 0)))
    return st.lists(items, min_size=least, max_size=max(least, 3 if depth > 0 else 0)).map(tuple)


def commanding(command, depth):
    expressions = trees(s.Expression, max(depth - 1, 0))
    operands = st.tuples(*(expressions for _ in command.operands))
    via = st.lists(expressions, max_size=3).map(tuple) if command.travels else st.just(())
    return st.builds(s.Command, st.just(command.name), operands, via)


missions = trees(s.Mission, MOST_DEEP)


def read(text):
    return parse(Source("m", text))


@examples(60)
@given(missions)
def test_what_is_written_reads_as_the_same_tree_and_is_formatted_already(mission):
    text = write_mission(mission)
    assert read(text) == mission
    again = format_mission(text)
    assert read(again) == mission
    assert format_mission(again) == again


def numbered(text):
    return sorted(re.findall(r"(?<!\S)c\d+(?!\S)", text))


@examples(40)
@given(missions, st.randoms(use_true_random=False))
def test_comments_are_all_kept_wherever_they_stand(mission, random):
    lines, number = [], itertools.count()
    for line in write_mission(mission).splitlines():
        if random.random() < 0.3:
            lines += [f"// c{next(number)}"] + [""] * random.randrange(3)
        lines.append(line + (f" # c{next(number)}" if random.random() < 0.3 else ""))
    text = "\n".join(lines)
    once = format_mission(text)
    assert read(once) == mission
    assert numbered(text) == numbered(once)
    assert format_mission(once) == once


@pytest.mark.parametrize("path", sorted(CORPUS.glob("ok/*.mission")), ids=lambda path: path.stem)
def test_the_corpus_keeps_its_meaning(path):
    text = path.read_text(encoding="utf-8")
    once = format_mission(text)
    assert read(once) == read(text)
    assert format_mission(once) == once


def test_comments_stay_where_they_were():
    text = """// the mission
mission  m  // m

# the world
world { a: B=point (1,2)   // here
  // between

  b: B = polygon (1,2) // first
      (3,4) // second
      (5,6)


  // last
}
def f() = { if a { // yes
  skip
  // before else
} else { // no
  skip }
  react { case x => // one
      skip
  case y => skip // two
  }
  loop { /// nothing
  }
}
// end"""
    assert (
        format_mission(text)
        == """// the mission
mission m  // m

# the world
world {
  a: B = point (1, 2)  // here
  // between

  // first
  b: B = polygon (1, 2) (3, 4) (5, 6)  // second

  // last
}

def f() = {
  if a {  // yes
    skip
    // before else
  } else {  // no
    skip
  }
  react {
    case x =>  // one
      skip
    case y => skip  // two
  }
  loop {  /// nothing
  }
}
// end
"""
    )


def test_long_lines_are_broken_between_items():
    corners = " ".join(f"(37.{n}, -8.{n})" for n in range(10, 30))
    formatted = format_mission(f"world {{ a: B = polygon {corners} linked x, y }}")
    assert max(map(len, formatted.splitlines())) <= 100
    assert formatted.splitlines()[2].startswith("      (37.")


def test_an_empty_mission_is_empty():
    assert format_mission(" \n\n ") == ""
    assert format_mission("// only this") == "// only this\n"


def test_an_angle_is_laid_out_with_the_marks_that_it_was_written_with():
    written = "world { a: B = point (37º 08′ 49.5″ N, -8.50) }"
    assert "point (37°08'49.5\"N, -8.5)" in format_mission(written)


@pytest.mark.parametrize("name", sorted(shipped_missions()))
def test_the_tree_of_a_mission_is_the_same_mission(name):
    path = shipped_missions()[name]
    text = path.read_text(encoding="utf-8")
    built = read_mission(parse(Source(name, text)), path.parent)
    assert built.initial == read_mission(text, path.parent).initial


@pytest.mark.parametrize("name", ["x } world {", "", "uav 0"])
def test_a_tree_that_is_another_mission_as_text_is_refused(name):
    with pytest.raises(ValueError, match="the tree is another mission than its text"):
        read_mission(s.Mission(s.Name(name), ()))
