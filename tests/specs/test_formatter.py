"""The formatter keeps meaning and comments, and changes nothing twice."""

import itertools
import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scale import examples

from semantics.behaviours.commands import COMMANDS
from specs import syntax as s
from specs.diagnostics import Source
from specs.formatter import format_mission, write_mission
from specs.grammar import RESERVED, keywords
from specs.parser import parse

CORPUS = Path(__file__).parents[1] / "corpus"

# --- generated syntax trees

words = st.from_regex(r"[a-zA-Z][a-zA-Z0-9_]{0,6}", fullmatch=True).filter(
    lambda word: word not in RESERVED and word not in keywords() and word not in {"m", "km"}
)
names = st.builds(s.Name, words)
linked = st.from_regex(r"[a-z0-9]{1,4}([:.-][a-z0-9]{1,3}){0,2}", fullmatch=True)
channels = st.builds(s.Name, linked.filter(lambda word: word not in RESERVED))
printed = st.characters(codec="utf-8", exclude_categories=["Cc", "Cs"])
texts = st.builds(s.TextLiteral, st.text(printed, max_size=8))
special = st.sampled_from(['"', "\\", "\n", "\t", "//", "# {", "\\n"]).map(s.TextLiteral)
strings = texts | special
integers = st.builds(s.IntegerLiteral, st.integers(0, 10**9 - 1))
truths = st.builds(s.TruthLiteral, st.booleans())
floats = st.floats(allow_nan=False, allow_infinity=False).map(lambda value: value or 0.0)
positive = st.floats(0, allow_infinity=False).map(lambda value: value or 0.0)


def tuples(items, least=0, most=3):
    return st.lists(items, min_size=least, max_size=most).map(tuple)


def maybe(items):
    return st.none() | items


def bigger_expressions(smaller):
    operators = st.sampled_from(["or", "and", "in", "not in", "==", "!=", "<", "<=", ">", ">=", "+", "-"])
    return st.one_of(
        st.builds(s.BinaryOperation, operators, smaller, smaller),
        st.builds(s.UnaryOperation, st.sampled_from(["not", "-"]), smaller),
        st.builds(s.OfKind, smaller, names),
        st.builds(s.FunctionCall, names, tuples(smaller)),
        st.builds(s.TupleLiteral, tuples(smaller, 2)),
        st.builds(s.SetLiteral, tuples(smaller)),
        st.builds(s.RouteLiteral, tuples(smaller)),
        st.builds(s.Member, names, smaller),
    )


hosts = st.builds(s.HostReference)
leaves = st.one_of(names, strings, integers, truths, hosts, st.builds(s.SelfReference))
expressions = st.recursive(leaves, bigger_expressions, max_leaves=6)
relations = st.sampled_from(["PARENT", "CHILDREN", "LINKED_TO", "HOSTED_AT"])
queries = st.recursive(
    st.one_of(hosts, names, st.builds(s.AllNodes)),
    lambda q: st.builds(s.QueryApplication, relations, q),
    max_leaves=3,
)
bodies = st.sampled_from(["a -> b", "u[c] || b.$0 -> b.(u[c] | $0)", "a_UAV.1 -> a_UAV"]).map(s.RuleBody)


def commanding(command):
    operands = st.tuples(*(expressions for _ in command.operands))
    via = tuples(expressions) if command.travels else st.just(())
    return st.builds(s.Command, st.just(command.name), operands, via)


actions = st.one_of(
    *map(commanding, COMMANDS.values()),
    st.builds(s.ApplyRule, names, tuples(expressions)),
    bodies,
)
signed = st.builds(s.IntegerLiteral, st.integers(-(10**9) + 1, 10**9 - 1))
literals = st.builds(s.LiteralPattern, st.one_of(strings, truths, signed))
named = st.builds(s.VariablePattern, names) | st.builds(s.ConstantPattern, names)
items = st.recursive(
    named | st.builds(s.Wildcard) | literals,
    lambda item: st.builds(s.TuplePattern, tuples(item, 2)),
    max_leaves=3,
)
patterns = st.one_of(
    items, st.builds(s.ObservationPattern, maybe(names)), st.builds(s.MessagePattern, maybe(names))
)
calls = st.builds(s.Call, names, tuples(expressions))
simple = st.one_of(
    st.builds(s.Observe, queries),
    st.builds(s.Control, actions),
    st.builds(s.Send, expressions, expressions),
    st.builds(s.Migrate, expressions),
    st.builds(s.Spawn, maybe(names), calls, expressions),
    st.builds(s.Display, expressions),
    st.builds(s.Let, names, expressions),
    st.builds(s.Assign, names, expressions),
    calls,
    st.builds(s.Skip),
)
durations = st.builds(s.Duration, st.sampled_from([0.0, 1.5, 90.0]), st.sampled_from(["s", "min", "h"]))


def bigger_statements(smaller):
    block = tuples(smaller)
    cases = tuples(st.builds(s.Case, patterns, maybe(expressions), block))
    return st.one_of(
        st.builds(s.React, cases, maybe(st.builds(s.After, durations, block))),
        st.builds(s.Match, expressions, cases),
        st.builds(s.If, expressions, block, block),
        st.builds(s.Loop, block),
        st.builds(s.While, expressions, block),
        st.builds(s.For, names, expressions, block),
        st.builds(s.Choose, tuples(st.builds(s.Alternative, block), 1)),
        st.builds(s.ChooseFrom, names, expressions, block),
    )


statements = st.recursive(simple, bigger_statements, max_leaves=6)
lengths = st.builds(s.Length, positive, st.sampled_from(["m", "km"]))
coordinates = st.builds(s.Coordinate, floats, floats)
geometries = st.one_of(
    st.builds(s.Point, coordinates),
    st.builds(s.Box, coordinates, coordinates),
    st.builds(s.Polygon, tuples(coordinates, 1, 12)),
    st.builds(s.Circle, coordinates, lengths),
)
placements = st.builds(s.Placement, geometries, maybe(st.builds(s.AltitudeBand, lengths, lengths)))
kept, limits = tuples(st.builds(s.Keep, names, names, maybe(lengths))), st.integers(0, 10**6)
entries = st.one_of(
    st.builds(s.Entity, names, names, maybe(placements), maybe(names), tuples(channels), st.booleans()),
    st.builds(s.ChannelDeclaration, channels),
    st.builds(s.FromSource, strings, maybe(names), maybe(strings), maybe(geometries), kept, maybe(limits)),
)
beliefs = st.one_of(
    st.builds(s.BelievedIn, names, maybe(names)),
    st.builds(s.BelievedUnknown, names),
    st.builds(s.BelievedLinked, names, tuples(channels)),
)
spots = tuples(names | placements, 1)
agents = names | st.builds(s.Member, names, names | integers)
clauses = st.one_of(
    st.builds(s.DriftsAmong, names, spots),
    st.builds(s.DriftsWithin, names, names),
    st.builds(s.Drops, channels, st.booleans()),
    st.builds(s.Leaves, names, channels, st.booleans()),
    st.builds(s.Appears, names, spots, tuples(channels)),
    st.builds(s.Vanishes, names),
    st.builds(s.Says, expressions, maybe(agents), st.integers(0, 99)),
    st.builds(s.Arrives, names),
)
claims = st.one_of(
    truths,
    st.builds(s.Inside, names, names, st.booleans(), st.booleans()),
    st.builds(s.LinkedTo, names, channels, st.booleans()),
    st.builds(s.Present, agents),
    st.builds(s.Known, names),
    st.builds(s.Pending, agents, maybe(st.sampled_from(["OBS", "READY", "CTR", "FLY", "SND", "MGR"]))),
    st.builds(s.Ended, agents),
    st.builds(s.Waiting, agents),
    st.builds(s.HostedAt, agents, names),
    st.builds(s.SameName, agents, agents),
    st.builds(s.Stored, agents, names, expressions, st.sampled_from(["==", "<", "<=", ">", ">="])),
    st.builds(s.HasValue, agents, names),
)
formulas = st.recursive(
    claims,
    lambda f: st.one_of(
        st.builds(s.Negation, f),
        st.builds(s.Connective, st.sampled_from(["and", "or", "->", "<->"]), f, f),
        st.builds(s.Quantified, st.sampled_from(["forall", "exists"]), names, names, f, *[maybe(names)] * 2),
    ),
    max_leaves=6,
)
properties = st.one_of(
    st.sampled_from(["local_consistency", "race_freedom", "deadlock_freedom", "arrival"]).map(
        s.StandardProperty
    ),
    st.builds(s.Invariant, strings, formulas),
    st.builds(s.Reachable, strings, formulas),
)
fallbacks = st.sampled_from(["hold", "return", "continue"])
requests = st.sampled_from(["OBS", "CTR", "FLY", "SND", "MGR"])
precautions = st.one_of(
    st.builds(s.OnBroken, fallbacks),
    st.builds(s.TimeLimit, maybe(requests), maybe(agents), durations, fallbacks),
)
kinds = st.builds(s.Kind, names, tuples(names), tuples(names), st.booleans(), st.booleans())
declarations = st.one_of(
    st.builds(s.Signature, tuples(kinds)),
    st.builds(s.World, tuples(entries)),
    st.builds(s.Believes, tuples(beliefs)),
    st.builds(s.Rule, names, tuples(st.builds(s.Parameter, names, names)), bodies),
    st.builds(s.Definition, names, tuples(names), tuples(statements)),
    st.builds(s.BigActor, maybe(names), names, tuples(statements)),
    st.builds(s.Family, names, names, names, expressions, names, tuples(statements)),
    st.builds(s.Environment, tuples(clauses)),
    st.sampled_from(["program_order", "unordered", "fcfs"]).map(s.Scheduler),
    st.sampled_from(["atomic", "timed"]).map(s.ControlMode),
    st.builds(s.Check, tuples(properties)),
    st.builds(s.Live, tuples(precautions)),
)
missions = st.builds(s.Mission, maybe(names), tuples(declarations))


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
