"""Claims about regions are decided alike by every engine, with reductions, workers, checkpoints and threads."""

import pytest
from checked_missions import interrupted_at
from local_crew import LocalCrew
from scale import IS_WHOLE

from checker import Engine, Keeping, Limits, Reduction, check, explore
from checker.check import reductions_of
from checker.engines.cluster.explorer import Expedition
from checker.engines.contract import Options
from checker.properties.inspections import Invariant
from checker.reduction import Ample
from checker.reduction.footprint_check import outside
from checker.reduction.refusals import RefusedError
from specs.elaboration import read_mission

TEXT = """
signature {
  kind Area contains Area, Spot, UAV, Vessel
  kind Spot contains UAV
  kind UAV driven
  kind Vessel driven carries UAV
}
control timed
world {
  west0: Area = circle (37.1, -8.64) radius 300 m
  east0: Area = circle (37.1, -8.56) radius 300 m
  north0: Area = circle (37.15, -8.6) radius 300 m
  prison0: Area = circle (37.1, -8.6) radius 900 m
  spot0: Spot = circle (37.12, -8.56) radius 300 m
  uav0: UAV = point (37.1, -8.641)
  uav1: UAV = point (37.1, -8.641)
  ship0: Vessel = point (37.2, -8.6)
}
BigActor w[i] for u in UAV hosted_at u with_behavior { FLIGHTS }
environment { ENVIRONMENT }
check {
  invariant "no fly": forall x: UAV . not possibly x in prison0
  invariant "in range": forall x: UAV . x within 30 km of ship0
  invariant "not by the spot": forall x: UAV . x at least 500 m from spot0
  reachable "over it": exists x: UAV . possibly x in north0
  reachable "surely there": exists x: UAV . surely x in east0
  ltl "comes": <> (exists x: UAV . surely x in east0) or [] (forall x: UAV . not surely x in prison0)
}
"""
FLIGHTS = {
    "straight": "control(MOVE_HOST_TO east0)",
    "around": "control(MOVE_HOST_TO east0 VIA north0)",
    "aboard": "control(MOVE_HOST_TO ship0) control(MOVE_HOST_TO east0 VIA north0)",
    "looking": "observe(CHILDREN(west0)) react { case obs => control(MOVE_HOST_TO spot0) }",
}
ENVIRONMENTS = {
    "still": "",
    "drifting": "spot0 drifts among point (37.12, -8.56), point (37.14, -8.58)",
    "vanishing": "uav1 vanishes UAV strays at most 30 m",
}
ALL = [(way, world) for way in FLIGHTS for world in ENVIRONMENTS]
CASES = ALL if IS_WHOLE else ALL[::5]


def mission(way, world):
    return read_mission(TEXT.replace("FLIGHTS", FLIGHTS[way]).replace("ENVIRONMENT", ENVIRONMENTS[world]))


def decided(report):
    return {v.property.name: (v.outcome, v.count, v.examined) for v in report.verdicts}


def outcomes(report):
    return {v.property.name: v.outcome for v in report.verdicts if not v.note.startswith("not decided under")}


@pytest.mark.parametrize(("way", "world"), CASES)
def test_engines_and_reductions_agree_on_claims_about_regions(way, world):
    asked = mission(way, world)
    right = check(asked, engine=Engine.REFERENCE)
    fast = check(asked, engine=Engine.FAST)
    assert decided(fast) == decided(right)
    assert (fast.configurations, fast.transitions) == (right.configurations, right.transitions)
    sound = reductions_of(asked)
    assert Reduction.POR in sound
    for reduce in {(each,) for each in sound} | {sound}:
        for engine in (Engine.REFERENCE, Engine.FAST):
            assert outcomes(check(asked, engine=engine, reduce=reduce)).items() <= outcomes(right).items()


@pytest.mark.parametrize(("way", "world"), CASES)
def test_whatever_a_claim_about_a_region_reads_is_visible(way, world):
    asked = mission(way, world)
    formulas = [each.formula for each in asked.properties if each.kind.has_proposition]
    ample = Ample(asked.initial, formulas)
    for c in explore(asked.initial, limits=Limits(configurations=120)).configurations[::4]:
        assert list(outside(ample, c)) == []


def test_workers_threads_and_resumed_searches_find_the_same_violations(tmp_path):
    asked = mission("looking", "drifting")
    right = check(asked, engine=Engine.REFERENCE)
    invariant = next(each for each in asked.properties if each.name == "not by the spot")
    looking = Invariant(invariant.formula)
    options = Options(Limits())
    Expedition(LocalCrew(asked.initial, 2, options.limits.pending), asked.initial, options).run([looking])
    assert looking.collected.count == decided(right)["not by the spot"][1] > 0
    assert decided(check(asked, engine=Engine.FAST, threads=2)) == decided(right)
    kept = Keeping(str(tmp_path), digest="d", every=0.0)
    early, stop = interrupted_at(15, Limits())
    check(asked, limits=early, report=stop, engine=Engine.FAST, keeping=kept)
    resumed = Keeping(str(tmp_path), digest="d", every=0.0, resumed=True, doubted=50)
    assert decided(check(asked, engine=Engine.FAST, keeping=resumed)) == decided(right)


def test_vehicles_that_stray_differently_are_not_interchangeable():
    text = TEXT.replace("FLIGHTS", FLIGHTS["straight"])
    alike, unlike = (
        read_mission(text.replace("ENVIRONMENT", f"{each} strays at most 30 m")) for each in ("UAV", "uav0")
    )
    check(alike, engine=Engine.FAST, reduce=[Reduction.SYMMETRY])
    with pytest.raises(RefusedError, match="one strays farther from its way than the other"):
        check(unlike, engine=Engine.FAST, reduce=[Reduction.SYMMETRY])
