"""Upload and download as pure state machines: what real vehicles do, each fact without a socket."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from adapters.mavlink import upload, verified_upload
from adapters.mavlink.constants import Cmd, MissionResult, MissionType
from adapters.mavlink.items import OnboardItem, fence, route, same
from adapters.mavlink.message import say
from adapters.simulated.store import ARDUPILOT_MANNER, PX4_MANNER, Store
from physical import box, point

PATH = (point(37.0, -8.6), point(37.01, -8.61), point(37.02, -8.62))
GIVE_UP = ARDUPILOT_MANNER.give_up
ITEMS = route(PATH, 100.0, takeoff=True)
FENCE = fence(box((37.05, -8.55), (36.95, -8.65)))
KINDS = [(ITEMS, MissionType.MISSION), (FENCE, MissionType.FENCE)]


def asked(seq, name="MISSION_REQUEST", kind=MissionType.MISSION):
    return say(name, target_system=255, target_component=190, seq=seq, mission_type=int(kind))


def ack(result, kind=MissionType.MISSION):
    return say(
        "MISSION_ACK", target_system=255, target_component=190, type=int(result), mission_type=int(kind)
    )


def begun():
    return upload.tick(upload.Upload(ITEMS, MissionType.MISSION, 1), 0.0)[0]


@pytest.mark.parametrize("name", ["MISSION_REQUEST", "MISSION_REQUEST_INT"])
def test_both_ways_of_asking_get_an_integer_item(name):
    _, (item,) = upload.hear(begun(), asked(2, name), 0.1)
    assert (item.name, item["seq"], item["x"]) == ("MISSION_ITEM_INT", 2, ITEMS[2].x)


def test_only_the_count_is_sent_by_timer():
    state, sent = upload.Upload(ITEMS, MissionType.MISSION, 1), []
    for tenth in range(400):
        state, messages = upload.tick(state, tenth / 10)
        sent += messages
        if tenth == 100:
            state, _ = upload.hear(state, asked(0), 10.0)
    assert {message.name for message in sent} == {"MISSION_COUNT"}
    assert 10 < len(sent) < 20


def test_no_request_is_answered_beyond_the_last_item():
    assert upload.hear(begun(), asked(len(ITEMS)), 0.1)[1] == ()


def test_what_belongs_to_another_kind_of_mission_is_passed_over():
    state = begun()
    assert upload.hear(state, asked(0, kind=MissionType.FENCE), 0.1) == (state, ())
    assert upload.hear(state, ack(MissionResult.ERROR, MissionType.FENCE), 0.1) == (state, ())


def test_invalid_sequence_is_not_final():
    state, _ = upload.hear(begun(), asked(0), 0.1)
    state, _ = upload.hear(state, ack(MissionResult.INVALID_SEQUENCE), 0.2)
    assert not state.over
    assert upload.hear(state, asked(1), 0.3)[1]


@pytest.mark.parametrize("result", [MissionResult.NO_SPACE, MissionResult.CANCELLED])
def test_a_vehicle_that_boots_or_has_given_up_is_asked_again(result):
    state, _ = upload.hear(begun(), ack(result), 0.1)
    assert not state.over
    _, sent = upload.tick(state, 3.0)
    assert [message.name for message in sent] == ["MISSION_COUNT"]


def test_a_final_no_ends_it():
    state, _ = upload.hear(begun(), ack(MissionResult.INVALID), 0.1)
    assert state.over
    assert state.refusal == MissionResult.INVALID


def test_a_denial_is_final_only_once_another_upload_would_have_been_given_up():
    state, sent = begun(), []
    for tenth in range(1, 290):
        state, messages = upload.tick(state, tenth / 10)
        sent += messages
        if messages:
            state, _ = upload.hear(state, ack(MissionResult.DENIED), tenth / 10 + 0.05)
            assert state.over == (tenth / 10 > 3 * GIVE_UP + 2)
    assert {message.name for message in sent} == {"MISSION_COUNT"}
    assert state.refusal == MissionResult.DENIED


def test_an_answer_to_another_station_than_the_one_that_uploads_is_passed_over():
    going, _ = verified_upload.tick(verified_upload.begin(ITEMS, MissionType.MISSION, 1, 254), 0.0)
    for message in (asked(0), ack(MissionResult.INVALID)):  # meant for 255
        assert verified_upload.hear(going, message, 0.1) == (going, ())
    _, (item,) = verified_upload.hear(
        going, replace(asked(0), fields={**asked(0).fields, "target_system": 254}), 0.1
    )
    assert (item.name, item.system) == ("MISSION_ITEM_INT", 254)


@pytest.mark.parametrize("name", ["MISSION_REQUEST_LIST", "MISSION_REQUEST_INT"])
def test_a_vehicle_that_is_given_a_mission_lets_nobody_read_it(name):
    store = Store(request="MISSION_REQUEST", items={MissionType.MISSION: ITEMS})
    count = replace(say("MISSION_COUNT", target_system=1, count=2, mission_type=0), system=255, component=190)
    store.hear(count, ready=True, now=0.0)
    (answer,) = store.hear(replace(say(name, seq=0, mission_type=0), system=254), ready=True, now=0.1)
    assert (answer.name, answer["type"], answer.target) == ("MISSION_ACK", MissionResult.DENIED, 254)


def test_an_acceptance_that_comes_too_early_is_not_believed():
    state, _ = upload.hear(begun(), ack(MissionResult.ACCEPTED), 0.1)
    assert not state.over


def test_home_is_not_compared_and_all_of_a_fence_is():
    other = (replace(ITEMS[0], x=0), *ITEMS[1:])
    assert same(ITEMS, other, MissionType.MISSION)
    assert not same(FENCE, (replace(FENCE[0], x=0), *FENCE[1:]), MissionType.FENCE)
    assert not same(ITEMS, ITEMS[:-1], MissionType.MISSION)
    assert not same(ITEMS, (*ITEMS[:-1], replace(ITEMS[-1], x=ITEMS[-1].x + 1)), MissionType.MISSION)


class Line:
    """A vehicle's store and our sync with a line between them, by a clock of their own."""

    def __init__(self, items, kind, fates, store=None):
        self.sync = verified_upload.begin(items, kind, 1, 255)
        self.store = store or Store(request="MISSION_REQUEST")
        self.fates = iter(fates)
        self.now = 0.0

    def through(self, messages, **who):
        for message in messages:
            for _ in range(next(self.fates, 1)):  # how many copies arrive
                yield replace(message, **who)

    def step(self, seconds=0.1):
        self.now += seconds
        self.sync, ours = verified_upload.tick(self.sync, self.now)
        theirs = self.store.tick(self.now)
        for _ in range(40):
            if not ours and not theirs:
                return
            answers = []
            for message in self.through(ours, system=255, component=190):
                answers += self.store.hear(message, ready=self.now > 3.0, now=self.now)
            ours = []
            for message in self.through([*theirs, *answers], system=1, component=1):
                self.sync, sent = verified_upload.hear(self.sync, message, self.now)
                ours += sent
            theirs = []


@given(st.lists(st.sampled_from([0, 0, 1, 1, 1, 2]), max_size=80), st.sampled_from(KINDS))
def test_whatever_is_lost_or_doubled_it_is_on_board_when_confirmed(fates, which):
    items, kind = which
    line = Line(items, kind, fates)
    while not line.sync.confirmed:
        line.step()
        assert line.now < 200.0
        assert line.sync.refusal is None
    assert same(items, line.store.items[kind], kind)


def test_a_vehicle_that_keeps_something_else_is_found_out():
    class Forgetful(Store):
        def _complete(self, going):
            return super()._complete(
                replace(going, items=(*going.items[:-1], OnboardItem(Cmd.WAYPOINT, 1, 1)))
            )

    line = Line(ITEMS, MissionType.MISSION, (), Forgetful(request="MISSION_REQUEST"))
    while line.sync.refusal is None:
        line.step()
        assert line.now < 100.0
    assert "differs" in line.sync.refusal
    assert not line.sync.confirmed


def test_a_vehicle_gives_up_after_eight_seconds_and_says_so():
    store = Store(request="MISSION_REQUEST")
    count = replace(say("MISSION_COUNT", target_system=1, count=3, mission_type=0), system=255, component=190)
    (request,) = store.hear(count, ready=True, now=0.0)
    said = [message for tenth in range(1, 100) for message in store.tick(tenth / 10)]
    assert request["seq"] == 0
    assert [message.name for message in said] == ["MISSION_REQUEST"] * 7 + ["MISSION_ACK"]
    assert said[-1]["type"] == MissionResult.CANCELLED
    assert GIVE_UP == 8.0
    assert PX4_MANNER.give_up == 5.0


def test_an_upload_for_another_station_is_not_consumed():
    store = Store(request="MISSION_REQUEST")
    count = say("MISSION_COUNT", target_system=1, count=2, mission_type=0)
    store.hear(replace(count, system=255, component=190), ready=True, now=0.0)
    answer = store.hear(replace(count, system=253, component=190), ready=True, now=0.1)
    assert [(message.name, message["type"], message.target) for message in answer] == [
        ("MISSION_ACK", MissionResult.DENIED, 253)
    ]
    assert store.receiving.station == 255
