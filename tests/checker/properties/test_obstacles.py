"""What is missing for a control that can't be served, by name."""

import pytest
from checked_missions import verdict, violation

MISSING = {
    "an authority": ("gcs0", "MOVE vessel0 TO gate0", "unmatched", "vessel0 is not on control:gcs0"),
    "an authority of one's own": (
        "vessel0",
        "HAND uav0 TO gcs1",
        "unmatched",
        "vessel0 is not on control:gcs0",
    ),
    "one authority of both": (
        "gcs0",
        "MOVE uav1 TO gate0",
        "unmatched",
        "gcs0 is on control:gcs0, uav1 is on control:gcs1: on none together",
    ),
    "a place on the carrier": (
        "uav0",
        "PUT drifter0 IN gate0",
        "unmatched",
        "drifter0 is not in uav0: L has it in vessel0",
    ),
}


@pytest.mark.parametrize("case", MISSING.values(), ids=MISSING)
def test_an_obstacle_names_what_is_missing(case):
    host, command, kind, words = case
    text = f"BigActor a hosted_at {host} with_behavior {{ control({command}) }}\n"
    assert words in violation(verdict(text, "local_consistency"), kind).details
