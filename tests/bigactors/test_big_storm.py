"""`big check --storm`: what Storm computes of systems whose answers are known by hand."""

import json
import sys
from importlib.util import find_spec

import numpy as np
import pytest

from bigactors.commands.big import storm
from bigactors.commands.big.storm import answers, check_queries, translated
from bigactors.mistakes import Mistake
from bigraphs.claims import ClaimOutcome
from bigraphs.errors import NotationError
from bigraphs.exploration import explore
from bigraphs.notation import read_system

needs_storm = pytest.mark.skipif(find_spec("stormpy") is None, reason="stormpy is not installed")


CHOICE = """\
atomic ctrl A = 0; atomic ctrl B = 0; atomic ctrl C = 0;
big start = A;
action safe[1] react walk = A -[ 1 ]-> B; end
action bold[5] react leap = A -[ 1 ]-> B; react fall = A -[ 3 ]-> C; end
big home = B;
begin nbrs init start; rules = [ {walk, leap, fall} ]; preds = { home[2] }; end
"""

# A die from a fair coin: Knuth and Yao, The complexity of nonuniform random number generation, 1976.
EDGES = [edge.split("-") for edge in ["S0-S1", "S0-S2", "S1-S3", "S1-S4", "S2-S5", "S2-S6", "S3-S1", "S3-D1"]]
EDGES += [edge.split("-") for edge in ["S4-D2", "S4-D3", "S5-D4", "S5-D5", "S6-D6", "S6-S2"]]


FACES = [f"face{face}" for face in range(1, 7)]


def die(kind="pbrs"):
    names = sorted({name for edge in EDGES for name in edge})
    rules = [f"react r{number} = {one} -[ 1 ]-> {other};" for number, (one, other) in enumerate(EDGES)]
    listed = ", ".join(f"r{number}" for number in range(len(EDGES)))
    return read_system(
        "".join(f"atomic ctrl {name} = 0;\n" for name in names)
        + "big start = S0;\n"
        + "".join(f"big {face} = D{face[-1]};\n" for face in FACES)
        + "\n".join(rules)
        + f"\nbegin {kind}\ninit start;\nrules = [ {{{listed}}} ];\npreds = {{ {', '.join(FACES)} }};\nend"
    )


def asked(system, *queries, **limits):
    return list(answers(explore(system, **limits), queries))


@needs_storm
def test_a_die_from_a_coin_is_fair():
    queries = [f"P=? [F {face}]" for face in FACES]
    for each in asked(die(), *queries):
        assert each.outcome is ClaimOutcome.HOLDS
        assert each.value.number == pytest.approx(1 / 6, abs=1e-5)
        low, high = each.value.bounds
        assert low - 1e-9 <= 1 / 6 <= high + 1e-9
        assert [step.chance for step in each.run.steps] == [0.5] * 3
        assert "probability 0.125" in each.what


@needs_storm
def test_claims_about_probabilities_hold_or_are_violated():
    fine, wrong = asked(die(), "P>0.16 [F face1]", "P>=0.2 [F face1]")
    assert (fine.outcome, wrong.outcome) == (ClaimOutcome.HOLDS, ClaimOutcome.VIOLATED)
    assert fine.value.compared
    assert wrong.value.number == pytest.approx(1 / 6, abs=1e-5)


@needs_storm
def test_tosses_are_counted_and_times_added():
    # Eleven thirds tosses on average; with two transitions of rate 1 in each state, each takes half a second.
    thrown = f"F ({' | '.join(FACES)})"
    (steps,) = asked(die(), f"T=? [{thrown}]")
    assert steps.value.number == pytest.approx(11 / 3, abs=1e-4)
    time, early = asked(die("sbrs"), f"T=? [{thrown}]", "P=? [F<=0 face1]")
    assert time.value.number == pytest.approx(11 / 6, abs=1e-4)
    assert early.value.number == 0


@needs_storm
def test_a_strategy_and_the_run_that_it_leads_to():
    least, most = asked(read_system(CHOICE), "Pmin=? [F home]", "Pmax=? [F home]")
    assert (least.value.number, most.value.number) == (pytest.approx(0.25), pytest.approx(1))
    assert (least.strategy, most.strategy) == ({0: "bold"}, {0: "safe"})
    assert [(step.action, step.rules, step.chance) for step in least.run.steps] == [("bold", ("leap",), 0.25)]
    assert [(step.action, step.rules, step.chance) for step in most.run.steps] == [("safe", ("walk",), 1.0)]


@needs_storm
def test_a_run_against_what_is_always():
    (never,) = asked(read_system(CHOICE), "Pmin=? [G !home]")
    assert never.value.number == pytest.approx(0)
    assert "against it" in never.what
    assert [step.rules for step in never.run.steps] == [("walk",)]


@needs_storm
def test_rewards():
    bold, claim = asked(read_system(CHOICE), "Rmax=? [C<=1]", "R<=4 [C<=1]")
    assert bold.value.number == pytest.approx(5)
    assert (claim.outcome, claim.run) == (ClaimOutcome.VIOLATED, None)


@needs_storm
def test_a_strategy_is_what_gives_the_value():
    """The chain that a strategy leaves, solved as linear equations, has the probability that Storm gives."""
    found = explore(read_system(CHOICE))
    for query in ("Pmin=? [F home]", "Pmax=? [F home]"):
        (best,) = answers(found, [query])
        home, matrix = found.labels[0], np.zeros((len(found), len(found)))
        for each in found.transitions():
            if best.strategy.get(each.source, each.action) == each.action and not home[each.source]:
                matrix[each.source, each.target] += each.weight
        goal = np.array([float(flag) for flag in home])
        assert np.linalg.solve(np.eye(len(found)) - matrix, goal)[0] == pytest.approx(best.value.number)


@needs_storm
def test_of_a_part_nothing_is_claimed():
    (part,) = asked(die(), "P>=0.1 [F face1]", max_states=4)
    assert part.outcome is ClaimOutcome.INCOMPLETE
    assert "beyond them nothing happens" in part.note


SENDING = """\
fun atomic ctrl Radio(x) = 0; atomic ctrl Idle = 0;
big off = Idle;
fun big sent(x) = Radio(x);
fun react send(x) = Idle -[ x ]-> Radio(x);
begin pbrs float x = {1.0, 3.0}; init off; rules = [ {send(x)} ]; preds = { sent(x) }; end
"""


@needs_storm
def test_predicates_stand_in_a_formula_as_in_the_file():
    system = read_system(SENDING)
    bare, quoted = asked(system, "P=? [F sent(3.0)]", 'P=? [F "sent(3.0)"]')
    assert bare.value.number == quoted.value.number == pytest.approx(0.75)


@needs_storm
@pytest.mark.parametrize(
    ("text", "written"),
    [
        ("P=? [F home]", 'P=? [F "home"]'),
        ('Pmax=? [G<=1e-3 !"home"]', 'Pmax=? [G<=1e-3 !"home"]'),
        ("P>=0.5 [!home U (home & init)]", 'P>=0.5 [!"home" U ("home" & "init")]'),
        ("Rmin=? [C<=10]", "Rmin=? [C<=10]"),
        ("P=? [F (home)]", 'P=? [F ("home")]'),
        ("P=? [F<=2.5E+1 home]", 'P=? [F<=2.5E+1 "home"]'),
    ],
)
def test_names_become_labels(text, written):
    assert translated(text, read_system(CHOICE)) == written


@pytest.mark.parametrize(
    ("text", "column", "said"),
    [
        ("P=? [F hom]", 8, "unknown predicate 'hom'"),
        ('P=? [F "hom"]', 8, "unknown predicate 'hom'"),
        ("P=? [F /etc/passwd]", 9, "unknown predicate 'etc'"),
        ("P=? [F home] " + "x" * 3000, 1, "more than 2,000 characters"),
    ],
)
def test_what_is_no_predicate_is_refused_with_its_place(text, column, said):
    with pytest.raises(NotationError, match=said) as found:
        translated(text, read_system(CHOICE))
    assert found.value.column == column


@needs_storm
@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("Pmax=? [F home & ", "expecting"),
        ("P=? [F home]", "has many values"),
        ("", "0 formulas"),
        ("home", "no operator"),
    ],
)
def test_what_storm_cannot_read_is_refused_before_anything_is_explored(text, said):
    with pytest.raises(Mistake, match=said):
        check_queries([text], read_system(CHOICE))


def test_without_storm_it_is_said_how_to_get_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "stormpy", None)
    with pytest.raises(Mistake, match="not installed") as found:
        check_queries(["Pmax=? [F home]"], read_system(CHOICE))
    assert "[storm]" in found.value.hint


@needs_storm
def test_the_command_line_prints_values_strategies_and_runs(bigactors, tmp_path):
    file = tmp_path / "choice.big"
    file.write_text(CHOICE)
    code, out, _ = bigactors(
        "big", "check", str(file), "--storm", "Pmin=? [F home]", "--storm", "P>=0.9 [F home]"
    )
    assert code == 1
    assert "= storm Pmin=? [F home]: 0.25\n      an optimal strategy chooses bold in state 0\n" in out
    assert "✗ storm P>=0.9 [F home]: violated, it is 0.25" in out
    assert "        1: --bold: leap, 0.25--> B" in out
    code, out, _ = bigactors("big", "check", str(file), "--storm", "Rmin=? [F home]", "--json", "-")
    verdict = json.loads(out)["verdicts"][0]
    assert (code, verdict["value"]["number"], verdict["strategy"]) == (0, 1, {"0": "safe"})


def test_a_query_without_an_answer_takes_no_others(monkeypatch):
    """What Storm says of each query is given: where it has no answer, and where it fails on one of them."""

    def replies(texts, _files=None):
        if len(texts) > 1 and "LRA" in "".join(texts):
            raise Mistake("Storm failed: it ended", "")
        if texts == ["LRA=? [goal]"]:
            raise Mistake("Storm failed: it ended", "")
        return [{"error": "no rewards"} if text.startswith("R") else {"value": 0.5} for text in texts]

    monkeypatch.setattr(storm, "_replies", replies)
    monkeypatch.setattr(storm, "translated", lambda text, _: text)
    found = explore(die())
    rewards, chance = answers(found, ["R=? [F goal]", "P=? [F goal]"])
    assert rewards.outcome is ClaimOutcome.INCOMPLETE
    assert (
        rewards.note == "no answer: the system has no rewards; give a predicate one, as in preds = { p[2] }"
    )
    assert (chance.outcome, chance.value.number) == (ClaimOutcome.HOLDS, 0.5)
    chance, long_run = answers(found, ["P=? [F goal]", "LRA=? [goal]"])
    assert (chance.value.number, long_run.outcome) == (0.5, ClaimOutcome.INCOMPLETE)
    assert long_run.note == "no answer: Storm failed: it ended"


@needs_storm
def test_rewards_that_there_are_none_of_are_said_beside_other_answers():
    rewards, chance = asked(die(), "R=? [F face1]", "P=? [F face1]")
    assert rewards.note.startswith("no answer: the system has no rewards")
    assert chance.value.number == pytest.approx(1 / 6)
