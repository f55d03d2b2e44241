"""`--engine` and the options of long runs, on the command line."""

import pytest


@pytest.mark.usefixtures("missions")
@pytest.mark.parametrize(
    ("words", "wrong"),
    [
        (["--engine", "ray", "--reduce", "por"], "the ray explorer does not reduce"),
        (
            ["--engine", "reference", "--paranoid", "1"],
            "--paranoid is of the fast explorer and of reductions",
        ),
        (["--reduce", "por", "--checkpoint", "there"], "--checkpoint is of the fast explorer"),
        (["--hash-compact", "32"], "it is gone, since a configuration takes some 24 bytes: --max-memory"),
        (["--spill", "there"], "--spill is for when memory ends"),
        (
            ["--spill", "there", "--max-memory", "1G", "--engine", "reference"],
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
