"""Hash compaction: less to compare, the chance that something is left out, and nothing is said to hold."""

from pathlib import Path

import pytest

from bigactors.cli import main
from checker import Engine, Keeping, Limits, Outcome, Stop, check, explore
from checker.engines.fast.compacting import omission
from specs.elaboration import load_mission

MISSIONS = Path(__file__).parents[4] / "specs" / "missions"
RENDEZVOUS = MISSIONS / "rendezvous.mission"


def visited(bits, name="rendezvous", limits=None):
    mission = load_mission(MISSIONS / f"{name}.mission")
    return explore(mission.initial, limits=limits, engine=Engine.FAST, keeping=Keeping(compact=bits))


@pytest.fixture(scope="module")
def exact():
    """Return all that the rendezvous comes to, compared in full, and its configurations."""
    found = explore(load_mission(RENDEZVOUS).initial, engine=Engine.FAST)
    return found, list(found.configurations)


@pytest.mark.parametrize("bits", [40, 64])
def test_with_many_bits_the_same_is_visited(bits, exact):
    whole, configurations = exact
    found = visited(bits)
    assert list(found.configurations) == configurations
    assert found.rules == whole.rules
    assert [found.path(number) for number in range(0, 18_051, 997)] == [
        whole.path(number) for number in range(0, 18_051, 997)
    ]


def test_it_never_reads_as_complete_and_tells_the_chance():
    found = visited(32)
    assert not found.complete
    (bound,) = found.bounds
    bits, chance = bound.figures
    assert (bound.stop, bits) == (Stop.COMPACTION, 32)
    assert 0 < chance < 1e-3
    said = f"hash compaction to 32 bits: some were left out with a probability of at most {chance:.1g}"
    assert str(bound) == bound.effect == said


def test_with_few_bits_about_as_many_are_left_out_as_is_to_be_expected():
    """Each row that is new is left out with a probability of one in 2^8 for each tag that it is compared with."""
    found = visited(8)
    left_out = 18_051 - len(found.configurations)
    expected = found.survey.space.probed / 2**8
    assert expected / 3 < left_out < 5 * expected  # and what only they lead to
    assert omission(found.survey.space.probed, len(found.configurations), 8) > 0.99


def test_the_chance_falls_with_each_bit_by_half():
    one, other = omission(1_000_000, 1_000_000, 40), omission(1_000_000, 1_000_000, 41)
    assert one / other == pytest.approx(2, rel=0.1)
    assert omission(10**9, 10**9, 16) == 1.0


def test_what_is_found_is_reported_and_nothing_holds():
    mission = load_mission(MISSIONS / "look_before_entry_racy.mission")
    exact = check(mission.initial, mission.properties, engine=Engine.FAST)
    report = check(mission.initial, mission.properties, engine=Engine.FAST, keeping=Keeping(compact=64))
    for found, known in zip(report.verdicts, exact.verdicts, strict=True):
        whole = Outcome.INCOMPLETE if known.outcome is Outcome.HOLDS and known.examined else known.outcome
        assert found.outcome in (whole, Outcome.HOLDS if known.property.kind == "reachable" else whole)
        assert [len(each.trace.steps) for each in found.violations] == [
            len(each.trace.steps) for each in known.violations
        ]
    assert report.exit_code == 1


def test_the_limit_of_configurations_holds():
    assert len(visited(48, limits=Limits(configurations=500)).configurations) == 500


def test_the_command_line_says_incomplete(capsys):
    assert main(["check", str(RENDEZVOUS), "--hash-compact", "48", "--no-traces"]) == 3
    assert "hash compaction to 48 bits" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--hash-compact", "12"], "not a number of bits from 16 to 64"),
        (["--hash-compact", "32", "--reduce", "por"], "are of the fast explorer"),
        (["--hash-compact", "32", "--engine", "reference"], "are of the fast explorer"),
        (["--hash-compact", "32", "--engine", "ray"], "finds no configuration again"),
        (["--hash-compact", "32", "--paranoid", "3"], "finds no configuration again"),
    ],
)
def test_what_does_not_go_with_it_is_a_mistake(options, message, capsys):
    try:
        code = main(["check", str(RENDEZVOUS), *options])
    except SystemExit as ended:
        code = ended.code
    assert code == 2
    assert message in capsys.readouterr().err


def test_temporal_properties_are_not_decided():
    path = next(p for p in sorted(MISSIONS.glob("*.mission")) if "progress" in p.read_text(encoding="utf-8"))
    mission = load_mission(path)
    report = check(mission.initial, mission.properties, engine=Engine.FAST, keeping=Keeping(compact=64))
    (found,) = [each for each in report.verdicts if each.property.kind == "progress"]
    assert (found.outcome, found.note) == (
        Outcome.INCOMPLETE,
        "hash compaction keeps no transitions to go along",
    )
