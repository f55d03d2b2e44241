"""simulate --choose: a run whose every step the user chooses, by a pipe."""

import io
import json
from pathlib import Path

import pytest

HANDOVER = str(Path(__file__).parents[2] / "specs/missions/handover.mission")
FIRST = [
    "   1  ⟨req_obs : bigActor0, observe(LINKED_TO(gcs2))⟩",
    '   2  ⟨say : "handover" to bigActor0⟩',
]


@pytest.fixture
def chosen(bigactors, monkeypatch):
    def run(answers, *words):
        monkeypatch.setattr("sys.stdin", io.StringIO(answers))
        code, out, err = bigactors("simulate", HANDOVER, "--choose", *words)
        return code, out.splitlines(), err

    return run


def test_what_is_enabled_is_listed_and_the_end_of_the_input_ends_the_run(chosen):
    code, out, err = chosen("")
    assert (code, err) == (0, "")
    assert out[0] == "c0 = ⟨ α"
    assert out[-3:] == [*FIRST, "ended after 0 steps"]


def test_a_number_takes_a_step_and_u_takes_it_back(chosen):
    _, out, _ = chosen("2\nu\nu\nq\n1\n")
    answered = out[out.index("> 2") :]
    assert answered == [
        "> 2",
        'c0 --⟨say : "handover" to bigActor0⟩--> c1',
        '      α  mailbox(bigActor0) = "handover"',
        "         may still be said: 0",
        FIRST[0],
        "> u",
        "back at c0",
        *FIRST,
        "> u",
        "this is the beginning: there is no step to take back",
        "> q",
        "ended after 0 steps",
    ]


@pytest.mark.parametrize("answer", ["x", "0", "3", "-1", "1.0", "9" * 300, "1 2", "²"])
def test_another_answer_is_told_what_could_be_answered(chosen, answer):
    _, out, _ = chosen(f"{answer}\n")
    assert out[-2] == (
        f"{answer[:40]!r} is no choice here: answer a number from 1 to 2, r, u, s, f, q, or ? for their meaning"
    )


def test_formulas_and_the_configuration_are_shown_when_asked(chosen):
    _, out, _ = chosen("f\ns\n?\n\n")
    assert out[out.index("> f") + 1 :][:3] == [
        "  true   someone is in authority: actually uav0 linked control:gcs0 or actually uav0 linked control:gcs2",
        "  false  handed over: actually uav0 linked gcs0",
        "> s",
    ]
    assert out.count("c0 = ⟨ α") == 2
    assert out[-3:] == ["  q  ends the run, as the end of the input does", "> ", "ended after 0 steps"]


def test_chance_is_that_of_the_seed_and_the_run_is_written_as_a_trace_that_replays(
    chosen, bigactors, tmp_path
):
    written = tmp_path / "run.json"
    _, once, _ = chosen("r\n" * 40, "--seed", "7", "--json", str(written))
    assert chosen("r\n" * 40, "--seed", "7")[1] == once
    steps = json.loads(written.read_text(encoding="utf-8"))["steps"]
    assert once[-1] == f"ended after {len(steps)} steps"
    assert bigactors("replay", str(written))[0] == 0


@pytest.mark.usefixtures("missions")
def test_where_nothing_is_enabled_a_step_can_only_be_taken_back(bigactors, monkeypatch):
    monkeypatch.setattr("sys.stdin", io.StringIO("r\n" * 30))
    out = bigactors("simulate", "holds.mission", "--choose")[1].splitlines()
    assert "nothing more is enabled" in out
    assert out[-2] == "'r' is no choice here: answer u, s, f, q, or ? for their meaning"


@pytest.fixture
def chosen_in_time(bigactors, monkeypatch):
    def run(answers):
        monkeypatch.setattr("sys.stdin", io.StringIO(answers))
        return bigactors("simulate", "relay_timed", "--choose")[1].splitlines()

    return run


def test_with_times_it_is_shown_from_when_to_when_a_step_may_be_taken(chosen_in_time):
    out = chosen_in_time("1 0:10\n1\n")
    answered = out[out.index("> 1 0:10") :]
    assert answered[:7] == [
        "> 1 0:10",
        "c0 --at 0:10 ⟨req_obs : eye, observe(CHILDREN(PARENT(uav0)))⟩--> c1",
        "      α  eye@uav0 at react (line 19)",
        "      η  OBS(eye, CHILDREN(PARENT(uav0)))",
        "   1  0:10 to 0:20  ⟨sense : OBS(eye, CHILDREN(PARENT(uav0)))⟩",
        "   2  0:10 to 0:20  ⟨env : wifi drops⟩",
        "> 1",
    ]
    assert answered[7] == "c1 --at 0:10 ⟨sense : OBS(eye, CHILDREN(PARENT(uav0)))⟩--> c2"


@pytest.mark.parametrize(
    ("moment", "why"),
    [
        ("0:05", "a tick is 10 s"),
        ("0:20", "another step is due by 0:10"),
        ("soon", "write minutes and seconds, 1:30, or seconds, 90"),
    ],
)
def test_a_moment_at_which_a_step_cannot_be_taken_is_refused(chosen_in_time, moment, why):
    assert f"'{moment}' is no moment for it: {why}" in chosen_in_time(f"1 {moment}\n")
