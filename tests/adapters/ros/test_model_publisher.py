"""What P and L hold, published over a real Zenoh router and read by `rosbags`."""

import asyncio
import json
import math
import struct

import pytest
import xxhash
import zenoh.ext
from hypothesis import given
from hypothesis import strategies as st
from routers import STORE, for_real, router, session, tokens

from adapters.live.fresh_placements import Sighting, Sightings
from adapters.live.live_state import LiveState
from adapters.live.turn_result import Turn
from adapters.ros import RosSending
from adapters.ros.position_messages import FIX, STRING, WHERE, hash_of, write_fix, write_string, write_where
from adapters.ros.wire import Topic, key_of
from bigactors.mission_lookup import open_mission
from physical import PhysicalError, PhysicalProperty, box, point
from semantics.state.setting import Control, Scheduler
from specs.elaboration import Variation

DEGREES = st.floats(-90, 90)
TIMES = st.integers(0, 2**31 - 1)
SPACE = key_of(7, Topic("/bigactors/logical_space", STRING, hash_of(STRING)))


@given(latitude=DEGREES, longitude=DEGREES, time=TIMES, frame=st.text(st.characters(exclude_characters="\0")))
def test_what_is_written_is_what_rosbags_reads_and_writes(latitude, longitude, time, frame):
    fix = STORE.deserialize_cdr(raw := write_fix(latitude, longitude, time + 0.5, frame), FIX)
    assert (fix.latitude, fix.longitude, fix.header.frame_id) == (latitude, longitude, frame)
    assert (fix.header.stamp.sec, fix.header.stamp.nanosec) == (time, 500_000_000)
    assert (math.isnan(fix.altitude), fix.status.status) == (True, 0)
    assert bytes(STORE.serialize_cdr(fix, FIX)) == raw
    where = STORE.deserialize_cdr(raw := write_where(latitude, longitude, time, frame), WHERE)
    assert (where.position.latitude, where.position.longitude) == (latitude, longitude)
    assert bytes(STORE.serialize_cdr(where, WHERE)) == raw
    assert STORE.deserialize_cdr(write_string(frame), STRING).data == frame


def test_nothing_is_published_into_a_file():
    with pytest.raises(PhysicalError, match="nothing is published there"):
        RosSending("file:bag")


def seen(entity, geometry):
    return Sighting(PhysicalProperty(entity, "UAV", geometry, time=5.0), 5.0, 65.0)


def state_of(configuration):
    far = {
        "uav0": seen("uav0", point(37.01, -8.65)),
        "spill0": seen("spill0", box((37.2, -8.8), (37.0, -8.6))),
    }
    return LiveState(configuration, sightings=Sightings(far))


async def test_a_ros_node_hears_where_things_are_and_one_that_comes_late_hears_the_logical_space():
    first = open_mission("oil_spill", Variation(Scheduler.FCFS, Control.TIMED)).initial
    logical = first.structure.logical
    heard, late = [], []
    with router() as (port, node):
        node.declare_subscriber("7/**", heard.append)
        sending = RosSending(f"tcp:127.0.0.1:{port}?domain=7")
        try:
            for _ in range(3):  # the newest is sent, not each
                sending.turned(Turn(state_of(first)), 0.0)
            await for_real(lambda: len(heard) == 3)
            await for_real(lambda: len(tokens(node, 7)) == 4)
            listed = {each.split("/")[4]: each for each in tokens(node, 7)}
            with session("client", connect=f"tcp/127.0.0.1:{port}") as other:
                history = zenoh.ext.HistoryConfig(detect_late_publishers=True)
                zenoh.ext.declare_advanced_subscriber(other, SPACE, late.append, history=history)
                await for_real(lambda: late)
        finally:
            await asyncio.to_thread(sending.close)
    said = {str(each.key_expr): each for each in heard}
    assert len(said) == 3
    fix = said[key_of(7, Topic("/bigactors/uav0/fix", FIX, hash_of(FIX)))]
    assert STORE.deserialize_cdr(fix.payload.to_bytes(), FIX).longitude == -8.65
    where = said[key_of(7, Topic("/bigactors/spill0/position", WHERE, hash_of(WHERE)))]
    position = STORE.deserialize_cdr(where.payload.to_bytes(), WHERE).position
    assert (position.latitude, position.longitude) == pytest.approx((37.1, -8.7), abs=1e-3)
    nodes = json.loads(STORE.deserialize_cdr(late[0].payload.to_bytes(), STRING).data)["nodes"]
    assert late[0].payload.to_bytes() == said[SPACE].payload.to_bytes()
    assert {name: each["parent"] for name, each in nodes.items()} == {
        name: logical.parent(name) for name in logical.nodes()
    }
    number, _, length, gid = struct.unpack("<qqB16s", fix.attachment.to_bytes())
    token = next(each for each in listed.values() if "%uav0%fix" in each)
    hashed = xxhash.xxh3_128(token.encode()).digest()
    assert (number, length, gid) == (1, 16, hashed[:7:-1] + hashed[7::-1])
    assert token.endswith("/1:2:1,1:,:,:,,")
    assert next(each for each in listed.values() if "logical_space" in each).endswith("/1:1:1,1:,:,:,,")
