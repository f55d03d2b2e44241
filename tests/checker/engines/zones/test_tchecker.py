"""What is exported for TChecker, judged by TChecker: `make time-oracle`, where TCHECKER names its `tck-reach`."""

import os

import pytest
from hypothesis import HealthCheck, given
from scale import examples
from shipped import TIMED
from timed_models import ENDURANCE, agree, found_by_tchecker, questions

from checker.engines.zones.tchecker import tchecker_text
from specs.elaboration import load_mission

pytestmark = pytest.mark.skipif("TCHECKER" not in os.environ, reason="TCHECKER names no program `tck-reach`")


@pytest.mark.parametrize("name", TIMED)
def test_it_comes_to_the_same_verdicts_of_a_shipped_mission(tmp_path, name):
    mission = load_mission(name)
    agree(
        mission.initial, mission.properties, lambda model: found_by_tchecker(tchecker_text(model), tmp_path)
    )


@examples(200, deadline=None, suppress_health_check=list(HealthCheck))
@given(questions())
def test_it_comes_to_the_same_verdicts_of_generated_missions(tmp_path_factory, question):
    c, asked = question
    folder = tmp_path_factory.mktemp("tchecker")
    agree(c, (asked, ENDURANCE), lambda model: found_by_tchecker(tchecker_text(model), folder))
