"""Telemetry logs: damaged stretches, what shows no position, and an account that adds up."""

import io
import os
from collections import Counter
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

pytest.importorskip("pymavlink")

import packets
from packets import beat, fixed

from adapters.mavlink.codec import Encoder
from adapters.mavlink.message import MavlinkMessage
from adapters.mavlink.tlog import Damage, Unread, entries, entry, messages_in, positions_of, read_tlog
from adapters.mavlink.vehicle_identities import Craft
from physical import PhysicalError
from physical.file_account import Counting

DATA = (
    Path(os.environ.get("BIGACTORS_DATA", Path(__file__).parents[2].parent / "shared" / "data")) / "mavlink"
)
START = 1_772_596_000.0

FIX, BEAT = fixed((47.4, 8.54)), beat(status=4)


def position(number, latitude=47.4, longitude=8.54):
    return packets.position((latitude, longitude), 1000 * number, 500_000, 1000)


def log(*messages, system=1, component=1, start=START):
    encoder = Encoder(system, component)
    return [entry(start + number, encoder.pack(message)) for number, message in enumerate(messages)]


def flight(seconds, **sender):
    return log(
        *(message for number in range(1, seconds + 1) for message in (BEAT, FIX, position(number))), **sender
    )


def read(data, names=(1,)):
    """Read a log: the times of positions, and the account."""
    counting = Counting()
    crafts = {system: Craft(f"uav{system}", "UAV", system) for system in names}
    times = [time for time, _ in positions_of(messages_in(io.BytesIO(data), counting), crafts, counting)]
    return times, counting.tally(counting.total, "thing")


@pytest.mark.parametrize("zeros", [1, 7, 8, 9, 100, 4096, 70_000])
@pytest.mark.parametrize("filler", [b"\0", b"\xff", b"\xfe", b"\xfd", b"\0\0\0\0\0\0\0\0\xfe"])
@pytest.mark.parametrize("after", [0, 20, 60])
def test_a_damaged_stretch_is_skipped_and_counted_wherever_it_is(zeros, filler, after):
    entries_of = flight(20)
    damage = (filler * zeros)[:zeros]
    times, tally = read(b"".join(entries_of[:after]) + damage + b"".join(entries_of[after:]))
    assert len(times) == 20
    assert dict(tally.left_out)["damaged stretch"] == 1
    assert tally.asides == (("byte in damaged stretches", zeros),)


def test_a_log_that_begins_or_ends_amid_an_entry_is_read():
    whole = b"".join(flight(20))
    times, tally = read(whole[5:-5])
    assert (len(times), dict(tally.left_out)["damaged stretch"]) == (19, 2)


def test_a_message_with_a_wrong_checksum_is_counted_and_the_next_is_read():
    parts = flight(3)
    parts[4] = parts[4][:-1] + bytes([parts[4][-1] ^ 1])
    times, tally = read(b"".join(parts))
    assert (len(times), dict(tally.left_out)["message with a wrong checksum"]) == (3, 1)


def test_a_message_of_another_dialect_is_counted_and_the_next_is_read():
    parts = flight(3)
    unknown = bytes([0xFD, 3, 0, 0, 0, 1, 1, 0x77, 0x77, 0x77, 1, 2, 3, 0, 0])
    times, tally = read(b"".join([*parts[:4], entry(START, unknown), *parts[4:]]))
    assert (len(times), dict(tally.left_out)["message that the dialect does not have"]) == (3, 1)


def test_a_damaged_time_is_replaced_by_the_one_before():
    parts = flight(4)
    parts[5] = bytes(8) + parts[5][8:]
    times, tally = read(b"".join(parts))
    assert times == [START + 2, START + 4, START + 8, START + 11]
    assert [count for kind, count in tally.asides if "time" in kind] == [1]


def test_a_clock_that_is_set_once_is_followed():
    unset = [round(1e6 * number).to_bytes(8, "big") + part[8:] for number, part in enumerate(flight(2))]
    times, tally = read(b"".join([*unset, *flight(4)[6:]]))
    assert times == [2.0, 5.0, START + 8, START + 11]
    assert [count for kind, count in tally.asides if "time" in kind] == [1]


def test_what_is_no_log_is_refused(tmp_path):
    for name, content in (("text", b"Dear reader,\n" * 50), ("zeros", bytes(5000)), ("short", b"\0")):
        path = tmp_path / f"{name}.tlog"
        path.write_bytes(content)
        with pytest.raises(PhysicalError, match="no MAVLink frame"):
            list(read_tlog(path))


@pytest.mark.parametrize(
    ("data", "kind"),
    [
        (log(BEAT, FIX), "GPS_RAW_INT: the positions that count are those of GLOBAL_POSITION_INT"),
        (flight(1, component=0), "GLOBAL_POSITION_INT of component 0 of system 1, which is no autopilot"),
        (flight(1, component=190), "GLOBAL_POSITION_INT of component 190 of system 1, which is no autopilot"),
        (flight(1, system=7), "GLOBAL_POSITION_INT of system 7, which is not named here"),
        (log(BEAT, position(1)), "GLOBAL_POSITION_INT without a GPS fix"),
        (
            log(FIX, position(1, 0, 0)),
            "GLOBAL_POSITION_INT that came late, or lies at latitude 0 and longitude 0",
        ),
    ],
)
def test_what_shows_no_position_says_why(data, kind):
    times, tally = read(b"".join(data))
    assert times == []
    assert dict(tally.left_out)[kind] == 1
    assert tally.adds_up


chunks = st.one_of(
    st.sampled_from([b"".join(flight(1)), *flight(1), *flight(1, component=0), *flight(1, system=9)]),
    st.binary(max_size=30),
    st.sampled_from([bytes(40), b"\xfe" * 40, b"\0\0\0\0\0\0\0\0\xfd\xff"]),
)


@settings(deadline=None)
@given(st.lists(chunks, max_size=12).map(b"".join))
def test_every_byte_is_in_an_entry_or_in_a_damaged_stretch_and_the_account_adds_up(data):
    found = list(entries(io.BytesIO(data)))
    lost = sum(each.size for _, each in found if isinstance(each, Damage))
    whole = sum(8 + len(each.raw) for _, each in found if isinstance(each, MavlinkMessage))
    assert lost + whole <= len(data)
    if not any(isinstance(each, Unread) for _, each in found):
        assert lost + whole == len(data)
    try:
        times, tally = read(data)
    except PhysicalError:
        assert not any(isinstance(each, MavlinkMessage) for _, each in found)
        return
    assert (tally.total, tally.adds_up) == (len(found), True)
    assert dict(tally.taken).get("position", 0) == len(times)


@pytest.mark.skipif(not DATA.exists(), reason=f"no recordings in {DATA}; set BIGACTORS_DATA")
@pytest.mark.parametrize(
    ("name", "messages", "bad"), [("copter_flight_2015", 75_477, 1_314), ("plane_portimao", 5_239, 0)]
)
def test_a_real_log_has_as_many_messages_as_pymavlink_finds(name, messages, bad):
    with (DATA / f"{name}.tlog").open("rb") as file:
        found = Counter(type(each) for _, each in entries(file))
    assert (found[MavlinkMessage], found[Unread]) == (messages, bad)
