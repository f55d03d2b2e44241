"""The public strategies: offered in one place, and usable as the how-to says."""

from hypothesis import Phase, find, given, settings
from scale import examples

import semantics.hypothesis_strategies
from bigactors import Limits, Outcome, check, strategies, successors
from bigactors.strategies import configurations, missions


def test_every_public_strategy_is_offered_and_its_own():
    defined = {
        name
        for name, value in vars(semantics.hypothesis_strategies).items()
        if not name.startswith("_") and getattr(value, "__module__", "") == "semantics.hypothesis_strategies"
    }
    assert set(strategies.__all__) == defined - {"T", "pick"}
    assert all(
        getattr(strategies, name) is getattr(semantics.hypothesis_strategies, name)
        for name in strategies.__all__
    )


@given(missions())
@examples(30)
def test_a_generated_mission_is_checked(mission):
    report = check(mission, limits=Limits(configurations=30))
    assert [each.property for each in report.verdicts] == list(mission.properties)


@given(configurations())
@examples(100)
def test_a_generated_configuration_has_its_successors(configuration):
    for transition in successors(configuration):
        assert transition.target.setting is configuration.setting


def test_missions_hold_and_are_violated():
    def is_one(outcome):
        return lambda each: (
            outcome in {v.outcome for v in check(each, limits=Limits(configurations=20)).verdicts}
        )

    first = settings(phases=[Phase.generate], database=None)
    for outcome in (Outcome.HOLDS, Outcome.VIOLATED):
        assert find(missions(), is_one(outcome), settings=first).initial.alpha.names()
