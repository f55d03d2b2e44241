"""Coverage: which statements, branches and clauses some run reaches, and what is said of the others."""

import pytest
from checked_missions import SPARE, WORLD, load
from hypothesis import given, reject
from mission_texts import missions
from scale import examples

from checker import Engine, Limits, check, explore
from checker.properties.coverage import CoverageCount, coverage
from checker.properties.visited import Visited
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
    return check(mission.initial, mission.properties, limits, engine=engine).coverage


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


def test_what_every_run_reaches_has_no_gap():
    found = covered(agent("control(MOVE_HOST_TO gate0)\nobserve(ALL)"))
    assert (found.statements, found.branches, found.clauses) == (
        CoverageCount(2, 2),
        CoverageCount(0, 0),
        CoverageCount(0, 0),
    )
    assert (found.lines, found.unreached, found.gaps) == ((FIRST + 1, FIRST + 2), (), ())


WAITS = """observe(PARENT(HOST))
react {
  case obs if north0 in obs => control(MOVE_HOST_TO gate0)
  after 5 s => skip
}"""


@pytest.mark.parametrize("engine", [Engine.REFERENCE, Engine.FAST])
def test_an_after_branch_is_covered_where_the_wait_may_end(engine):
    found = covered(agent(WAITS), engine=engine)
    assert (found.branches, found.gaps) == (CoverageCount(2, 2), ())


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


def test_what_stands_after_something_for_ever_is_told_by_that_alone():
    body = 'react {\n  case "go" => skip\n}\ncontrol(MOVE_HOST_TO gate0)\nobserve(ALL)'
    assert gaps(agent(body)) == [(3, "this case is never taken")]


TESTS = {
    "if 1 < 2 {\ndisplay(1)\n}": [(2, "this condition is never false")],
    "if 2 < 1 {\ndisplay(1)\n}": [(2, "this condition is never true")],
    "if 2 < 1 {\ndisplay(1)\n} else {\ndisplay(2)\n}": [(2, "this condition is never true")],
    "while 2 < 1 {\ndisplay(1)\n}": [(2, "this condition is never true")],
    "for x in {} {\ndisplay(x)\n}": [(2, "there is never anything to go through")],
    "match 1 {\ncase 2 => display(1)\ncase x => display(x)\n}": [(3, "this case is never taken")],
    "choose {\ndisplay(1)\n} or {\ndisplay(2)\n}": [],
    "choose x in {uav0, uav1} {\nif x == uav1 {\ndisplay(x)\n}\n}": [],
    "for x in {1, 2} {\nif x == 1 {\ndisplay(x)\n}\n}": [],
    "let n = 0\nwhile n < 2 {\nn = n + 1\n}": [],
}


@pytest.mark.parametrize("body", TESTS)
def test_internal_statements_are_followed_through_one_step(body):
    assert gaps(agent(f"{body}\nobserve(ALL)")) == TESTS[body]


def test_two_ways_to_the_same_place_are_told_apart():
    body = "{}\nif n == 1 {{\nn = 3\n}} else {{\nn = 3\n}}\nobserve(ALL)"
    assert gaps(agent(body.format("let n = 1"))) == [(3, "this condition is never false")]
    assert gaps(agent(body.format("let n = 2"))) == [(3, "this condition is never true")]


def test_what_was_passed_before_a_computation_failed_was_passed():
    found = covered(agent("display(1)\nif 1 < 2 {\ndisplay(first(minus({uav0}, {uav0})))\n}\nobserve(ALL)"))
    assert [(gap.line - FIRST + 1, gap.message) for gap in found.gaps] == [
        (3, "this condition is never false"),
        (6, "this is never reached"),
    ]
    assert found.statements == CoverageCount(3, 4)


def test_loops_are_reached_with_what_they_begin_with():
    body = "loop {\nloop {\nobserve(ALL)\nreact {\ncase o => skip\n}\n}\n}"
    found = covered(agent(body))
    assert (found.statements, found.gaps) == (CoverageCount(4, 4), ())


RULE = "rule {}(u: UAV, b: Location) {{ u || b.$0 -> b.(u | $0) }}\n"


def test_a_rule_that_no_control_names_is_told():
    text = RULE.format("land") + RULE.format("leave") + agent("control(land(uav0, gate0))")
    assert covered(text).rules == CoverageCount(1, 2)
    assert gaps(text) == [(2, "rule 'leave' is never used")]


def test_a_behaviour_that_nobody_runs_is_told_where_it_is_declared():
    text = (
        agent("used(gate0)")
        + "def used(p) = {\ncontrol(MOVE_HOST_TO gate0)\n}\ndef idle() = {\nobserve(ALL)\n}\n"
    )
    assert gaps(text) == [(7, "behaviour 'idle' is never run")]


def test_a_spawned_agent_reaches_its_behaviour():
    text = agent("spawn b hosted_at uav0 with_behavior looks()") + "def looks() = {\nobserve(ALL)\n}\n"
    assert gaps(text) == []


def test_a_clause_of_the_environment_that_never_comes_about_is_told():
    text = (
        agent("observe(ALL)") + 'environment {\nspill0 vanishes\nuav1 drifts among gate0\nsays "x" to a\n}\n'
    )
    found = covered(text)
    assert found.clauses == CoverageCount(2, 3)
    assert gaps(text) == [(5, "this never happens")]


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
    report = check(mission.initial, mission.properties)
    assert list(coverage_text("m.mission", report.coverage, mission.source.text)) == [
        "  coverage: 3 of 4 statements, 1 of 3 branches",
        f"  m.mission:{FIRST + 3}: warning: this case is never taken",
        f"    {FIRST + 3} |   case obs if gate0 in obs => control(MOVE_HOST_TO south0)",
        f"  m.mission:{FIRST + 5}: warning: this case is never taken",
        f"    {FIRST + 5} |   case  obs => skip",
    ]


def test_coverage_as_data_says_the_same():
    assert coverage_json(covered(agent(LOOKS))) == {
        "complete": True,
        "statements": {"reached": 3, "of": 4},
        "branches": {"reached": 1, "of": 3},
        "rules": {"reached": 0, "of": 0},
        "clauses": {"reached": 0, "of": 0},
        "lines_reached": [FIRST + 1, FIRST + 2, FIRST + 4],
        "lines_not_reached": [FIRST + 3, FIRST + 5],
        "gaps": [
            {"line": FIRST + 3, "sort": "branch", "message": "this case is never taken"},
            {"line": FIRST + 5, "sort": "branch", "message": "this case is never taken"},
        ],
    }


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


def test_coverage_reads_projections_alone():
    """Two visits that saw the same projections cover the same, whatever configurations they came from."""
    mission = load(agent(LOOKS) + "environment { uav1 drifts among gate0 }")
    visited = Visited()
    explore(mission.initial, (visited,))
    rebuilt = Visited(dict(visited.codes), set(visited.moments), happened=set(visited.happened))
    assert coverage(mission.initial, rebuilt, complete=True) == coverage(
        mission.initial, visited, complete=True
    )


ONE_CAUSE = """def visit(p) = { control(MOVE_HOST_TO p) rest(p) }
def rest(p) = { control(MOVE_HOST_TO p) }
def nobody(p) = { rest(p) }
BigActor a hosted_at uav0 with_behavior {
  react { case "x" => skip case "y" => visit(gate0) case ("z", n) => visit(gate0) }
  visit(gate0)
}
"""


def test_one_cause_makes_one_gap():
    """A react that waits for ever: not its cases, what follows, nor what is called from there."""
    mission = load(ONE_CAUSE)
    found = check(mission.initial, mission.properties).coverage
    assert [(gap.line, gap.message) for gap in found.gaps] == [
        (FIRST + 2, "behaviour 'nobody' is never run"),
        (FIRST + 4, "no case of this react is ever taken: it waits for ever"),
    ]
