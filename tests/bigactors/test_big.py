import json
import re
import signal

import pytest

from bigraphs.sampling import Sampler

WALK = """\
ctrl Room = 0; atomic ctrl Door = 1; atomic ctrl Robot = 0;
big world = /a /b (Room.(Robot | Robot | Door{a}) | Room.(Door{a} | Door{b}) | Room.Door{b});
react walk = Room.(Robot | Door{d} | id) || Room.(Door{d} | id)
  --> Room.(Door{d} | id) || Room.(Robot | Door{d} | id);
react burn = Room.(Robot | Robot | Robot | id) --> Room.(Robot | Robot | id) @ [0];
big meeting = Room.(Robot | Robot | id);
big crowd = Room.(Robot | Robot | Robot | id);
begin brs
  init world;
  rules = [ {walk, burn} ];
  preds = { meeting, crowd };
end
"""

DECAY = """\
float k = 2.;
atomic ctrl A = 0; atomic ctrl B = 0;
big start = A | A | A;
big gone = B | B | B;
react decay = A -[ k ]-> B;
begin sbrs init start; rules = [ {decay} ]; preds = { gone }; end
"""

ORDER = """\
atomic ctrl A = 0; atomic ctrl B = 0; atomic ctrl C = 0; atomic ctrl D = 0; atomic ctrl E = 0;
big s = A;
react ab = A --> B;
react ac = A --> C;
react bd = B --> D;
react ce = C --> E;
big isd = D; big ise = E;
begin brs init s;
  rules = [ (ac, ab), {bd, ce} ];
  preds = { isd, ise };
end
"""

LAMPS = """\
%active Lamp : 0;
%passive On : 0;
%passive Off : 0;
Lamp.Off -> Lamp.On;
Lamp.Off | Lamp.Off;
%property dark !matches(Lamp.On | Lamp.On);
%check
"""


@pytest.fixture
def walk(missions):
    (missions / "walk.big").write_text(WALK, encoding="utf-8")
    (missions / "decay.big").write_text(DECAY, encoding="utf-8")
    return missions


@pytest.mark.usefixtures("walk")
class TestBig:
    def test_full_counts_states_and_names_rules_that_are_never_used(self, done):
        out = done("big", "full", "walk.big")
        assert out.startswith("walk.big: 4 states, 6 transitions, 11 occurrences, complete, ")
        assert out.splitlines()[1:] == [
            "  meeting occurs in 2",
            "  crowd occurs in 0",
            "  rules never used: burn",
        ]

    def test_a_limit_makes_it_incomplete(self, bigactors):
        code, out, _ = bigactors("big", "full", "--max-states", "2", "walk.big")
        assert code == 3
        assert "incomplete: the limit of 2 states was reached" in out
        assert "\n  rules not used so far: burn\n" in out
        assert bigactors("big", "check", "--never", "crowd", "--max-states", "2", "walk.big")[0] == 3

    def test_full_writes_what_is_asked_for(self, bigactors, walk):
        files = ["--html", "w.html", "--svg", "w.svg", "--dot", "w.dot", "--json", "w.json"]
        code, _, err = bigactors("big", "full", *files, "--prism", "p", "--storm", "s", "walk.big")
        assert code == 0
        written = [line.removeprefix("  written: ") for line in err.splitlines()]
        assert written == [
            "w.html", "w.svg", "w.dot", "w.json", "p.tra", "p.lab", "p.csl", "p.srew", "p.trew", "s.tra", "s.lab",
        ]  # fmt: skip
        assert all((walk / name).read_text(encoding="utf-8") for name in written)

    def test_data_goes_to_standard_output_alone(self, done):
        out = done("big", "full", "--json", "-", "walk.big")
        assert len(json.loads(out)["states"]) == 4

    def test_a_predicate_that_fails_comes_with_a_shortest_run(self, bigactors):
        code, out, _ = bigactors("big", "check", "--always", "meeting", "walk.big")
        assert code == 1
        assert "  ✗ always meeting: violated\n      a shortest run to state 1, 1 step:\n" in out
        assert "        1: --walk--> " in out

    def test_what_holds_is_decided_by_looking_at_every_state(self, done):
        claims = ["--never", "crowd", "--reachable", "meeting", "--no-deadlock"]
        out = done("big", "check", *claims, "--json", "-", "walk.big")
        assert [(each["claim"], each["outcome"]) for each in json.loads(out)["verdicts"]] == [
            ("never crowd", "holds"),
            ("reachable meeting", "holds"),
            ("no deadlock", "holds"),
        ]

    def test_a_formula_that_fails_comes_with_a_run_and_its_loop(self, bigactors, done):
        out = done("big", "check", "--ltl", "<> not meeting", "walk.big")
        assert "  ✓ ltl <> not meeting: holds\n" in out
        code, out, _ = bigactors(
            "big", "check", "--ltl", "[]<> meeting", "--ctl", "AG EF meeting", "walk.big"
        )
        assert code == 1
        assert "  ✗ ltl []<> meeting: violated\n      a run on which it is false:\n        0: " in out
        assert re.search(
            r"\n        and again from state \d+, by --walk-->\n  ✓ ctl AG EF meeting: holds\n", out
        )

    def test_formulas_are_decided_in_data_too(self, bigactors):
        asked = ["--ltl", "[] not gone", "--ltl", "[]<> not gone", "--ctl", "AF gone"]
        code, out, _ = bigactors("big", "check", *asked, "--json", "-", "decay.big")
        prefix, lasso, tree = json.loads(out)["verdicts"]
        assert code == 1
        assert (prefix["outcome"], lasso["outcome"], tree["outcome"]) == ("violated", "violated", "holds")
        assert [each["rules"] for each in prefix["run"]] == [[], ["decay"], ["decay"], ["decay"]]
        assert (prefix["loop"], lasso["loop"]) == (None, {"to": 3, "rules": []})
        assert tree["run"] is None

    def test_formulas_about_what_was_not_explored_are_not_decided(self, bigactors):
        asked = ["--ltl", "[] not crowd", "--ctl", "AG EF meeting"]
        code, out, _ = bigactors("big", "check", *asked, "--max-states", "2", "walk.big")
        assert code == 3
        assert "  ? ltl [] not crowd: incomplete\n  ? ctl AG EF meeting: incomplete\n" in out

    def test_a_formula_with_a_mistake_is_refused_before_anything_is_explored(self, refused):
        err = refused("big", "check", "--ltl", "<> meetin", "walk.big")
        assert err == (
            "--ltl:1:4: unknown predicate 'meetin'\n    1 | <> meetin\n      |    ^^^^^^\n"
            "hint: did you mean 'meeting'?\n"
        )

    @pytest.mark.parametrize(
        ("task", "code"),
        [(("full",), 0), (("sim",), 0), (("validate",), 0), (("check", "--ctl", "EF isd"), 1)],
    )
    def test_an_order_of_instantaneous_rules_that_matters_is_warned_of(self, bigactors, tmp_path, task, code):
        file = tmp_path / "inst.big"
        file.write_text(ORDER, encoding="utf-8")
        found, _, err = bigactors("big", task[0], str(file), *task[1:])
        assert found == code
        assert (
            err
            == f"""\
warning: {file}:9:13: the instantaneous class (ac, ab) is not confluent: the order of its rules matters
  of A
  ac makes in the end C
  ab makes in the end B
hint: a run takes the first rule of the class that applies, again and again, here ac; let the rules exclude each \
other where that is not meant
"""
        )

    def test_a_property_of_a_bgm_file_that_holds_is_said_to(self, bigactors, walk):
        (walk / "lamps.bgm").write_text(
            LAMPS.replace("Lamp.On);", "Lamp.On) || terminal();"), encoding="utf-8"
        )
        code, out, _ = bigactors("big", "check", "lamps.bgm", "--no-deadlock", "--json", "-")
        assert code == 1
        assert [(each["claim"], each["outcome"]) for each in json.loads(out)["verdicts"]] == [
            ("no deadlock", "violated"),
            ("dark", "holds"),
        ]

    def test_a_state_of_named_nodes_is_printed(self, bigactors, tmp_path):
        file = tmp_path / "l.bgm"
        file.write_text(
            "l0_Location.u0_UAV | l1_Location;\n"
            "%rule go l0_Location.u0_UAV | l1_Location -> l0_Location | l1_Location.u0_UAV;",
            encoding="utf-8",
        )
        for task in (["validate"], ["show"], ["sim"]):
            code, out, _ = bigactors("big", *task, str(file))
            assert (code, "l0_Location.u0_UAV.1 | l1_Location.1" in out) == (0, True), task
        code, out, _ = bigactors("big", "check", "--no-deadlock", str(file))
        assert (code, "1: --go--> l0_Location.1 | l1_Location.u0_UAV.1" in out) == (1, True)

    def test_a_state_that_nests_too_deeply_to_be_written_is_told_by_its_size(self, bigactors, tmp_path):
        file = tmp_path / "deep.big"
        file.write_text(
            f"ctrl A = 0; big s = {'A * ' * 100}1; begin brs init s; rules = []; end", encoding="utf-8"
        )
        for task in ("validate", "show", "sim"):
            code, out, _ = bigactors("big", task, str(file))
            assert (code, "100 nodes of 1 control in 1 region" in out) == (0, True), task

    def test_an_undeclared_constant_may_be_given_by_an_option(self, bigactors, refused, tmp_path):
        file = tmp_path / "c.big"
        text = "fun ctrl A(n) = 0; big s = A(size).1; begin brs init s; rules = []; end"
        file.write_text(text, encoding="utf-8")
        err = refused("big", "full", str(file))
        assert "unknown value 'size'" in err
        assert "or give a constant of a file by --const size=VALUE" in err
        assert bigactors("big", "full", "--const", "size=3", str(file))[0] == 0

    def test_a_property_of_a_bgm_file_is_checked(self, bigactors, walk):
        (walk / "lamps.bgm").write_text(LAMPS, encoding="utf-8")
        code, out, _ = bigactors("big", "check", "lamps.bgm")
        assert code == 1
        assert "✗ dark: violated" in out
        assert "2 steps" in out

    def test_a_run_is_the_same_for_the_same_seed(self, bigactors):
        one = bigactors("big", "sim", "--seed", "3", "--steps", "5", "walk.big")
        assert one == bigactors("big", "sim", "--seed", "3", "--steps", "5", "walk.big")
        assert one[0] == 0
        assert len(one[1].splitlines()) == 6

    def test_a_run_of_rates_has_times_and_ends_where_nothing_can_happen(self, bigactors):
        code, out, _ = bigactors("big", "sim", "--json", "-", "decay.big")
        run = json.loads(out)["run"]
        assert code == 0
        assert [stage["rule"] for stage in run] == [None, "decay", "decay", "decay"]
        assert 0 == run[0]["time"] < run[1]["time"] < run[2]["time"] < run[3]["time"]
        assert run[3]["labels"] == ["gone"]
        assert len(run[1]["kept"]) == 2  # the third A has become another node
        assert len(bigactors("big", "sim", "--until", "1e-9", "decay.big")[1].splitlines()) == 1

    def test_many_runs_say_when_predicates_are_first_true(self, bigactors, walk):
        code, out, err = bigactors(
            "big", "sim", "--runs", "200", "--until", "9", "--plot", "d.svg", "decay.big"
        )
        assert code == 0
        assert out.startswith("decay.big: 200 runs of seed 0, ")
        assert "went on to time 9" in out or "ended where no rule applies" in out
        assert re.search(
            r"\n  gone +[\d.]+ % of the runs \([\d.]+ to [\d.]+\), first at [\d.]+ \([\d.]+ to [\d.]+\)", out
        )
        assert err == "  written: d.svg\n"
        drawn = (walk / "d.svg").read_text(encoding="utf-8")
        assert "the share of 200 runs" in drawn
        assert ">gone<" in drawn

    def test_many_runs_are_data_too(self, bigactors):
        code, out, _ = bigactors("big", "sim", "--runs", "20", "--seed", "5", "--json", "-", "decay.big")
        said = json.loads(out)
        assert (code, said["runs"], said["complete"], said["ends"]["stuck"]) == (0, 20, True, 20)
        (gone,) = said["predicates"]
        times = [each["first"]["gone"] for each in said["samples"]]
        assert gone["first"]["least"] == min(times)
        assert gone["first"]["run"] == times.index(min(times))
        assert gone["first"]["interval"][0] < sum(times) / 20 < gone["first"]["interval"][1]
        one = ("big", "sim", "--seed", "5", "--run", "2", "--json", "-", "decay.big")
        run = json.loads(bigactors(*one)[1])["run"]
        assert run[-1]["time"] == times[2]

    def test_an_interruption_keeps_the_runs_that_were_taken(self, bigactors, monkeypatch):
        take = Sampler.run

        def interrupted(sampler, number):
            if number == 100:
                signal.raise_signal(signal.SIGINT)
            return take(sampler, number)

        monkeypatch.setattr(Sampler, "run", interrupted)
        code, out, _ = bigactors("big", "sim", "--runs", "1000000000", "decay.big")
        assert code == 3
        assert "  interrupted: 999," in out
        assert "\n  gone " in out

    def test_a_constant_may_have_another_value(self, bigactors):
        _, out, _ = bigactors("big", "full", "--const", "k=7", "--json", "-", "decay.big")
        assert json.loads(out)["transitions"][0]["weight"] == 21

    def test_validate_says_what_is_in_a_file(self, done):
        out = done("big", "validate", "walk.big")
        assert out.splitlines()[0] == "walk.big: a brs of 2 rules"
        assert "  a class, one at a time: walk, burn" in out

    def test_validate_names_a_rule_once_however_many_instances_it_has(self, done, tmp_path):
        (tmp_path / "count.big").write_text("""
            atomic fun ctrl N(n) = 0; big zero = N(0); fun big at(n) = N(n); react stay = N(0) --> N(0);
            fun react up(n) = N(n) --> N(n + 1);
            begin brs int n = [0 : 1 : 999]; init zero; rules = [ {up(n), stay} ]; preds = { at(n) }; end
        """)
        out = done("big", "validate", str(tmp_path / "count.big"))
        assert out.splitlines() == [
            "count.big: a brs of 1,001 rules",
            "  initial state: N(0)",
            "  a class, one at a time: up (1,000), stay",
            "  predicates: at (1,000)",
        ]

    def test_a_long_state_is_told_by_its_size(self, bigactors, tmp_path):
        balls = " | ".join(["Ball{a}"] * 80)
        (tmp_path / "balls.big").write_text(f"""
            ctrl Room = 0; atomic ctrl Ball = 1; big all = /a Room.({balls}) || Room.1;
            react go = Ball{{x}} -[1]-> Ball{{x}};
            begin sbrs init all; rules = [ {{go}} ]; end
        """)
        _, out, _ = bigactors("big", "validate", str(tmp_path / "balls.big"))
        assert out.splitlines()[:2] == [
            "balls.big: an sbrs of 1 rule",
            "  initial state: 82 nodes of 2 controls in 2 regions, 1 edge, 0 names; 'bigactors big show' prints it",
        ]

    def test_instances_that_occur_nowhere_and_rules_never_used_are_one_line_each(self, bigactors, tmp_path):
        (tmp_path / "count.big").write_text("""
            atomic fun ctrl N(n) = 0; big zero = N(0); fun big at(n) = N(n); react stay = N(0) --> N(0);
            fun react up(n) = N(n) --> N(n + 1);
            begin brs
              int n = [1 : 1 : 999]; init zero; rules = [ {up(n), stay} ]; preds = { at(0), at(n), zero };
            end
        """)
        _, out, _ = bigactors("big", "full", str(tmp_path / "count.big"))
        assert out.splitlines()[1:] == [
            "  at(0) occurs in 1",
            "  at (999) occurs in 0",
            "  zero occurs in 1",
            "  rules never used: up (999)",
        ]

    def test_show_prints_and_draws_a_state(self, bigactors, walk):
        code, out, _ = bigactors("big", "show", "--state", "1", "--output", "one.svg", "walk.big")
        assert code == 0
        assert out.startswith("state 1 = ")
        assert (walk / "one.svg").read_text(encoding="utf-8").startswith("<svg ")

    def test_a_system_that_ships_is_known_by_its_name(self, done):
        out = done("big", "full", "mobile_ambients")
        assert out.startswith("mobile_ambients: 4 states, 3 transitions, ")

    def test_a_mistake_in_a_file_is_shown_where_it_is(self, refused, walk):
        (walk / "bad.big").write_text(WALK.replace("Room.Door{b});", "Room.Dor{b});"), encoding="utf-8")
        err = refused("big", "full", "bad.big")
        assert err.startswith("bad.big:2:")
        assert "Dor" in err
        assert "^" in err
