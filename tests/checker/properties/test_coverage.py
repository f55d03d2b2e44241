"""Coverage: which statements, branches and clauses some run reaches, and what is said of the others."""

import pytest
from checked_missions import SPARE, WORLD, load
from hypothesis import given, reject
from mission_texts import missions
from scale import examples

from checker import Engine, Limits, check, explore
from checker.properties.coverage import CoverageCount, coverage
from checker.properties.visited_statements import Visited
from checker.reports.report import coverage_json, coverage_text
from semantics.successors import expand
from specs import MissionError

FIRST = WORLD.count("\n") + 1
"""The first line of what stands after the world."""


def loaded(text):
    """Return a generated mission; hypothesis is told where a mistake is in it."""
    try:
        return load(text)
    except MissionError:
        reject()


def covered(text, limits=SPARE, engine=Engine.FAST):
    mission = load(text)
    return check(mission, limits=limits, engine=engine).coverage


def gaps(text, **options):
    return [(gap.line - FIRST + 1, gap.message) for gap in covered(text, **options).gaps]


def agent(body):
    return f"BigActor a hosted_at uav0 with_behavior {{\n{body}\n}}\n"


LOOKS = """observe(PARENT(HOST))
react {
  case obs if gate0 in obs => control(MOVE_HOST_TO south0)
  case obs if north0 in obs => control(MOVE_HOST_TO gate0)
  case obs => skip
}"""


IN_TIME = """BigActor a hosted_at uav0 with_behavior {
  observe(PARENT(HOST))
  control(MOVE_HOST_TO gate0)
  react { case "done" => skip }
  react {
    case o: Observation => skip
    after 5 s => skip
  }
}
BigActor b hosted_at vessel0 with_behavior {
  let there = false
  while not there { observe(CHILDREN(gate0)) react { case o: Observation => there = uav0 in o } }
  send "done" to a
}
"""


@pytest.mark.parametrize("engine", [Engine.REFERENCE, Engine.FAST])
def test_an_after_branch_that_is_never_taken_is_told_at_its_line(engine):
    assert gaps(IN_TIME, engine=engine) == [(7, "this 'after' branch is never taken")]


def test_a_case_that_is_never_taken_is_told_at_its_line_and_what_lies_within_is_not_told_again():
    assert gaps(agent(LOOKS)) == [(4, "this case is never taken"), (6, "this case is never taken")]
    found = covered(agent(LOOKS))
    assert (found.statements, found.branches) == (CoverageCount(3, 4), CoverageCount(1, 3))
    assert found.unreached == (FIRST + 3, FIRST + 5)


TESTS = {
    "if 1 < 2 {\ndisplay(1)\n}": [(2, "this condition is never false")],
    "if 2 < 1 {\ndisplay(1)\n}": [(2, "this condition is never true")],
    "if 2 < 1 {\ndisplay(1)\n} else {\ndisplay(2)\n}": [(2, "this condition is never true")],
    "while 2 < 1 {\ndisplay(1)\n}": [(2, "this condition is never true")],
    "for x in {} {\ndisplay(x)\n}": [(2, "the collection to go through is always empty")],
    "match 1 {\ncase 2 => display(1)\ncase x => display(x)\n}": [(3, "this case is never taken")],
    "choose {\ndisplay(1)\n} or {\ndisplay(2)\n}": [],
    "choose x in {uav0, uav1} {\nif x == uav1 {\ndisplay(x)\n}\n}": [],
    "for x in {1, 2} {\nif x == 1 {\ndisplay(x)\n}\n}": [],
    "let n = 0\nwhile n < 2 {\nn = n + 1\n}": [],
    "let n = 1\nif n == 1 {\nn = 3\n} else {\nn = 3\n}": [(3, "this condition is never false")],
    "let n = 2\nif n == 1 {\nn = 3\n} else {\nn = 3\n}": [(3, "this condition is never true")],
    'react {\n  case "go" => skip\n}\ncontrol(MOVE_HOST_TO gate0)': [(3, "this case is never taken")],
}


@pytest.mark.parametrize("body", TESTS)
def test_internal_statements_are_followed_through_one_step(body):
    assert gaps(agent(f"{body}\nobserve(ALL)")) == TESTS[body]


def test_what_was_passed_before_a_computation_failed_was_passed():
    found = covered(agent("display(1)\nif 1 < 2 {\ndisplay(first(minus({uav0}, {uav0})))\n}\nobserve(ALL)"))
    assert [(gap.line - FIRST + 1, gap.message) for gap in found.gaps] == [
        (3, "this condition is never false"),
        (6, "this is never reached"),
    ]
    assert found.statements == CoverageCount(3, 4)


RULE = "rule {}(u: UAV, b: Location) {{ u || b.$0 -> b.(u | $0) }}\n"
LOOKS_ON = "def {}() = {{\nobserve(ALL)\n}}\n"
ONE_CAUSE = """def visit(p) = { control(MOVE_HOST_TO p) rest(p) }
def rest(p) = { control(MOVE_HOST_TO p) }
def nobody(p) = { rest(p) }
BigActor a hosted_at uav0 with_behavior {
  react { case "x" => skip case "y" => visit(gate0) case ("z", n) => visit(gate0) }
  visit(gate0)
}
"""
DECLARED = {
    "a loop in a loop, of which both are": (
        agent("loop {\nloop {\nobserve(ALL)\nreact {\ncase o => skip\n}\n}\n}"),
        [],
    ),
    "a rule that no control names": (
        RULE.format("land") + RULE.format("leave") + agent("control(land(uav0, gate0))"),
        [(2, "rule 'leave' is never used")],
    ),
    "a behaviour that nobody runs": (
        agent("used()") + LOOKS_ON.format("used") + LOOKS_ON.format("idle"),
        [(7, "behaviour 'idle' is never run")],
    ),
    "a behaviour that a spawned agent runs": (
        agent("spawn b hosted_at uav0 with_behavior looks()") + LOOKS_ON.format("looks"),
        [],
    ),
    "a clause of the environment that never comes about": (
        agent("observe(ALL)") + 'environment {\nspill0 vanishes\nuav1 drifts among gate0\nsays "x" to a\n}\n',
        [(5, "this never happens")],
    ),
    "a react that waits for ever, and not what stands after it": (
        ONE_CAUSE,
        [
            (3, "behaviour 'nobody' is never run"),
            (5, "no case of this react is ever taken: it waits for ever"),
        ],
    ),
}


@pytest.mark.parametrize(("text", "told"), DECLARED.values(), ids=DECLARED)
def test_what_is_declared_is_told_where_it_is_never_used(text, told):
    assert gaps(text) == told


def test_a_search_that_was_cut_off_gives_no_warnings():
    mission = load(agent(LOOKS))
    report = check(mission.initial, mission.properties, Limits(configurations=2))
    assert not report.coverage.complete
    assert list(coverage_text("m", report.coverage, mission.source.text)) == [
        "  coverage so far: 2 of 4 statements, 0 of 3 branches"
    ]
    assert coverage_json(report.coverage)["complete"] is False


def test_gaps_are_written_as_compilers_write_warnings():
    mission = load(agent(LOOKS.replace("case obs => skip", "case\tobs => skip  ")))
    report = check(mission)
    assert list(coverage_text("m.mission", report.coverage, mission.source.text)) == [
        "  coverage: 3 of 4 statements, 1 of 3 branches",
        f"  m.mission:{FIRST + 3}: warning: this case is never taken",
        f"    {FIRST + 3} |   case obs if gate0 in obs => control(MOVE_HOST_TO south0)",
        f"  m.mission:{FIRST + 5}: warning: this case is never taken",
        f"    {FIRST + 5} |   case  obs => skip",
    ]


@examples(25)
@given(missions())
def test_every_engine_covers_the_same(text):
    limits = Limits(configurations=2_000)
    loaded(text)
    one, other = (covered(text, limits, engine) for engine in (Engine.FAST, Engine.REFERENCE))
    assert one == other


@examples(25)
@given(missions())
def test_coverage_agrees_with_the_steps_that_the_rules_take(text):
    """What a process notes while the rules run is what is computed again from projections."""
    c = loaded(text).initial
    visited, noted = Visited(), set()
    found = explore(c, (visited,), Limits(configurations=500))
    program = c.setting.program
    for each in found.configurations:
        for transition in expand(each).by_agents:
            if transition.label.rule != "fun":
                continue
            before, after = (x.alpha.code(transition.label.agent) for x in (each, transition.target))
            noted |= set(before) - set(after)
    result = coverage(c, visited, complete=found.complete)
    assert {program.lines[number] for number in noted} <= set(result.lines)


ONE_CAUSE = """def visit(p) = { control(MOVE_HOST_TO p) rest(p) }
def rest(p) = { control(MOVE_HOST_TO p) }
def nobody(p) = { rest(p) }
BigActor a hosted_at uav0 with_behavior {
  react { case "x" => skip case "y" => visit(gate0) case ("z", n) => visit(gate0) }
  visit(gate0)
}
"""
