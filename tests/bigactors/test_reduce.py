"""`check --reduce`: what it prints and writes, and what it refuses."""

import json

import pytest


def test_a_reduced_search_says_so_and_how_much_it_followed(bigactors):
    code, out, _ = bigactors("check", "broken_deadlock", "--reduce", "por")
    assert code == 1
    assert out.startswith(
        "broken_deadlock: 128 configurations, 138 of 204 transitions, depth 46, complete, reduced by por, "
    )
    assert "a trace, 22 steps:" in out
    assert "shortest" not in out


@pytest.mark.parametrize(
    ("more", "counts"), [(("--reduce", "por"), (["por"], 138, 204)), ((), ([], 1128, 1128))]
)
def test_the_report_as_json_says_so_too(bigactors, more, counts):
    report = json.loads(bigactors("check", "broken_deadlock", *more, "--json", "-")[1])
    assert (report["reduced"], report["transitions"], report["transitions_allowed"]) == counts


def test_a_property_that_it_would_be_unsound_for_is_incomplete(bigactors):
    code, out, _ = bigactors("check", "tanker", "--reduce", "por")
    assert code == 3
    (line,) = [line for line in out.splitlines() if line.startswith("  ? met ")]
    assert "incomplete; not decided under this reduction: fairness asks which steps stay enabled" in line


def test_stale_observations_are_searched_for_with_less_to_visit(done):
    out = done("check", "rendezvous", "--reduce", "por")
    assert "searched over 56 configurations with the monitor's memory, reduced by por" in out
