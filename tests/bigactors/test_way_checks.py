"""Before take-off a run names the claims about ways that it watches, and those that it does not."""

from bigactors.arguments import parse_arguments
from bigactors.cli import main
from bigactors.commands.run.flight import prepare
from bigactors.commands.run.preflight_checks import check_ways, unseen, unwatched

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
environment { uav0 arrives UAV strays at most 100 m }
control timed
check { CHECKS }
"""


def prepared(folder, checks, *, verified=True, vehicle="uav0"):
    path, verdict = folder / "ways.mission", folder / "ways.verdict.json"
    path.write_text(MISSION.replace("CHECKS", checks))
    words = ["run", str(path), f"--vehicle={vehicle}=udp:127.0.0.1:0"]
    if verified:
        assert main(["check", str(path), "--verdict", str(verdict)]) == 0
    return prepare(parse_arguments([*words, *([] if verified else ["--unverified"])]))


def test_invariants_about_ways_are_watched_and_a_verdict_that_rests_on_strays_permits_the_flight(
    tmp_path, capsys
):
    flight = prepared(tmp_path, 'invariant "no fly": not possibly uav0 in prison0')
    assert [each.name for each in flight.plan.invariants] == ["no fly"]
    check_ways(flight.plan, flight.mission, flight.plugins, {"uav0"})
    assert "warning" not in capsys.readouterr().err


def test_properties_of_runs_about_ways_are_named_since_nothing_watches_them(tmp_path):
    flight = prepared(tmp_path, 'ltl "never": [] not possibly uav0 in prison0', verified=False)
    assert [*unwatched(flight.plan, flight.mission)] == [
        "'never' is not watched: of properties about ways, a run watches invariants only"
    ]


def test_an_entity_that_moves_and_that_nothing_has_reported_is_named(tmp_path):
    flight = prepared(tmp_path, 'invariant "no fly": not possibly uav0 in prison0')
    assert [*unseen(flight.plan, {"uav0"})] == []
    assert [*unseen(flight.plan, ())] == [
        "nothing has reported uav0: until it is seen it may be anywhere, and 'no fly' counts so"
    ]
