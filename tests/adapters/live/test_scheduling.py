"""Which requests a live run looks at: from the queue alone the same as from all that is pending."""

import pytest
from live_missions import LIVE

from adapters.live.scheduling import in_turn, to_serve
from checker import Engine, Limits, explore
from semantics.state.requests import FLY
from specs.elaboration import load_mission
from specs.missions import shipped_missions

MISSIONS = ("oil_spill", "harbour_watch", "search_and_deploy")


@pytest.mark.parametrize("name", MISSIONS)
def test_what_is_served_is_all_that_is_in_turn_but_flights(name: str) -> None:
    initial = load_mission(shipped_missions()[name], LIVE).initial
    found = explore(initial, limits=Limits(configurations=1_000), engine=Engine.REFERENCE)
    flying = 0
    for c in found.configurations:
        several = tuple(in_turn(c))
        assert tuple(to_serve(c)) == tuple(each for each in several if not isinstance(each.request, FLY))
        flying += any(isinstance(each.request, FLY) for each in several)
    assert found.size > 10
    assert flying
