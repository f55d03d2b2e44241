"""Properties about variables, beside a naive interpreter that keeps every variable for ever.

It runs generated programs as the text says, path by path, and notes what each name was given last wherever others can
look: at each command and each `choose`. It judges formulas with negations pushed inside, where what has no value is
true if it has to hold for ever, and false if it has to come about.
"""

import operator
from pathlib import Path

import pytest
from checked_missions import WORLD, checked, load
from hypothesis import given
from hypothesis import strategies as st
from scale import IS_WHOLE, examples

from checker import Engine, Outcome, Reduction, RefusedError, check, explore, replay, to_json
from checker.properties.inspections import Reachability
from semantics.behaviours.program import VariableOf
from semantics.behaviours.values import Truth
from semantics.properties.kinds import PropertyKind
from semantics.properties.property import Property, watching
from semantics.properties.propositions import VariableIs
from semantics.properties.temporal import Denied, Either, Globally, Now
from specs.elaboration import load_mission

MISSIONS = Path(__file__).parents[3] / "specs" / "missions"

COMPARED = {
    "==": operator.eq,
    "!=": operator.ne,
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}
NAMES = ("n", "m")
CALLED = (("move",), ("add", "n", 1), ("move",))
"""What `visit(n)` does."""

# --- programs -------------------------------------------------------------------------------------------------


@st.composite
def blocks(draw, scope=(), depth=2, looping=False):
    """Yield well-scoped blocks; in a loop nothing is bound anew, so that it ends."""
    block, inside = [], list(scope)
    for _ in range(draw(st.integers(1, 3))):
        ways = ["move", "move", "call"]
        ways += ["let", "let"] * (not looping) + ["add", "if"] * bool(inside)
        ways += ["choose"] * (depth > 0) + ["while"] * (depth > 0 and bool(inside))
        way = draw(st.sampled_from(ways))
        name = draw(st.sampled_from(NAMES if way == "let" else inside or NAMES))
        inner = blocks(tuple(inside), depth - 1, looping) if depth else st.just((("move",),))
        if way == "let":
            inside.append(name)
            block.append((way, name, draw(st.integers(-1, 3))))
        elif way == "while":
            body = draw(blocks(tuple(inside), depth - 1, looping=True))
            block.append((way, name, draw(st.integers(0, 2)), (*body, ("add", name, 1))))
        else:
            number = draw(st.integers(-1, 3)) if way == "call" else draw(st.integers(0, 2))
            rest = {"if": (name, number), "add": (name, number), "call": (number,)}.get(way, ())
            block.append((way, *rest, *((draw(inner), draw(inner)) if way in ("if", "choose") else ())))
    return tuple(block)


def text_of(block):
    return "\n".join(map(line_of, block))


def line_of(statement):
    match statement:
        case ("move",):
            return "control(MOVE_HOST_TO gate0)"
        case ("let", name, value):
            return f"let {name} = {value}"
        case ("add", name, value):
            return f"{name} = {name} + {value}"
        case ("call", value):
            return f"visit({value})"
        case ("if", name, value, then, otherwise):
            return f"if {name} < {value} {{ {text_of(then)} }} else {{ {text_of(otherwise)} }}"
        case ("while", name, value, body):
            return f"while {name} < {value} {{ {text_of(body)} }}"
        case ("choose", one, other):
            return f"choose {{ {text_of(one)} }} or {{ {text_of(other)} }}"
    raise AssertionError(statement)


def runs(block):
    """Return for each path what names were given last, wherever others can look: at first nothing."""
    return [[{}, *seen] for seen in paths([*block], [{}], {})]


def paths(code, scopes, last):  # noqa: PLR0912  # one case for each kind of statement
    """Yield what is seen on each path from here; scopes and what was given last are this path's own."""
    code, scopes, last = list(code), [dict(each) for each in scopes], dict(last)

    def give(scope, name, value):
        scope[name] = last[name] = value

    def of(name):
        return next(each for each in reversed(scopes) if name in each)

    while code:
        statement = code.pop(0)
        match statement:
            case "leave":
                scopes.pop()
            case ("let", name, value):
                give(scopes[-1], name, value)
            case ("add", name, value):
                give(of(name), name, of(name)[name] + value)
            case ("if", name, value, then, otherwise):
                code[:0] = [*(then if of(name)[name] < value else otherwise), "leave"]
                scopes.append({})
            case ("while", name, value, body):
                if of(name)[name] < value:
                    code[:0] = [*body, "leave", statement]
                    scopes.append({})
            case ("call", value):
                code[:0] = [*CALLED, "leave"]
                scopes.append({})
                give(scopes[-1], "n", value)
            case ("move",):
                for rest in paths(code, scopes, last):
                    yield [dict(last), *rest]
                return
            case ("choose", one, other):
                for chosen in (one, other):
                    for rest in paths([*chosen, "leave", *code], [*scopes, {}], last):
                        yield [dict(last), *rest]
                return
    yield [dict(last)]


# --- formulas -------------------------------------------------------------------------------------------------

literals = st.one_of(
    st.tuples(st.sampled_from(NAMES), st.sampled_from(sorted(COMPARED)), st.integers(-2, 4)),
    st.tuples(st.just("bound"), st.sampled_from(NAMES)),
)


def joined(of):
    return st.one_of(
        st.tuples(st.just("not"), of),
        st.tuples(st.sampled_from(["and", "or", "->", "<->"]), of, of),
    )


def on_paths(of):
    return st.one_of(
        joined(of),
        st.tuples(st.sampled_from(["[]", "<>"]), of),
        st.tuples(st.sampled_from(["U", "R", "W", "leads to"]), of, of),
    )


propositions = st.recursive(literals, joined, max_leaves=4)
claims = st.recursive(literals, on_paths, max_leaves=5)


def written(f):
    match f:
        case ("not" | "[]" | "<>" as sign, inner):
            return f"{sign} ({written(inner)})"
        case ("bound", name):
            return f"bound a.{name}"
        case (name, sign, int(value)):
            return f"a.{name} {sign} {value}"
        case (sign, left, right):
            return f"({written(left)}) {sign} ({written(right)})"
    raise AssertionError(f)


def true(f, run, at=0, *, kept=False, denied=False):  # noqa: PLR0912  # one case for each operator
    """Tell whether a formula, or its denial, is true on a run from some time on; `kept`: it has to hold for ever."""
    later = range(at, len(run))

    def now(g, time=at, kept=kept, denied=denied):
        return true(g, run, time, kept=kept, denied=denied)

    def always(g, denied=denied):
        return all(now(g, time, True, denied) for time in later)

    def comes(g, denied=denied):
        return any(now(g, time, False, denied) for time in later)

    match f:
        case ("bound", name):
            return (name in run[at]) is not denied
        case (name, sign, int(value)):
            held = run[at].get(name)
            return kept if held is None else COMPARED[sign](held, value) is not denied
        case ("not", inner):
            return now(inner, denied=not denied)
        case ("and" | "or" as sign, left, right):
            return (all if (sign == "and") is not denied else any)((now(left), now(right)))
        case ("->", left, right):
            return now(("or", ("not", left), right))
        case ("<->", left, right):
            return now(("and", ("->", left, right), ("->", right, left)))
        case ("[]", inner):
            return comes(inner) if denied else always(inner)
        case ("<>", inner):
            return always(inner) if denied else comes(inner)
        case ("leads to", left, right):
            return now(("[]", ("->", left, ("<>", right))))
        case ("R", left, right):
            return now(("U", ("not", left), ("not", right)), denied=not denied)
        case ("W", left, right) if not denied:
            return now(("U", left, right)) or always(left)
        case ("W", left, right):
            return not now(f, denied=False)
        case ("U", left, right) if not denied:
            return any(
                now(right, time, False) and all(now(left, before, True) for before in range(at, time))
                for time in later
            )
        case ("U", left, right):
            return all(
                now(right, time, True) or any(now(left, before, False) for before in range(at, time))
                for time in later
            )
    raise AssertionError(f)


# --- beside it ------------------------------------------------------------------------------------------------

NAMED = ("choose", (("let", "n", 0),), (("let", "m", 0),))
"""Binds all names, so that formulas may ask for them, each on one path only, and in no scope of what follows."""


def mission_of(block, *properties):
    visit = f"def visit(n) = {{ {text_of(CALLED)} }}"
    bigactor = f"BigActor a hosted_at uav0 with_behavior {{ {text_of(block)} }}"
    never = "BigActor other hosted_at uav1 with_behavior { let n = 7 control(MOVE_HOST_TO gate0) }"
    return load(f"{visit} {bigactor} {never} check {{ {' '.join(properties)} }}")


def expected(block, invariant, reachable, claim):
    seen = runs(block)
    states = [[state] for run in seen for state in run]
    return {
        "i": all(true(invariant, state, kept=True) for state in states),
        "r": any(true(reachable, state) for state in states),
        "l": all(true(claim, run) for run in seen),
    }


def outcomes(report):
    return {each.property.name: each.outcome is Outcome.HOLDS for each in report.verdicts}


everything = given(
    blocks().map(lambda block: (NAMED, *block)),
    propositions,
    propositions,
    claims,
)


def asked(invariant, reachable, claim):
    yield f'invariant "i": {written(invariant)}'
    yield f'reachable "r": {written(reachable)}'
    if claim is not None:
        yield f'ltl "l": {written(claim)}'


@examples(150 if IS_WHOLE else 45)
@everything
def test_verdicts_are_those_of_an_interpreter_that_forgets_nothing(block, invariant, reachable, claim):
    mission = mission_of(block, *asked(invariant, reachable, claim))
    report = check(mission, engine=Engine.REFERENCE)
    assert outcomes(report) == {**expected(block, invariant, reachable, claim), "computation": True}
    for each in report.verdicts:
        for trace in filter(None, (each.witness, *(found.trace for found in each.violations))):
            assert replay(mission.initial, to_json(trace, "", "")) == trace


@examples(15)
@everything
def test_the_fast_explorer_and_reductions_say_the_same(block, invariant, reachable, claim):
    wanted = expected(block, invariant, reachable, claim)
    mission = mission_of(block, *asked(invariant, reachable, claim))
    slow, fast = (check(mission, engine=each) for each in (Engine.REFERENCE, Engine.FAST))
    assert outcomes(fast) == {**wanted, "computation": True}
    assert [each.remarks for each in fast.verdicts] == [each.remarks for each in slow.verdicts]
    assert (fast.configurations, fast.transitions) == (slow.configurations, slow.transitions)
    mission = mission_of(block, *asked(invariant, reachable, None))
    reduced = check(mission, engine=Engine.REFERENCE, reduce=[Reduction.POR])
    assert (outcomes(reduced)["i"], outcomes(reduced)["r"]) == (wanted["i"], wanted["r"])


# --- as a reader expects it -----------------------------------------------------------------------------------

ALIKE = WORLD.replace("linked control:gcs1, mesh", "linked control:gcs0, mesh").replace(
    "uav1: UAV = point (36.98, -8.70)", "uav1: UAV = point (37.02, -8.70)"
)
"""The two UAVs stand in one place, and are on the same links."""


EVERY_WAY = """
def visit(p) = { control(MOVE_HOST_TO p) }
BigActor a hosted_at uav0 with_behavior {
  observe(CHILDREN(PARENT(HOST)))
  react { case o => skip }
  for f in {1, 2} { control(MOVE_HOST_TO gate0) }
  choose c in {3, 4} { control(MOVE_HOST_TO south0) }
  match (5, 6) { case (x, y) => control(MOVE_HOST_TO gate0) }
  spawn b hosted_at uav1 with_behavior visit(gate0)
  react { case ("go", m) => skip }
}
environment { says ("go", -7) to a }
"""


LAST = ("bound a.o", "a.f == 2", "a.c >= 3", "a.x == 5", "a.y == 6", "b.p == gate0", "a.m == -7")


@pytest.mark.parametrize("engine", [Engine.REFERENCE, Engine.FAST])
def test_a_variable_is_kept_however_it_is_bound(engine):
    ends = [f'reachable "{each}": {each} and ended a and ended b' for each in LAST]
    stays = [f'ltl "{each}, then": [] ({each} -> [] {each})' for each in LAST]
    later = 'ltl "next": X a.f < 1 ctl "later": AF AG (ended a -> a.y > 5)'
    mission = load(f"{EVERY_WAY} check {{ {' '.join((*ends, *stays))} {later} }}")
    report = check(mission, engine=engine)
    assert {name for name, holds in outcomes(report).items() if not holds} == {"next"}
    reduced = check(mission, engine=engine, reduce=[Reduction.POR])
    assert all(outcomes(reduced)[each] for each in LAST)
    assert reduced.configurations < report.configurations


FOUND = VariableIs(VariableOf("scout", ("found",)), Truth.TRUE)
SEARCH = MISSIONS / "search_and_deploy.mission"


def test_properties_given_beside_a_configuration_keep_what_they_name():
    mission = load_mission(SEARCH)
    assert mission.setting.program.watched == frozenset()
    asked = (
        Property(PropertyKind.REACHABLE, "reached", FOUND),
        Property(
            PropertyKind.LTL, "kept", temporal=Globally(Either(Denied(Now(FOUND)), Globally(Now(FOUND))))
        ),
    )
    for engine in (Engine.REFERENCE, Engine.FAST):
        report = check(mission.initial, asked, engine=engine)
        assert [each.outcome for each in report.verdicts] == [Outcome.HOLDS, Outcome.HOLDS]
        assert len(report.verdicts[0].witness.steps) == 8
    with pytest.raises(ValueError, match=r"begin with watching\(initial, properties\)"):
        explore(mission.initial, [Reachability(FOUND)])
    looked = Reachability(FOUND)
    explore(watching(mission.initial, asked), [looked])
    assert looked.collected.example is not None


def test_nothing_is_kept_that_no_property_names():
    """At the choose, before the control, before and after its service: only the last three know the number."""
    text = """BigActor a hosted_at uav0 with_behavior {
      choose { let n = 1 } or { let n = 2 }
      control(MOVE_HOST_TO gate0)
    }"""
    claims = ("arrival", 'reachable "it": a.n == 1')
    assert [checked(f"{text} check {{ {claim} }}").configurations for claim in claims] == [1 + 3, 1 + 2 * 3]


@pytest.mark.parametrize("engine", [Engine.REFERENCE, Engine.FAST])
def test_a_reduction_sees_what_is_given_to_variables(engine):
    """Both agents compute apart from each other: with the variables unseen, one order would stand for both."""
    text = "".join(
        f"""
        BigActor {agent} hosted_at {uav} with_behavior {{
          let n = 1
          observe(HOST)
          n = n + 1
          observe(HOST)
        }}"""
        for agent, uav in (("a", "uav0"), ("b", "uav1"))
    )
    claims = "".join(
        f' reachable "{one} {other}": a.n == {one} and b.n == {other}' for one in (1, 2) for other in (1, 2)
    )
    first = {each: load(f"{text} check {{ {each} }}") for each in ("local_consistency", claims)}
    plain, named = (check(each, engine=engine, reduce=[Reduction.POR]) for each in first.values())
    assert set(outcomes(named).values()) == {True}
    assert plain.configurations < named.configurations


def test_agents_are_not_exchanged_where_a_property_names_a_variable_of_one():
    twins = "".join(
        f"""
        BigActor {agent} hosted_at {uav} with_behavior {{
          let n = 0
          control(MOVE {uav} TO gate0)
          n = n + 1
          observe(HOST)
        }}"""
        for agent, uav in (("a", "uav0"), ("b", "uav1"))
    )
    for claim in ('reachable "it": a.n == 1', 'ltl "it": <> a.n == 1'):
        one = load(f"{twins} check {{ {claim} }}", ALIKE)
        with pytest.raises(RefusedError, match=r"a property distinguishes them: it names a\.n"):
            check(one, reduce=[Reduction.SYMMETRY])
    both = load(
        f'{twins} check {{ invariant "it": a.n != 1 or b.n != 1 reachable "r": a.n > 0 and b.n > 0 }}', ALIKE
    )
    whole, reduced = (check(both, reduce=reduce) for reduce in ((), (Reduction.SYMMETRY,)))
    assert outcomes(whole) == outcomes(reduced) == {"it": False, "r": True, "computation": True}
    assert (whole.configurations, reduced.configurations) == (5 * 5, 5 * 6 // 2)
