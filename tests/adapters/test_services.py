"""The smaller state machines: the codec, commands, links, streams and what telemetry shows, without a socket."""

import subprocess
import sys

import pytest
from pymavlink.dialects.v20 import ardupilotmega

from adapters.mavlink import command, link_loss, streams
from adapters.mavlink.codec import CodecError, Decoder, Encoder, Garbage
from adapters.mavlink.command import RepeatedMessage, long, reposition
from adapters.mavlink.constants import REGULAR, STREAMS, Cmd, MavFrame, Result
from adapters.mavlink.message import MavlinkMessage, is_for, say
from adapters.mavlink.telemetry import Telemetry, absorb
from adapters.plugin import LinkLost, LinkRestored

BEAT = {"base_mode": 81, "custom_mode": 0, "system_status": 3, "mavlink_version": 3}
HEARTBEAT = MavlinkMessage("HEARTBEAT", {"type": 1, "autopilot": 3, **BEAT}, 1, 1)


def ack(result, number=Cmd.ARM_DISARM):
    return say(
        "COMMAND_ACK", command=int(number), result=int(result), target_system=255, target_component=190
    )


# --- codec ------------------------------------------------------------------------------------------


def test_what_is_packed_is_read_again_by_us_and_by_pymavlinks_own_parser():
    message = reposition(1, 370_000_000, -86_000_000, (100.0, MavFrame.HOME), 80.0, enters=True)
    raw = Encoder(255, 190).pack(message)
    (ours,) = Decoder().feed(raw)
    (theirs,) = ardupilotmega.MAVLink(None).parse_buffer(raw)
    assert (ours.system, ours.component, ours.name) == (255, 190, "COMMAND_INT")
    assert (theirs.x, theirs.y, theirs.z, theirs.command) == (370_000_000, -86_000_000, 100.0, 192)
    assert ours.raw == raw


def test_frames_come_whole_out_of_any_pieces():
    raw = b"".join(Encoder(255, 190).pack(long(Cmd.ARM_DISARM, 1, index)) for index in range(5))
    for size in (1, 3, 7, 100):
        decoder = Decoder()
        found = [message for at in range(0, len(raw), size) for message in decoder.feed(raw[at : at + size])]
        assert [message["param1"] for message in found] == [0, 1, 2, 3, 4]


def test_a_stream_that_never_ends_at_a_frame_holds_no_more_than_one():
    decoder, raw = Decoder(), Encoder(255, 190).pack(long(Cmd.ARM_DISARM, 1))
    decoder.feed(raw[:10])
    for _ in range(1_000):
        decoder.feed(raw[10:] + raw[:10])
        assert decoder.held <= 300


def test_garbage_is_told_with_its_reason():
    raw = bytearray(Encoder(255, 190).pack(long(Cmd.ARM_DISARM, 1)))
    raw[15] ^= 1
    assert Decoder().feed(bytes(raw)) == [Garbage("bad CRC", len(raw))]
    assert Decoder().feed(b"hello") == [Garbage("bad prefix", 5)]


@pytest.mark.parametrize(
    ("message", "reason"),
    [
        (say("NO_SUCH_THING"), "no message"),
        (say("COMMAND_ACK", command=1), "cannot be packed"),
        (say("COMMAND_ACK", command=1, result=1_000), "cannot be packed"),
    ],
)
def test_what_does_not_fit_a_message_is_an_error_that_says_so(message, reason):
    with pytest.raises(CodecError, match=reason):
        Encoder(255, 190).pack(message)


def test_without_pymavlink_the_error_names_the_extra():
    code = (
        "import sys; sys.modules['pymavlink.dialects.v20'] = None\n"
        "from adapters.mavlink.codec import Decoder\n"
        "try: Decoder()\nexcept Exception as e: sys.exit(str(e))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert "pip install '.[live]'" in done.stderr


def test_messages_are_for_their_target_or_for_everybody():
    assert is_for(long(Cmd.ARM_DISARM, 1), 1)
    assert is_for(HEARTBEAT, 1)
    assert not is_for(long(Cmd.ARM_DISARM, 2), 1)


# --- commands ---------------------------------------------------------------------------------------


def test_a_command_is_sent_again_until_its_sender_sees_what_it_was_for():
    telling, sent = RepeatedMessage(long(Cmd.ARM_DISARM, 1, 1)), []
    for tenth in range(50):
        telling, messages = command.tick(telling, tenth / 10)
        sent += messages
        telling = command.hear(telling, ack(Result.ACCEPTED))  # says little
    assert [message["confirmation"] for message in sent] == [0, 1, 2, 3]


def test_a_command_in_progress_is_left_alone_for_longer():
    telling, _ = command.tick(RepeatedMessage(long(Cmd.ARM_DISARM, 1, 1)), 0.0)
    telling = command.hear(telling, ack(Result.IN_PROGRESS))
    assert command.tick(telling, 3.0)[1] == ()
    assert command.tick(telling, 6.0)[1]


@pytest.mark.parametrize("result", Result)
def test_only_denied_and_unsupported_are_final(result):
    telling, _ = command.tick(RepeatedMessage(long(Cmd.ARM_DISARM, 1, 1)), 0.0)
    refusal = command.hear(telling, ack(result)).refusal
    assert (refusal is not None) == (result in (Result.DENIED, Result.UNSUPPORTED))


def test_an_answer_to_another_command_or_to_none_is_passed_over():
    telling = RepeatedMessage(long(Cmd.ARM_DISARM, 1, 1))
    assert command.hear(telling, ack(Result.DENIED)) is telling  # nothing was sent yet
    telling, _ = command.tick(telling, 0.0)
    assert command.hear(telling, ack(Result.DENIED, Cmd.TAKEOFF)) is telling


# --- links ------------------------------------------------------------------------------------------


def test_a_link_is_lost_after_five_seconds_of_silence_and_restored_by_a_message():
    known, state = absorb(Telemetry(), HEARTBEAT, 10.0), link_loss.LinkState()
    assert link_loss.watch(state, "uav0", known, 14.9) == (state, None)
    state, lost = link_loss.watch(state, "uav0", known, 15.1)
    assert lost == LinkLost("uav0", 15.1, 10.0)
    assert link_loss.watch(state, "uav0", known, 16.0)[1] is None
    _, back = link_loss.watch(state, "uav0", absorb(known, HEARTBEAT, 17.0), 17.0)
    assert back == LinkRestored("uav0", 17.0)


def test_a_vehicle_never_heard_is_not_lost():
    assert link_loss.watch(link_loss.LinkState(), "uav0", Telemetry(), 1e9) == (link_loss.LinkState(), None)


def clocked(known, milliseconds, now=0.0):
    return absorb(
        known, MavlinkMessage("SYSTEM_TIME", {"time_unix_usec": 0, "time_boot_ms": milliseconds}, 1, 1), now
    )


def test_a_clock_that_starts_anew_is_a_reboot_and_a_late_packet_is_none():
    known = clocked(absorb(Telemetry(), HEARTBEAT, 0.0), 100_000)
    late = clocked(clocked(known, 90_000), 101_000)
    assert (late.boots, late.mode) == (0, 0)
    again = clocked(clocked(known, 1_000), 2_000)
    assert (again.boots, again.mode, again.clock) == (1, None, 2_000)


# --- streams ----------------------------------------------------------------------------------------


def test_missing_messages_are_asked_for_every_two_seconds_and_those_that_come_are_not():
    state, sent = streams.tick(streams.Streams(), 1, 0.0)
    assert {message["param1"] for message in sent} == {number for number, _ in map(STREAMS.get, REGULAR)}
    assert streams.tick(state, 1, 1.9)[1] == ()
    for name in REGULAR:
        state = streams.hear(state, MavlinkMessage(name, {}), 2.0)
    state, sent = streams.tick(state, 1, 2.5)
    assert sent == ()
    _, sent = streams.tick(state, 1, 9.0)
    assert {message["param1"] for message in sent} == {
        STREAMS[name][0] for name in REGULAR if name != "HOME_POSITION"
    }


# --- telemetry --------------------------------------------------------------------------------------


def test_what_another_component_says_is_not_the_autopilots_word():
    camera = MavlinkMessage("HEARTBEAT", {"type": 30, "autopilot": 8, **BEAT}, 1, 100)
    assert absorb(Telemetry(), camera, 1.0) == Telemetry()


def test_a_late_position_does_not_take_the_vehicle_back():
    fix = MavlinkMessage("GPS_RAW_INT", {"fix_type": 3}, 1, 1)
    rest = {"alt": 0, "relative_alt": 0, "vx": 0, "vy": 0, "vz": 0, "hdg": 9_000}
    known = absorb(Telemetry(), fix, 0.0)
    for milliseconds, latitude in ((2_000, 37.2), (1_000, 37.1)):
        fields = {"time_boot_ms": milliseconds, "lat": round(latitude * 1e7), "lon": -86_000_000, **rest}
        known = absorb(known, MavlinkMessage("GLOBAL_POSITION_INT", fields, 1, 1), 1.0)
    assert known.position.latitude == 37.2


def test_a_fix_is_believed_for_ten_seconds():
    known = absorb(Telemetry(), MavlinkMessage("GPS_RAW_INT", {"fix_type": 3}, 1, 1), 0.0)
    fields = {"time_boot_ms": 1, "lat": 370_000_000, "hdg": 65_535}
    fields |= dict.fromkeys(("lon", "alt", "relative_alt", "vx", "vy", "vz"), 0)
    position = MavlinkMessage("GLOBAL_POSITION_INT", fields, 1, 1)
    assert absorb(known, position, 9.9).position is not None
    assert absorb(known, position, 10.1).position is None


def test_of_a_vehicle_the_last_warnings_of_a_minute_are_remembered_as_they_can_be_printed():
    known = Telemetry()
    said = [(0.0, 4, "gone"), (50.0, 2, "PreArm:\x1b[31m no"), (60.0, 6, "EKF is fine"), (61.0, 4, "\x07")]
    for time, severity, text in said:
        known = absorb(known, MavlinkMessage("STATUSTEXT", {"text": text, "severity": severity}, 1, 1), time)
    assert known.last_words(61.0) == "; its last words: 'PreArm:[31m no'"
    assert known.last_words(200.0) == ""
