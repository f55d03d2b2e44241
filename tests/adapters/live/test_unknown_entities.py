"""What nobody announced: any number of it costs little, and leaves room for the others."""

import asyncio

import aiohttp
from live_missions import BETWEEN, EAST, TOUR, WEST, boat, flying, plan_of, seen
from test_loop import Looker, Vehicle

from adapters.detection_feed import Detections
from adapters.live.batch import Heard
from adapters.live.core import started
from adapters.live.loop import AT_ONCE, MOST_WAITING, Inbox, LiveRun
from adapters.live.run_watchers import Watchers
from adapters.live.unknown_entities import MOST_PLACES, MOST_STRANGERS, SHARE
from adapters.plugin import Aged, Gone
from adapters.web import Listen
from physical import PhysicalProperty, box, point
from semantics.live_policy import Fallback, LivePolicy
from semantics.state.physical_model import Placed

STAY = (
    "BigActor a hosted_at uav0 with_behavior { loop { observe(CHILDREN(west0)) react { case obs => skip } } }"
)
GOES_ON = LivePolicy(Fallback.CONTINUE)


def quiet_run(text=TOUR):
    return flying(text, GOES_ON)


def vessel(number, at=WEST, time=0.0, plugin="ais", ttl=60.0):
    said = PhysicalProperty(f"mmsi{number}", "Vessel", point(*at), time=time)
    return Heard(plugin, Aged(said, ttl))


def spill(number, corner):
    south, west = corner
    return Heard(
        "camera",
        PhysicalProperty(f"place{number}", "Location", box((south, west), (south + 1e-4, west + 1e-4))),
    )


def there(run, *names):
    return [run.state.configuration.structure.physical.placement(name) is not None for name in names]


def test_all_strangers_of_a_turn_come_in_one_step_and_are_told_in_one_line():
    run = quiet_run()
    run.turn(1.0, *(vessel(number) for number in range(300)))
    assert run.labels == ["⟨env : mmsi0 appears in west0, and so on for 299 more⟩"]
    assert run.messages() == [
        "mmsi0 (Vessel) is in west0, and so on for 299 more; the mission names no such entity"
    ]
    assert all(there(run, "mmsi0", "mmsi299"))
    run.turn(2.0, *(vessel(number, EAST, 2.0) for number in range(300)))
    run.turn(100.0, seen("uav0", WEST, 100.0))
    assert run.labels[1:] == [
        "⟨env : mmsi0 is seen in east0, and so on for 299 more⟩",
        "⟨env : mmsi0 vanishes, and so on for 299 more⟩",
    ]
    assert not any(there(run, "mmsi0", "mmsi299"))


def test_what_the_mission_names_has_a_step_of_its_own_among_strangers():
    run = quiet_run()
    run.turn(1.0, vessel(0), boat(EAST, 1.0), vessel(1))
    assert run.labels == [
        "⟨env : boat0 is seen in east0⟩",
        "⟨env : mmsi0 appears in west0, and so on for 1 more⟩",
    ]


def test_a_flood_of_one_plugin_leaves_room_for_the_others_and_there_is_an_end_to_all():
    run = quiet_run()
    run.turn(1.0, *(vessel(number) for number in range(MOST_STRANGERS)))
    run.turn(1.1, *(vessel(number, plugin="radar") for number in range(5_000, 6_000)))
    run.turn(1.2, *(vessel(number, plugin="camera") for number in range(7_000, 7_010)))
    assert run.state.sightings.admitted == {"ais": (SHARE, 0), "radar": (SHARE, 0)}
    strangers = run.state.configuration.setting.kinds.keys() - run.plan.first.setting.kinds.keys()
    assert len(strangers) == MOST_STRANGERS
    left_out = [finding.about for finding in run.findings if finding.kind == "trouble"]
    assert left_out == ["ais", "radar", "camera"]


def test_what_no_mission_could_use_and_what_is_withdrawn_at_once_is_not_kept():
    run = quiet_run()
    nowhere = [vessel(number, BETWEEN) for number in range(10)]
    run.turn(1.0, *nowhere, seen("ghost", WEST, 1.0, "ais", "Submarine", ()))
    run.turn(2.0, vessel(0), Heard("ais", Gone("mmsi0", 2.0, "ais")))
    assert run.state.sightings.newest.keys() == {"uav0"}
    assert run.steps == []


def test_strangers_that_have_borders_are_places_and_their_moves_are_seen():
    run = quiet_run()
    run.turn(1.0, *(spill(number, (37.005, -8.659 + number * 2e-4)) for number in range(20)))
    run.turn(2.0, spill(0, (37.005, -8.615)))
    assert run.labels == [
        "⟨env : place0 appears in west0, and so on for 19 more⟩",
        "⟨env : place0 is seen in east0⟩",
    ]


def test_of_places_that_nobody_announced_there_are_few_and_a_point_does_not_become_one():
    run = quiet_run()
    run.turn(
        1.0,
        *(spill(number, (37.005, -8.659 + number * 2e-4)) for number in range(MOST_PLACES + 5)),
        vessel(0),
    )
    assert run.state.sightings.admitted == {"camera": (MOST_PLACES, MOST_PLACES), "ais": (1, 0)}
    assert run.findings[0].message == (
        "'camera': 60 places that the mission does not name are taken in; more are ignored"
    )
    run.turn(
        2.0,
        Heard("ais", PhysicalProperty("mmsi0", "Vessel", box((37.005, -8.655), (37.006, -8.654)), time=2.0)),
    )
    assert run.state.configuration.structure.physical.placement("mmsi0").geometry.is_point


def test_nothing_is_carried_by_itself_over_others_or_not():
    """A chain that comes back to where it began would be followed for ever."""
    text = TOUR.replace("boat0:", "boat1: Vessel = point (37.03, -8.62)\n  boat0:")
    run = quiet_run(text.replace("kind Vessel", "kind Vessel carries Vessel"))
    for name, by in (("boat0", "boat0"), ("boat0", "boat1"), ("boat1", "boat0"), ("mmsi1", "mmsi1")):
        said = PhysicalProperty(name, "Vessel", point(*WEST), carried_by=by, time=1.0)
        run.turn(1.0, Heard("camera", said))
    physical = run.state.configuration.structure.physical
    assert (physical.carrier("boat0"), physical.carrier("boat1"), physical.carrier("mmsi1")) == (
        "boat1",
        None,
        None,
    )


def test_only_what_may_carry_an_entity_is_believed_to():
    run = quiet_run()
    run.turn(1.0, vessel(0))
    said = PhysicalProperty("boat0", "Vessel", point(*WEST), carried_by="mmsi0", time=1.0)
    run.turn(1.0, Heard("camera", said))
    physical = run.state.configuration.structure.physical
    assert physical.placement("boat0") == Placed(point(*WEST))


def test_what_a_stranger_carries_goes_with_it():
    run = quiet_run(TOUR.replace("kind Vessel", "kind Vessel carries Vessel"))
    run.turn(1.0, vessel(0))
    said = PhysicalProperty("boat0", "Vessel", point(*WEST), carried_by="mmsi0", time=1.0)
    run.turn(1.0, Heard("camera", said))
    assert run.state.configuration.structure.physical.carrier("boat0") == "mmsi0"
    run.turn(2.0, Heard("ais", Gone("mmsi0", 2.0, "ais")))
    assert there(run, "mmsi0", "boat0") == [False, False]


def test_nobody_moves_an_entity_by_calling_it_something_else():
    run = quiet_run()
    run.turn(1.0, vessel(0, time=1.0))
    for name, kind in (("boat0", "Location"), ("mmsi0", "Location"), ("gcs0", "Vessel")):
        said = PhysicalProperty(name, kind, box((37.0, -8.62), (37.02, -8.60)), time=2.0)
        run.turn(2.0, Heard("camera", said))
    assert len(run.steps) == 1
    assert run.messages()[1:] == [
        "'camera' reports boat0 as Location, but it is of kind Vessel",
        "'camera' reports mmsi0 as Location, but it is of kind Vessel",
        "'camera' reports gcs0 as Vessel, but it is of kind Station",
    ]


def test_nothing_that_is_seen_is_called_as_the_region_a_bigactor_or_a_kind_is():
    spawns = "BigActor a hosted_at uav0 with_behavior { spawn b hosted_at uav0 with_behavior visit() }"
    run = quiet_run(f"{TOUR}def visit() = {{ skip }}\n{spawns}")
    before = len(run.steps)
    names = ("region", "a", "b", "UAV")
    run.turn(2.0, *(boat(WEST, 2.0, name) for name in names))
    assert run.steps[before:] == []
    assert run.messages("trouble") == [
        f"'ais' reports {name}, which is no entity of the mission" for name in names
    ]
    assert not run.state.sightings.newest.keys() & set(names)


# --- what comes in ----------------------------------------------------------------------------------------


async def test_strangers_are_taken_in_slices_and_what_the_mission_names_at_once():
    inbox, sizes = Inbox(Watchers(), lambda: 0.0, {"uav0"}), []
    for number in range(2 * AT_ONCE + 1):
        inbox.publish("ais", vessel(number).published)
    inbox.publish("autopilot", seen("uav0", WEST, 0.0).published)
    while inbox.awake.is_set():
        batch, _ = inbox.take()
        sizes.append((len(batch.heard), "autopilot" in [each.plugin for each in batch.heard]))
    assert sizes == [(AT_ONCE + 1, True), (AT_ONCE, False), (1, False)]


async def test_no_more_strangers_wait_than_are_bounded_and_that_is_said():
    inbox = Inbox(Watchers(), lambda: 0.0)
    for number in range(MOST_WAITING + 7):
        inbox.publish("ais", vessel(number).published)
    batch, _ = inbox.take()
    assert len(inbox.strangers) + AT_ONCE == MOST_WAITING
    assert [(each.what, each.count) for each in batch.reports] == [("too much at once", 7)]


async def test_thousands_of_detections_in_one_post_keep_nobody_waiting():
    """Others go on while they are read, and while they are taken in: what waits for a turn waits for a slice."""
    count, camera, looker = 5_000, Detections("camera", listen=Listen(0)), Looker()
    at = {"type": "Point", "coordinates": [-8.65, 37.01]}
    features = [
        {"type": "Feature", "properties": {"name": f"d{number}", "kind": "Vessel"}, "geometry": at}
        for number in range(count)
    ]
    plan, turns, beats = plan_of(TOUR + STAY, GOES_ON), [], 0
    looker.turned = lambda turn, _now: turns.append(turn)

    async def post():
        body, url = (
            {"type": "FeatureCollection", "features": features},
            f"http://127.0.0.1:{camera.port}/detections",
        )
        async with aiohttp.ClientSession() as session, session.post(url, json=body) as answer:
            return answer.status

    async with LiveRun(plan, started(plan), [Vehicle(), camera], [looker]) as run:
        await run.begin(2.0)
        full = lambda state: state.sightings.admitted.get("camera") == (SHARE, 0)  # noqa: E731
        going, posting = asyncio.create_task(run.go(full)), asyncio.create_task(post())
        while not posting.done():
            beats += 1
            await asyncio.sleep(0)
        await going
    assert posting.result() == 200
    assert beats > count / 50  # the loop went round while features were read
    steps = [step for turn in turns for step in turn.steps if "appears" in str(step.transition.label)]
    assert 3 <= len(steps) <= 20
