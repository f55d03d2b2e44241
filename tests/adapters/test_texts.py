"""What a vehicle says for people: its texts, and its status, from a true autopilot's messages and over sockets."""

import asyncio
from dataclasses import replace
from itertools import pairwise

import pytest
from worlds import DATA, flight, flown, until

from adapters.mavlink import Craft, Stations
from adapters.mavlink import pilot as piloting
from adapters.mavlink.message import say
from adapters.mavlink.pilot import Pilot
from adapters.mavlink.telemetry import Telemetry, absorb
from adapters.mavlink.texts import CHUNK, PATIENCE, VehicleText, give_up, join
from adapters.mavlink.tlog import read_tlog
from adapters.plugin import Battery, GoTo, Hold, Status, StatusText, Trouble
from adapters.simulated import Kind, run
from physical import box

PLANE = DATA / "mavlink" / "plane_portimao.tlog"
EAST = box((37.02, -8.585), (37.005, -8.6))
LONG = "PreArm: " + "x" * 60


def chunk(text, number=0, index=0, severity=6):
    return {"text": text, "id": number, "chunk_seq": index, "severity": severity}


def joined(*said, now=0.0):
    chunks, texts = None, []
    for each in said:
        chunks, found = join(chunks, each, now)
        texts += found
    return chunks, [each.text for each in texts]


def test_a_text_without_a_number_is_whole():
    assert joined(chunk("a" * CHUNK), chunk("b")) == (None, ["a" * CHUNK, "b"])


@pytest.mark.parametrize("length", [51, 99, 100, 101, 150])
def test_chunks_are_joined_whatever_the_length(length):
    text = "".join(chr(97 + n % 26) for n in range(length))
    parts = [text[at : at + CHUNK] for at in range(0, length + 1, CHUNK)]
    assert joined(*(chunk(part, 7, index) for index, part in enumerate(parts))) == (None, [text])


def test_a_chunk_that_comes_twice_counts_once_and_one_that_is_lost_is_marked():
    a, b, c = (
        chunk(sign * size, 7, index) for index, (sign, size) in enumerate((("a", 50), ("b", 50), ("c", 5)))
    )
    assert joined(a, a, b, a, c)[1] == ["a" * 50 + "b" * 50 + "c" * 5]
    assert joined(a, c)[1] == ["a" * 50 + "..." + "c" * 5]
    assert joined(b, c)[1] == ["..." + "b" * 50 + "c" * 5]


def test_another_text_ends_one_whose_rest_did_not_come():
    begun = chunk("a" * 50, 7)
    assert joined(begun, chunk("b" * 50, 8), chunk("c", 8, 1))[1] == ["a" * 50 + "...", "b" * 50 + "c"]
    chunks, _ = joined(begun)
    assert give_up(chunks, PATIENCE) == (chunks, ())
    assert give_up(chunks, PATIENCE + 0.1) == (None, (VehicleText("a" * 50 + "...", 6),))


def test_a_text_holds_no_more_chunks_than_their_numbers_tell_apart():
    chunks, texts = joined(*(chunk("a" * 50, 7, n % 256) for n in range(10_000)))
    assert (len(chunks.parts), texts) == (256, [])


def test_what_cannot_be_printed_is_left_out_of_a_text_and_an_unknown_severity_is_the_least():
    assert joined(chunk("a\x1b[2J\x00b"))[1] == ["a[2Jb"]
    assert joined(chunk("\x00"))[1] == []
    assert join(None, chunk("a", severity=200), 0.0)[1] == (VehicleText("a", 7),)


def heard(name, **fields):
    return replace(say(name, **fields), system=1, component=1)


def status(volts, percent, **more):
    sensors = dict.fromkeys(("onboard_control_sensors_health", "onboard_control_sensors_enabled"), 0)
    return heard("SYS_STATUS", voltage_battery=volts, battery_remaining=percent, **sensors, **more)


def cells(volts, percent, number=0):
    voltages = [*volts, *[65_535] * (10 - len(volts))]
    return heard("BATTERY_STATUS", id=number, voltages=voltages, battery_remaining=percent)


def test_the_battery_is_what_either_message_knows_of_it():
    known = absorb(Telemetry(), status(12_600, 99), 0.0)
    assert known.battery == Battery(99, 12.6)
    assert absorb(known, status(65_535, -1), 1.0).battery == Battery(99, 12.6)
    assert absorb(Telemetry(), status(0, -1), 0.0).battery is None
    assert absorb(Telemetry(), cells((3_900, 3_900, 3_900), 55), 0.0).battery == Battery(55, 11.7)
    assert absorb(known, cells((3_000,), 5, number=1), 1.0).battery == Battery(99, 12.6)


@pytest.mark.skipif(not PLANE.exists(), reason=f"no recordings in {DATA}; set BIGACTORS_DATA")
def test_of_a_true_flight_all_texts_and_a_status_a_second_are_reported():
    pilot, seen = Pilot(Craft("uav0", system=1), Stations(), 1), []
    for time, message in read_tlog(PLANE):
        if message.system == 1:
            outcome = piloting.hear(pilot, message, time)
            pilot, seen = outcome.pilot, [*seen, *outcome.seen]
    texts = [each.text for each in seen if isinstance(each, StatusText)]
    assert (len(texts), texts[0], texts[-1]) == (36, "Airspeed 1 calibrated", "Mission: 4 LoitUnlim")
    states = [each for each in seen if isinstance(each, Status)]
    assert all(after.time - before.time >= 1.0 for before, after in pairwise(states))
    assert len(states) == 15
    last = states[-1]
    assert (last.mode, last.armed, last.authority) == ("AUTO", True, ())  # it was not asked whom it obeys
    assert 12.2 <= last.battery.volts <= 12.6
    assert 80 <= last.battery.percent <= 99
    assert 0 <= last.heading < 360


def test_a_vehicle_that_flies_tells_its_modes_its_battery_and_what_it_does():
    async def main():
        async with flight() as f:
            await f.plugin.command(GoTo("r1", "uav0", EAST))
            await f.ended("r1")
            await f.plugin.command(Hold("r2", "uav0"))
            await f.ended("r2")
            await asyncio.sleep(100)
            return f.world.of(StatusText), f.world.of(Status)

    texts, states = run(main())
    assert [each.text for each in texts] == ["Throttle armed", "Mission: 1 Takeoff", "Mission: 2 LoitUnlim"]
    modes = list(dict.fromkeys(each.mode for each in states))
    assert [mode for mode in modes if mode] == ["MANUAL", "AUTO", "GUIDED", "LOITER"]
    assert all(after.time - before.time >= 1.0 for before, after in pairwise(states))
    assert states[-1].authority == ("gcs0",)
    assert {each.plugin for each in states} == {"autopilot"}
    first, last = states[3].battery, states[-1].battery
    assert last.percent < first.percent == 100
    assert last.volts == 12.6


@flown(Kind.COPTER)
async def test_a_long_text_comes_whole_over_a_link_and_a_flood_of_texts_is_rationed(f):
    await until(lambda: f.world.of(Status))
    f.vehicle.words.append((4, LONG))
    await until(lambda: f.world.of(StatusText))
    assert f.world.of(StatusText)[-1].text == LONG
    f.world.reports.clear()
    for number in range(500):
        f.vehicle.words.append((6, f"text {number}"))
    await asyncio.sleep(5)
    texts = [each for each in f.world.of(StatusText) if each.text.startswith("text")]
    (trouble,) = f.world.of(Trouble, what="texts of uav0 left out")
    assert trouble.detail == f"{500 - len(texts)} texts, over 10 in a second"
    assert 9 <= len(texts) <= 20
