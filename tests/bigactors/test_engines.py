"""`--engine` and the options of long runs, on the command line."""

import json

import pytest


@pytest.mark.usefixtures("missions")
def test_the_symbolic_engine_gives_the_same_counts_without_a_depth(bigactors):
    code, out, _ = bigactors("check", "holds.mission", "--engine", "symbolic", "--json", "-")
    report = json.loads(out)
    assert (report["configurations"], report["transitions"], report["depth"]) == (10, 10, None)
    assert report["complete"]
    assert code == 0


@pytest.mark.usefixtures("missions")
def test_what_the_symbolic_engine_does_not_decide_is_incomplete(bigactors):
    code, out, _ = bigactors("check", "broken_control_race", "--engine", "symbolic", "--no-traces")
    assert code == 3
    assert "race_freedom       incomplete; not decided: the symbolic engine looks for no races" in out


@pytest.mark.usefixtures("missions")
@pytest.mark.parametrize(
    ("words", "wrong"),
    [
        (["--engine", "symbolic", "--scheduler", "fcfs"], "the symbolic engine does not do scheduler fcfs"),
        (["--engine", "symbolic", "--reduce", "por"], "the symbolic explorer does not reduce"),
        (
            ["--engine", "symbolic", "--paranoid", "1"],
            "--paranoid is of the fast explorer and of reductions",
        ),
        (
            ["--reduce", "por", "--checkpoint", "there"],
            "--checkpoint and --hash-compact are of the fast explorer",
        ),
        (["--spill", "there"], "--spill is for when memory ends"),
        (
            ["--spill", "there", "--max-memory", "1G", "--engine", "symbolic"],
            "--spill is of the fast explorer",
        ),
        (["--spill", "holds.mission", "--max-memory", "1G"], "there is a file where a folder should be"),
    ],
)
def test_what_does_not_go_together_is_a_mistake(bigactors, words, wrong):
    code, out, err = bigactors("check", "race.mission", *words)
    assert (code, out) == (2, "")
    assert wrong in err


@pytest.mark.usefixtures("missions")
def test_with_room_on_a_disk_a_check_goes_on(bigactors):
    code, out, err = bigactors("check", "holds.mission", "--max-memory", "64G", "--spill", "there")
    assert (code, err) == (0, "")
    assert out.startswith("holds.mission: 10 configurations, 10 transitions, depth 8, complete, ")
