"""Types at elaboration: what is inferred holds in every run, and what is reported would fail."""

import itertools
from pathlib import Path

import pytest
from elaborating import elaborated, mistakes
from hypothesis import given
from text_tables import rows

from semantics import hypothesis_strategies
from semantics.behaviours.expressions import OPERATORS, Apply, EvaluationScope, Fault, Literal, evaluate
from semantics.behaviours.observations import Observation
from semantics.behaviours.program import Program
from semantics.behaviours.values import Route, Text, Truth, within
from semantics.environment import Says
from semantics.successors import successors
from specs import syntax as s
from specs.codes import Code
from specs.diagnostics import Source
from specs.elaboration import load_mission
from specs.elaboration.mission_mistakes import Findings
from specs.elaboration.type_constraints import check_types, operands
from specs.elaboration.value_types import Inference, ValueSort

ROOT = Path(__file__).parents[2]
EXPLORED = sorted(
    [
        *ROOT.glob("specs/missions/*.mission"),
        *(path.with_suffix(".mission") for path in ROOT.glob("tests/corpus/[ov][ki]*/*.expected")),
    ]
)
NAMED = {int: ValueSort.NUMBER, tuple: ValueSort.TUPLE, frozenset: ValueSort.SET} | {
    each: ValueSort[each.__name__.upper()] for each in (Text, Truth, Route, Observation)
}
ENTITIES = frozenset({"uav0", "place0"})
AGENTS = frozenset({"a"})
WORLD = """signature standard
world {
  r0: Location = box (37.04, -8.59) (36.94, -8.79)
  uav0: UAV = point (37.0, -8.6) linked wifi
}
"""


def is_of(value, type_, agents):
    """Tell whether a value is of a type, by what types mean."""
    sort = sort_of(value, agents)
    if sort not in type_.sorts:
        return False
    if sort in (ValueSort.SET, ValueSort.ROUTE):
        return {sort_of(member, agents) for member in within(value)} <= type_.members
    if sort is ValueSort.TUPLE and type_.tuples is not None:
        return any(
            len(value) == length
            and first in (None, value[0])
            and all(sort_of(item, agents) in each for item, each in zip(value, sorts, strict=True))
            for (length, first), sorts in type_.tuples.items()
        )
    return True


def sort_of(value, agents):
    if isinstance(value, str):
        return ValueSort.AGENT if value in agents else ValueSort.ENTITY
    return NAMED[type(value)]


def inferred(setting, agents):
    said = tuple(clause.message for clause in setting.environment if isinstance(clause, Says))
    found = Inference(setting.program, frozenset(setting.kinds), frozenset(agents), said)
    return found, found.variables()


def safe(configuration):
    """Return the successors of a configuration, none where a computation fails."""
    try:
        return successors(configuration)
    except Fault:
        return ()


def wrong(configuration, inference, types):
    """Return the variables whose values are not of the types that were inferred."""
    alpha = configuration.alpha
    stored = [pair for agent in alpha.names() for pair in alpha.store(agent) if pair[0] in types]
    return [(name, value) for name, value in stored if not is_of(value, types[name], inference.agents)]


@pytest.mark.parametrize("path", EXPLORED, ids=lambda path: path.stem)
def test_in_what_is_explored_each_variable_holds_what_was_inferred_and_nothing_is_warned_of(path):
    mission = load_mission(path)
    assert mission.warnings == ()
    agents = {name for sort, name in mission.spans if sort == "agent"} | set(mission.initial.alpha.names())
    inference, types = inferred(mission.setting, agents)
    seen, front = {mission.initial}, [mission.initial]
    while front and len(seen) < 150:
        following = {step.target for c in front for step in safe(c)} - seen
        seen |= following
        front = sorted(following, key=str)[:20]
    assert [found for c in seen for found in wrong(c, inference, types)] == []


@given(hypothesis_strategies.configurations())
def test_in_generated_missions_each_variable_holds_what_was_inferred(configuration):
    inference, types = inferred(configuration.setting, hypothesis_strategies.AGENT_NAMES)
    assert wrong(configuration, inference, types) == []


# --- operators: whatever fails is reported, and nothing else ------------------------------------------------------

SEEN = Observation.of(shown=["uav0"], agents=["a"])
SAMPLES = (
    3,
    -1,
    Truth.TRUE,
    Text("loud"),
    Text("uav0"),
    "uav0",
    "a",
    (Text("loud"), 3),
    (3, 3, "uav0"),
    frozenset(),
    frozenset({"uav0", "place0"}),
    frozenset({3}),
    Route(()),
    Route(("uav0", "place0")),
    SEEN,
)
NODE = s.Name("x")


def judged(operator, values):
    """Return the codes of the mistakes and of the warnings for an operator with these operands."""
    findings = Findings(Source("m", "x"))
    literals = tuple(map(Literal, values))
    demands = list(operands(operator, (NODE,) * len(values), literals))
    check_types(demands, Inference(Program(), ENTITIES, AGENTS), findings)
    return len(findings), [found.code for found in findings.warnings]


def outcome(operator, values):
    """Return what an operator makes of these operands, None where it fails."""
    scope = EvaluationScope("a", "uav0", {}, {}, {"uav0": "UAV", "place0": "Location"}, {})
    try:
        return evaluate(Apply(operator, tuple(map(Literal, values))), scope)
    except Fault:
        return None


@pytest.mark.parametrize("operator", [name for name in OPERATORS if name not in ("of", "[]")])
def test_an_operator_is_reported_just_where_it_fails(operator):
    for values in itertools.product(SAMPLES, repeat=OPERATORS[operator].arity):
        mistakes, warned = judged(operator, values)
        result = outcome(operator, values)
        beyond = operator == "element" and isinstance(values[0], Route)  # how long a route is is not followed
        assert bool(mistakes) is (result is None) or (beyond and result is None), values
        if warned:
            assert warned == [Code.ALWAYS_THE_SAME]
            assert result is Truth.of(operator == "!="), values


# --- where each fault of a run is known before -------------------------------------------------------------------

STATIC = r"""
if ? { skip } with r0  # a test needs true or false | a condition is true or false, and 'r0' is an entity
while ? { skip } with 3  # a test needs true or false | a condition is true or false, and '3' is a number
react { case o if ? => skip } with size(o)
    # a test needs true or false | a condition is true or false, and 'size(o)' is a number
let y = true and ? with "x"  # a test needs true or false | 'and' needs true or false, and '"x"' is a text
for p in ? { skip } with 3
    # a set, a route or an observation was expected | 'for' needs a set, a route or an observation, and '3' is a
    number
choose p in ? { skip } with SELF
    # a set, a route or an observation was expected | 'choose' needs a set, a route or an observation, and 'SELF' is
    a bigActor
choose p in ? { skip } with {}
    # nothing to choose from | 'choose' needs a set, a route or an observation, and '{}' is an empty set
display(first(?)) with {} - {r0}
    # the set is empty | 'first' needs a set, a route or an observation, and '{} - {r0}' is an empty set
display(size(?)) with 3  # can't be computed | 'size' needs a set, a route or an observation, and '3' is a number
display(1 + ?) with r0  # can't be computed | '+' needs a number, and 'r0' is an entity
display(kind(?)) with "Loud"  # can't be computed | 'kind' needs an entity, and '"Loud"' is a text
display(element(?, 2)) with (1, 2)  # can't be computed | '(1, 2)' has 2 items, counted from 0, and no item 2
display(3 in ?) with r0  # can't be computed | 'in' needs a set, a route or an observation, and 'r0' is an entity
control(MOVE_HOST_TO ?) with 3  # a name was expected | MOVE_HOST_TO needs an entity, and '3' is a number
control(MOVE_HOST_TO ?) with {}  # one name was expected | MOVE_HOST_TO needs an entity, and '{}' is an empty set
control(MOVE_HOST_TO r0 VIA ?) with true  # a name | MOVE_HOST_TO needs an entity, and 'true' is true or false
control(go(?)) with "x"  # a name was expected | rule 'go' needs an entity, and a text that names none is given
migrate(?) with {3}  # a name was expected | 'migrate' needs an entity, and '{3}' is a set that holds a number
spawn b hosted_at ? with_behavior still() with 3  # a name | 'hosted_at' needs an entity, and '3' is a number
match ? { case 3 => skip } with r0  # no case of 'match' | no case takes 'r0', which is an entity
send "x" to ? with 3  # a name was expected | 'send' needs a bigActor, and '3' is a number
"""

UNKNOWN = "element(element(((?, 1), 1), 0), 0)"  # the types of a tuple's tuples are not followed


def mission(statement):
    return (
        WORLD
        + "rule go(p: Location) { HOST || p -> HOST || p }\ndef still() = { skip }\n"
        + f"BigActor a hosted_at uav0 with_behavior {{ observe(HOST) {statement} }}"
    )


def fault(text):
    """Return the first fault of a run that always takes the first step."""
    configuration = elaborated(text).initial
    try:
        for _ in range(500):
            configuration = successors(configuration)[0].target
    except Fault as found:
        return str(found)
    return "none"


@pytest.mark.parametrize(("row", "told"), list(rows(STATIC)))
def test_a_fault_that_a_type_tells_is_a_diagnostic(row, told):
    (statement, value), (said, diagnostic) = row.split(" with "), told.split(" | ")
    assert said in fault(mission(statement.replace("?", UNKNOWN.replace("?", value))))
    (found,) = mistakes(mission(statement.replace("?", value)))
    assert (found.code, found.message) == (Code.WRONG_VALUE, diagnostic)
    assert found.hint


DYNAMIC = [
    ("control(MOVE_HOST_TO {r0, uav0} - {uav0, r0})", "one name was expected"),
    ("control(MOVE_HOST_TO {r0, uav0})", "one name was expected"),
    ("control(go(HOST))", "p is of kind Location, and uav0 is of kind UAV"),
    ("choose p in {r0} - {r0} { skip }", "there is nothing to choose from"),
    ('match "x" { case "y" => skip }', "no case of 'match' takes \"x\""),
    ("let n = 2 while true { n = n + n observe(HOST) }", "more than 18 digits"),
    ("let s = {0} while true { s = {s, (s, 1)} observe(HOST) }", "more than 1000 parts"),
    ("loop { let n = 1 }", "no command is reached within 10000 internal steps"),
    ("loop { spawn b hosted_at HOST with_behavior still() }", "an agent 'b' is there already"),
]


@pytest.mark.parametrize(("statement", "said"), DYNAMIC, ids=[row[0] for row in DYNAMIC])
def test_a_fault_that_depends_on_a_value_is_found_by_exploring(statement, said):
    assert said in fault(mission(statement))


# --- where types come from ----------------------------------------------------------------------------------------

B = "BigActor b hosted_at uav0 with_behavior { loop { react { ? } } }\n"
SHOW = "def show(x) = { display(size(x)) }\n"
NO_SIZE = "'size' needs a set, a route or an observation, and 'x' is a number"
SOURCES = [
    ("let x = 3 display(size(x))", ""),
    ("show(3)", SHOW),
    ("spawn c hosted_at HOST with_behavior show(3)", SHOW),
    ('send ("go", 3) to b', B.replace("?", 'case ("go", x) => display(size(x))')),
    ("send 3 to b", B.replace("?", "case x: Message => display(size(x))")),
    ("match (3, r0) { case (x, _) => display(size(x)) }", ""),
    ("let x = element((r0, 3), 1) display(size(x))", ""),
]


@pytest.mark.parametrize(("statement", "before"), SOURCES, ids=[row[0] for row in SOURCES])
def test_a_type_is_followed_to_where_it_comes_from(statement, before):
    text = WORLD + before + f"BigActor a hosted_at uav0 with_behavior {{\n{statement}\n}}\n"
    line = text[: text.index(statement)].count("\n") + 1
    (found,) = mistakes(text)
    assert found.message == f"{NO_SIZE} (line {line})"


def test_what_someone_outside_says_has_a_type_too():
    says = B.replace("?", "case x: Message => display(size(x))") + "environment { says 3 to b }\n"
    assert mistakes(WORLD + says)[0].message == NO_SIZE


def test_messages_are_told_apart_by_their_first_text():
    sends = 'send ("go", r0) to b send ("count", 3) to b'
    cases = 'case ("go", p) => control(MOVE_HOST_TO p) case ("count", n) => display(n + 1)'
    found = elaborated(mission(sends) + "\n" + B.replace("?", cases))
    assert found.warnings == ()


def test_a_variable_of_two_types_is_warned_of_where_one_cannot_be_taken():
    found = elaborated(mission("let x = 3 if size({r0}) > 1 { x = r0 control(MOVE_HOST_TO x) } display(x)"))
    (warned,) = found.warnings
    assert warned.code is Code.TWO_TYPES
    assert warned.message == "MOVE_HOST_TO needs an entity, and 'x' may be a number: line 8 gives it that"


def test_of_several_nodes_the_hint_is_to_take_one():
    (found,) = mistakes(mission("react { case obs => control(MOVE_HOST_TO obs) }"))
    assert found.hint == "take one: choose x in obs { ... }"


def test_nothing_is_said_of_what_never_runs():
    assert elaborated(mission("skip") + "\ndef never(x) = { display(size(x)) if x { skip } }").warnings == ()


def test_another_mistake_leads_to_none_of_types():
    body = "control(MOVE_HOST_TO r1) if unknown(3) { skip } display(size(r2)) let x = HOST + 1"
    found = [each.code for each in mistakes(mission(body))]
    assert found == [*[Code.UNKNOWN_NAME] * 3, Code.WRONG_VALUE]
