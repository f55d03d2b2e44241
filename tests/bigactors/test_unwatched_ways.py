"""A run says that it does not watch ways, and refuses a verdict that rests on strays."""

import pytest

from bigactors.arguments import parse_arguments
from bigactors.cli import main
from bigactors.commands.run.flight import prepare
from bigactors.mistakes import Mistake

MISSION = """
mission ways
signature standard
world {
  west0: Location = circle (37.1, -8.64) radius 300 m
  east0: Location = circle (37.1, -8.56) radius 300 m
  prison0: Location = circle (37.12, -8.6) radius 300 m
  uav0: UAV = point (37.1, -8.641)
}
BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO east0) }
environment { uav0 arrives MORE }
control timed
check { invariant "no fly": CLAIM }
"""


def prepared(folder, claim, more="", *, verified=True):
    path, verdict = folder / "ways.mission", folder / "ways.verdict.json"
    path.write_text(MISSION.replace("CLAIM", claim).replace("MORE", more))
    words = ["run", str(path), "--vehicle=uav0=udp:127.0.0.1:0"]
    if verified:
        assert main(["check", str(path), "--verdict", str(verdict)]) == 0
    return prepare(parse_arguments([*words, *([] if verified else ["--unverified"])]))


def test_a_run_names_the_properties_about_ways_that_it_does_not_watch(tmp_path, capsys):
    prepared(tmp_path, "not possibly uav0 in prison0")
    said = capsys.readouterr().err
    assert "warning: the run does not watch ways: 'no fly' (line 13)" in said
    assert "flies straight" in said


def test_a_run_refuses_a_verdict_that_rests_on_strays(tmp_path):
    with pytest.raises(Mistake, match="does not watch 'strays' yet, and the verdict on 'no fly'") as refused:
        prepared(tmp_path, "not possibly uav0 in prison0", "uav0 strays at most 30 m")
    assert "leave strays out" in refused.value.hint


@pytest.mark.parametrize(
    ("claim", "more", "verified"),
    [
        ("not actually uav0 in prison0", "uav0 strays at most 30 m", True),
        ("not possibly uav0 in prison0", "uav0 strays at most 30 m", False),
    ],
)
def test_strays_on_which_no_verdict_rests_is_no_reason(tmp_path, claim, more, verified):
    prepared(tmp_path, claim, more, verified=verified)
