"""Progress beside the same claim in linear time, request by request, on generated missions."""

import subprocess
import sys
from pathlib import Path

import numpy as np
from checked_missions import load
from hypothesis import assume, given
from hypothesis import strategies as st
from scale import examples

from checker import Engine, Limits, check, explore
from checker.properties.temporal.decide import TemporalDecider
from checker.properties.temporal.fairness import EACH_RULE_AND_REQUEST
from checker.properties.temporal.linear import counterexample
from checker.properties.temporal.served_requests import ProgressSearch, owed, pending_requests
from checker.properties.temporal.truth import FormulaTruth
from semantics.hypothesis_strategies import initial_configurations
from semantics.properties.propositions import Known
from semantics.properties.temporal import (
    SERVES,
    Denied,
    Either,
    Eventually,
    Fairness,
    Globally,
    Now,
    Steps,
    Taken,
)

EXTRA = st.lists(
    st.sampled_from(
        [Fairness(True, Steps(("actuate",)), ("agent",)), Fairness(False, Steps(("env",)), ("label",))]
    ),
    max_size=2,
    unique=True,
)


@examples(40)
@given(initial_configurations(monitored=False), EXTRA)
def test_a_request_is_starved_where_linear_time_says_so(c, extra):
    found = explore(c, limits=Limits(configurations=400), edges=True)
    assume(found.complete)
    decider = TemporalDecider(found, [])
    arriving = decider.setting.arriving
    pending = owed(pending_requests(found.configurations), arriving)
    fairness = decider.conditions((*EACH_RULE_AND_REQUEST, *extra))
    progress = ProgressSearch(decider.graph, pending, fairness, arriving)
    for request, numbers in pending.items():
        starved = bool((progress.waiting(request) >= 0).any())
        assert starved == is_violated(decider, fairness, request, numbers)
    assert progress.starved()[1] == sum(bool((progress.waiting(r) >= 0).any()) for r in pending)


def is_violated(decider, fairness, request, numbers):
    """Tell whether a fair run comes to where the request is pending, and never serves it from there on."""
    graph, pending, served = decider.graph, Known("pending"), Taken(Steps(("served",)))
    here = np.zeros(graph.size, dtype=np.bool_)
    here[numbers] = True
    labels = [label.rule in SERVES and label.about == request for label in graph.labels]
    taken = graph.taken(np.array(labels, dtype=np.bool_))
    formula = Globally(Either(Denied(Now(pending)), Eventually(served)))
    return (
        counterexample(graph, FormulaTruth(graph, {pending: here}, {served: taken}), formula, fairness)
        is not None
    )


def test_of_requests_that_starve_alike_every_engine_shows_the_same():
    apart = """
    signature { kind Place contains UAV kind UAV driven }
    world { p0: Place = box (0, 0) (1, 1)  u0: UAV = point (0.5, 0.5)  u1: UAV = point (0.5, 0.6) }
    BigActor a hosted_at u1 with_behavior { observe(HOST) send "x" to b }
    BigActor b hosted_at u0 with_behavior { send "x" to a }
    scheduler fcfs
    check { progress }
    """
    mission = load(apart, "")
    reports = [check(mission, engine=engine) for engine in (Engine.REFERENCE, Engine.FAST)]
    shown = [[each.message for each in report.verdicts["progress"].violations] for report in reports]
    assert shown[0] == shown[1] == ['SND(a, b, "x") is never served']


def test_what_asks_nothing_of_runs_loads_no_library_for_them():
    code = """if True:
        import sys
        from pathlib import Path
        from checker import check
        from specs.elaboration import load_mission
        mission = load_mission(Path("specs/missions/oil_spill.mission"))
        assert check(mission).complete
        print([name for name in ("scipy", "checker.properties.temporal") if name in sys.modules])
    """
    root = Path(__file__).parents[4]
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=root,
        capture_output=True,
        text=True,
        check=True,
        env={"PYTHONPATH": "."},
    )
    assert done.stdout.strip() == "[]"
