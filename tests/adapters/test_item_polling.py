"""Reading what is on board as pure functions: when it is read, what ends the belief in it, and what is kept of it."""

import struct
from dataclasses import replace

import pytest
from pymavlink.dialects.v20.ardupilotmega import MAVLink_mission_current_message
from pymavlink.generator.mavcrc import x25crc
from worlds import flown, until

from adapters.addresses import parse_address
from adapters.mavlink import inventory, item_merging, item_polling
from adapters.mavlink.codec import Decoder, Encoder
from adapters.mavlink.constants import Cmd, MavFrame, MissionResult, MissionType
from adapters.mavlink.item_polling import Survey
from adapters.mavlink.items import OnboardItem, fence, item_message, route
from adapters.mavlink.message import say
from adapters.mavlink.pilot import Pilot
from adapters.mavlink.profiles import PLANE, PX4_PLANE
from adapters.mavlink.telemetry import Telemetry, absorb
from adapters.mavlink.vehicle_identities import Craft, Stations
from adapters.mavlink.zones import zones
from adapters.plugin import Trouble
from adapters.simulated.store import Store
from adapters.transport import open_port
from physical import box, point

MISSION, FENCE, RALLY = MissionType
EVERY = {MISSION: 10.0, FENCE: 30.0, RALLY: 60.0}
ROUTE = route((point(37.0, -8.6), point(37.01, -8.61)), 100.0, takeoff=True)
SQUARE = fence(box((37.05, -8.55), (36.95, -8.65)))
NOTHING = dict.fromkeys(MissionType, ())
MARK = OnboardItem(Cmd.DO_LAND_START, 0, 0, 0.0, MavFrame.SEA_LEVEL)
LAND = OnboardItem(Cmd.LAND, 370_000_000, -86_000_000, 0.0)


def surveyed(store, seconds, state=None, certain=(), start=0.0):
    """Let a vehicle with a store answer; return the survey, and which kinds were read, and when."""
    state, read = state or Survey(), []
    certain = dict.fromkeys(certain)
    for tenth in range(round(seconds * 10)):
        now = start + tenth / 10
        state, asked = item_polling.tick(state, EVERY, certain, 1, now)
        while asked:
            answers = [
                each
                for message in asked
                for each in store.hear(replace(message, system=255), ready=True, now=now)
            ]
            asked = ()
            for answer in answers:
                state, more, kind = item_polling.hear(state, answer, now)
                asked += more
                if kind is not None:
                    read.append((kind, now))
                    certain[kind] = None
    return state, read


def test_all_is_read_at_once_and_again_each_in_its_time():
    state, read = surveyed(Store(items={MISSION: ROUTE, FENCE: SQUARE}), 45.0)
    assert [kind for kind, _ in read[:3]] == [MISSION, FENCE, RALLY]
    assert read[2][1] < 1.0
    assert [kind for kind, _ in read].count(FENCE) == 2
    assert [kind for kind, _ in read].count(MISSION) == 5
    assert [kind for kind, _ in read].count(RALLY) == 1
    assert state.settled
    assert len(state.found[FENCE]) == 4


def test_what_somebody_may_have_changed_is_read_first():
    store = Store(items={MISSION: ROUTE, FENCE: SQUARE})
    state, _ = surveyed(store, 5.0)
    doubted = item_polling.doubt(state, [RALLY])
    _, read = surveyed(store, 1.0, doubted, (MISSION, FENCE), 5.0)
    assert [kind for kind, _ in read] == [RALLY]


def test_a_vehicle_that_does_not_answer_is_asked_for_the_next_kind_and_counts_as_asked():
    class Silent:
        def hear(self, *_, **__):
            return []

    state, read = surveyed(Silent(), 20.0)
    assert read == []
    assert not state.settled
    state, _ = surveyed(Silent(), 20.0, state, (), 20.0)
    assert state.settled
    assert state.found == {}


def test_a_vehicle_that_has_no_rally_points_at_all_has_none_on_board():
    class Older(Store):
        def hear(self, message, **more):
            if message["mission_type"] == RALLY:
                return [say("MISSION_ACK", type=int(MissionResult.UNSUPPORTED), mission_type=int(RALLY))]
            return super().hear(message, **more)

    state, _ = surveyed(Older(), 1.0)
    assert state.found == NOTHING


def test_a_reading_begins_anew_where_somebody_writes_meanwhile():
    state, (question,) = item_polling.tick(Survey(), {MISSION: 10.0}, (), 1, 0.0)
    assert question.name == "MISSION_REQUEST_LIST"
    state, _, _ = item_polling.hear(state, say("MISSION_COUNT", count=4, mission_type=0), 0.1)
    state, _, _ = item_polling.hear(state, item_message(ROUTE[0], 0, 0, 255), 0.2)
    assert len(state.reading.items) == 1
    state, _, _ = item_polling.hear(
        state, say("MISSION_ACK", type=int(MissionResult.DENIED), mission_type=0), 0.3
    )
    assert (state.reading.count, state.reading.items) == (None, ())


# --- what ends the belief -----------------------------------------------------------------------------


def believing(profile=PLANE, **known):
    found = {MISSION: ROUTE, FENCE: SQUARE, RALLY: ()}
    state = Pilot(
        Craft("uav0"), Stations(), 1, known=Telemetry(profile=profile, total=3, polygon=True, **known)
    )
    return replace(state, on_board=found, survey=Survey(found=found, read=dict.fromkeys(MissionType, 0.0)))


@pytest.mark.parametrize(
    ("message", "kinds"),
    [
        (say("MISSION_COUNT", target_system=1, count=4, mission_type=0), {MISSION}),
        (say("MISSION_COUNT", target_system=1, count=4, mission_type=1), {FENCE}),
        (say("MISSION_WRITE_PARTIAL_LIST", target_system=1, mission_type=0), {MISSION}),
        (say("MISSION_CLEAR_ALL", target_system=1, mission_type=2), {RALLY}),
        (say("MISSION_CLEAR_ALL", target_system=1, mission_type=255), set(MissionType)),
        (say("FENCE_POINT", target_system=1), {FENCE}),
        (say("MISSION_REQUEST_LIST", target_system=1, mission_type=0), set()),
        (say("MISSION_REQUEST_INT", target_system=1, seq=0, mission_type=0), set()),
        (replace(say("MISSION_REQUEST_INT", target_system=253, mission_type=0), system=1), {MISSION}),
        (replace(say("MISSION_ACK", target_system=253, type=0, mission_type=1), system=1), {FENCE}),
    ],
)
def test_what_another_station_writes_is_no_longer_believed(message, kinds):
    state = inventory.overheard(believing(), replace(message, system=message.system or 253))
    assert {*MissionType} - state.on_board.keys() == kinds
    assert state.known.polygon


def current(seq, **more):
    return replace(say("MISSION_CURRENT", seq=seq, **more), system=1, component=1)


def after(state, *messages):
    for message in messages:
        state = inventory.with_known(state, absorb(state.known, message, 1.0))
    return state


def test_another_total_is_not_ours_and_the_one_of_ours_is():
    state = believing()
    assert after(state, current(2, total=3)).on_board == state.on_board
    assert MISSION not in after(state, current(2, total=4)).on_board
    theirs = after(state, current(2, total=4))
    ours = replace(theirs, on_board=state.on_board)  # read again
    assert after(ours, current(2, total=3)).on_board == state.on_board


def test_a_number_that_px4_gives_to_what_is_on_board_shows_each_change_of_it():
    numbers = {"mission_id": 5, "fence_id": 6, "rally_points_id": 7}
    state = after(believing(PX4_PLANE), current(2, total=4, **numbers))
    state = replace(state, on_board=believing().on_board)
    assert after(state, current(3, total=4, **numbers)).on_board == state.on_board
    changed = after(state, current(3, total=4, **numbers | {"fence_id": 8}))
    assert {*MissionType} - changed.on_board.keys() == {FENCE}


def frame_of_mission_current(payload):
    """A frame of MAVLink 2 with any payload, as PX4's dialect has more fields of it than that of the codec."""
    header = bytes([len(payload), 0, 0, 7, 1, 1, 42, 0, 0])
    check = x25crc(header + payload)
    check.accumulate(bytes([MAVLink_mission_current_message.crc_extra]))
    return b"\xfd" + header + payload + struct.pack("<H", check.crc)


@pytest.mark.parametrize("numbers", [(5, 6, 7), (5, 0, 0), (0, 0, 0)])
def test_the_numbers_are_read_although_the_codec_has_no_names_for_them(numbers):
    payload = struct.pack("<HHBBIII", 3, 9, 2, 1, *numbers).rstrip(b"\0")
    (message,) = Decoder().feed(frame_of_mission_current(payload))
    assert (message["seq"], message["total"]) == (3, 9)
    assert tuple(message[name] for name in ("mission_id", "fence_id", "rally_points_id")) == numbers
    assert absorb(Telemetry(), message, 0.0).numbers == (numbers if any(numbers) else None)


@flown()
async def test_a_station_that_only_writes_is_heard_as_a_second_one(f):
    await until(f.plugin.is_known, 60)
    assert MISSION in f.plugin.pilot("uav0").on_board
    count = say("MISSION_COUNT", target_system=1, target_component=1, count=4, mission_type=0)
    before = f.plugin.pilot("uav0").survey.read[MISSION]
    address = parse_address(f"udpout:127.0.0.1:{f.plugin.local[1]}")
    async with open_port(address, lambda *_: None) as port:
        port.send(Encoder(252, 190).pack(count), None)
        await until(lambda: f.plugin.pilot("uav0").survey.read[MISSION] > before, 5)
    (trouble,) = await until(lambda: f.world.of(Trouble, what="second ground station"))
    assert trouble.detail == "system 252 sends MISSION_COUNT"


# --- what is kept -------------------------------------------------------------------------------------


def told(profile=PLANE, **parameters):
    return Telemetry(profile=profile, parameters=parameters)


def round_zone(command, radius):
    return OnboardItem(command, 370_200_000, -86_000_000, 0.0, MavFrame.SEA_LEVEL, (radius, 0.0, 0.0, 0.0))


OUT = round_zone(Cmd.FENCE_CIRCLE_EXCLUSION, 300.0)
IN = round_zone(Cmd.FENCE_CIRCLE_INCLUSION, 9_000.0)


def test_a_fence_is_its_zones_whatever_their_order():
    first, second, third = zones((*SQUARE, OUT, IN))
    assert (first.within, second.outside, third.within) == (True, True, True)
    assert str(first) == "a polygon of 4 corners to stay in"
    assert str(second) == "a circle of 300 m around 37.02000, -8.60000 to stay out of"
    assert item_merging.is_on_board((*SQUARE, OUT), (OUT, *SQUARE), FENCE)
    assert not item_merging.is_on_board(
        (*SQUARE, OUT), (*SQUARE, replace(OUT, parameters=(200.0, 0, 0, 0))), FENCE
    )
    assert not item_merging.is_on_board((*SQUARE, OUT), SQUARE, FENCE)


@pytest.mark.parametrize("items", [(SQUARE[0],), SQUARE[:2], (round_zone(Cmd.FENCE_CIRCLE_EXCLUSION, -1.0),)])
def test_items_that_make_no_zone_are_kept_as_they_are(items):
    assert [zone.shape for zone in zones(items)] == [None]
    assert item_merging.merged(SQUARE, items, FENCE, told()) == (*SQUARE, *items)


@pytest.mark.parametrize("found", [(), SQUARE, (OUT, *SQUARE), (OUT, IN), (*SQUARE, OUT, IN)])
@pytest.mark.parametrize("known", [told(), told(PX4_PLANE), told(FENCE_OPTIONS=2.0)])
def test_what_was_merged_once_is_not_changed_by_merging_it_again(found, known):
    wanted = item_merging.merged(SQUARE, found, FENCE, known)
    assert item_merging.is_on_board(item_merging.merged(SQUARE, wanted, FENCE, known), wanted, FENCE)
    assert (OUT in wanted) == (OUT in found)
    assert (IN in wanted) == (IN in found and not item_merging.widens(known))


def test_a_landing_sequence_follows_every_mission_and_only_one_that_is_used():
    found = (*ROUTE, MARK, LAND)
    longer = (*ROUTE, ROUTE[-1])
    assert item_merging.merged(longer, found, MISSION, told(RTL_AUTOLAND=2.0)) == (*longer, MARK, LAND)
    assert item_merging.merged(longer, found, MISSION, told(RTL_AUTOLAND=0.0)) == longer
    again = item_merging.merged(longer, (*longer, MARK, LAND), MISSION, told())
    assert item_merging.is_on_board(again, (*longer, MARK, LAND), MISSION)
    assert item_merging.merged(ROUTE, (*longer, LAND), MISSION, told()) == ROUTE
    assert item_merging.merged(ROUTE, (*longer, LAND), MISSION, told(PX4_PLANE)) == (*ROUTE, LAND)
