"""MAVLink 2 signing: forged, unsigned and replayed packets are neither obeyed by a vehicle nor believed of one."""

import asyncio
import shutil
import socket

import pytest
from packets import position
from pymavlink.dialects.v20 import ardupilotmega
from worlds import AREA, EPOCH, flight, simulated, until

from adapters.mavlink import signing
from adapters.mavlink.codec import Decoder, Encoder
from adapters.mavlink.command import long
from adapters.mavlink.constants import Cmd
from adapters.mavlink.keys import Keeper
from adapters.mavlink.signing import Signing, Verdict, check, load, new_key, save, setup_signing, stamp
from adapters.plugin import Arrived, GoTo
from adapters.simulated import Kind, Vehicle, protocol, run
from adapters.simulated.reporting import Reporter
from physical import PhysicalError

KEY, WRONG = new_key("oil spill"), new_key("something else")
NOW = EPOCH
MANUAL_TO_RTL = long(Cmd.DO_SET_MODE, 1, 1, 11)


def frame(key, time, system=255):
    return Encoder(system, 190, key).pack(MANUAL_TO_RTL, protocol.timestamp(time))


def heard(raw):
    (message,) = Decoder().feed(raw)
    return message


def judged(state, raw):
    return check(state, heard(raw))


GOOD, REPLAYED, UNSIGNED, FORGED = Verdict.GOOD, Verdict.REPLAYED, Verdict.UNSIGNED, Verdict.FORGED


@pytest.mark.parametrize(
    ("packets", "verdicts"),
    [
        ([(KEY, 1), (KEY, 1)], [GOOD, REPLAYED]),
        ([(None, 0), (WRONG, 0)], [UNSIGNED, FORGED]),
        ([(KEY, 1), (WRONG, 1e6), (KEY, 2)], [GOOD, FORGED, GOOD]),  # it does not silence the true sender
        ([(KEY, -59)], [GOOD]),  # a new stream may be a minute behind
        ([(KEY, -61)], [REPLAYED]),
    ],
)
def test_a_signed_packet_is_good_once_unless_it_is_late(packets, verdicts):
    state, found = stamp(Signing(KEY), NOW), []
    for key, after in packets:
        state, verdict = judged(state, frame(key, NOW + after))
        found.append(verdict)
    assert found == verdicts


def test_every_single_bit_that_changes_makes_a_packet_forged_or_garbage():
    state, raw = stamp(Signing(KEY), NOW), frame(KEY, NOW + 1)
    for bit in range(len(raw) * 8):
        changed = bytearray(raw)
        changed[bit // 8] ^= 1 << bit % 8
        for message in Decoder().feed(bytes(changed)):
            assert not hasattr(message, "name") or check(state, message)[1] is not Verdict.GOOD


def test_time_stamps_grow_even_when_the_clock_stands_or_goes_back():
    state = stamp(Signing(KEY), NOW)
    assert stamp(state, NOW).timestamp == state.timestamp + 1
    assert stamp(state, NOW - 100).timestamp == state.timestamp + 1


def test_the_state_on_disk_refuses_replays_of_the_run_before(tmp_path):
    path = tmp_path / "key.json"
    state, raw = stamp(Signing(KEY), NOW), frame(KEY, NOW + 1)
    state, _ = judged(state, raw)
    save(state, path)
    again = load(path)
    assert judged(again, raw)[1] is Verdict.REPLAYED
    assert stamp(again, NOW).timestamp > state.timestamp
    assert path.stat().st_mode & 0o077 == 0


@pytest.mark.parametrize(
    "text", ["", "{}", '{"key": "00", "timestamp": 0, "streams": {}}', "[1]", '{"key": 5}']
)
def test_a_key_file_that_is_none_is_the_users_mistake(tmp_path, text):
    path = tmp_path / "key.json"
    path.write_text(text)
    path.chmod(0o600)
    with pytest.raises(PhysicalError, match="key"):
        load(path)


def test_pymavlink_accepts_what_we_sign_and_refuses_what_others_do():
    reader = ardupilotmega.MAVLink(None)
    reader.signing.secret_key, reader.signing.timestamp = KEY, protocol.timestamp(NOW)
    reader.robust_parsing = True
    (good,) = reader.parse_buffer(frame(KEY, NOW + 1))
    (bad,) = reader.parse_buffer(frame(WRONG, NOW + 2))
    assert (good.get_type(), good.get_signed(), bad.get_type()) == ("COMMAND_LONG", True, "BAD_DATA")


def test_after_setup_signing_only_signed_commands_are_obeyed():
    vehicle, reporter = Vehicle(Kind.PLANE, (37.0, -8.6, 20.0)), Reporter()
    for raw, time in ((frame(None, NOW), NOW), (Encoder(255, 190).pack(setup_signing(KEY, NOW, 1)), NOW)):
        protocol.hear(vehicle, reporter, heard(raw), time)
    assert vehicle.mode == 11
    vehicle.mode = 0
    good = frame(KEY, NOW + 1)
    for raw in (frame(None, NOW + 1), frame(WRONG, NOW + 1)):
        assert protocol.hear(vehicle, reporter, heard(raw), NOW + 1) == []
    assert vehicle.mode == 0
    assert protocol.hear(vehicle, reporter, heard(good), NOW + 1)
    assert vehicle.mode == 11
    vehicle.mode = 0
    assert protocol.hear(vehicle, reporter, heard(good), NOW + 2) == []  # replayed
    assert vehicle.mode == 0


def test_the_first_link_of_a_vehicle_obeys_unsigned_packets_too():
    vehicle = Vehicle(Kind.PLANE, (37.0, -8.6, 20.0), signing=Signing(KEY), accept_unsigned=True)
    protocol.hear(vehicle, Reporter(), heard(frame(None, NOW)), NOW)
    assert vehicle.mode == 11


def test_a_signed_flight_arrives_among_forged_unsigned_and_replayed_packets(tmp_path):
    path = tmp_path / "key.json"
    save(Signing(KEY), path)

    async def main():
        async with flight(key_file=path, signing=Signing(KEY)) as f:
            await f.plugin.command(GoTo("r1", "uav0", AREA))
            await until(lambda: f.world.property("uav0"))
            lie = position((50.0, 8e-6), 10_000_000)
            stamped = protocol.timestamp(f.world.now() + 100)
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
                for key in (None, WRONG):
                    link.sendto(Encoder(1, 1, key).pack(lie, stamped), f.plugin.local)
            assert isinstance(await f.ended("r1"), Arrived)
            assert {"unsigned packet", "forged signature"} <= f.world.troubles()
            assert all(published.property.geometry.vertices[0][0] < 38 for published in f.world.published)

    run(main())
    assert load(path).timestamp > 0


@simulated
async def test_a_vehicle_that_does_not_sign_is_not_believed(tmp_path):
    path = tmp_path / "key.json"
    save(Signing(KEY), path)
    async with flight(key_file=path) as f:
        await asyncio.sleep(30)
        assert f.world.published == []
        assert "unsigned packet" in f.world.troubles()


def test_after_a_kill_no_packet_that_was_believed_is_believed_again_and_no_time_stamp_sent(tmp_path):
    path = tmp_path / "key.json"
    save(Signing(KEY), path)
    keeper, believed, sent = Keeper(path), [], 0
    for second in range(0, 60, 3):
        believed.append(frame(KEY, NOW + second + 0.5, system=1))
        if second > 40:  # a stream that is heard for the first time shortly before the end
            believed.append(frame(KEY, NOW + second + 0.7, system=2))
        sent = keeper.stamp(NOW + second)
    assert {keeper.judge(heard(raw)) for raw in believed} == {Verdict.GOOD}
    again = Keeper(path)  # what stood on disk at any moment
    assert {again.judge(heard(raw)) for raw in believed} == {Verdict.REPLAYED}
    assert again.stamp(NOW) > sent
    assert (
        again.judge(heard(frame(KEY, NOW + 60 + 10, system=1))) is Verdict.GOOD
    )  # it has waited for the reserve


def test_the_file_is_written_each_ten_seconds_not_with_each_packet(tmp_path, monkeypatch):
    path = tmp_path / "key.json"
    save(Signing(KEY), path)
    keeper, written = Keeper(path), []
    monkeypatch.setattr(signing, "save", lambda state, _path: written.append(state))
    for tenth in range(1, 301):
        keeper.judge(heard(frame(KEY, NOW + tenth / 10, system=1)))
    assert len(written) == 3


@simulated
async def test_a_state_that_cannot_be_written_is_said_and_nobody_is_kept_from_flying(tmp_path):
    folder = tmp_path / "keys"
    folder.mkdir()
    save(Signing(KEY), folder / "key.json")
    async with flight(key_file=folder / "key.json", signing=Signing(KEY)) as f:
        shutil.rmtree(folder)
        await until(lambda: f.world.property("uav0"))
        await until(lambda: "signing state not written" in f.world.troubles())


def test_a_key_that_others_may_read_is_refused_with_what_to_do(tmp_path):
    path = tmp_path / "key"
    save(Signing(KEY), path)
    path.chmod(0o644)
    with pytest.raises(PhysicalError, match="others may read the signing key: its mode is 0644") as refused:
        load(path)
    assert refused.value.hint.startswith(f"chmod 600 {path}; if others did, make one: ")
