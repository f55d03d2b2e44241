"""What one browser is shown by a console, what it may ask for, and what becomes of one that misbehaves."""

import asyncio

import aiohttp
import pytest
from clients import HELLO, PROTOCOL, client, console, play, raw
from live_missions import EAST
from recorded import uav

from adapters.console.requests import Order, RequestedAction
from adapters.live.operator_socket import Outcome


async def test_who_says_hello_is_welcomed_and_gets_a_snapshot(recording):
    async with console(recording) as address, client(address) as looker:
        assert [await looker.frame(), await looker.frame()] == ["welcome", "snapshot"]
        welcome = {"type": "welcome", "protocol": PROTOCOL, "version": "1", "role": "act", "mode": "replay"}
        assert looker.heard == [welcome | {"tiles": False, "recording": ""}]
        assert set(looker.state["vehicles"]) == {"uav0"}
        assert looker.state["mission"]["name"] == "tour.mission"


async def test_who_comes_before_the_run_has_begun_is_told_to_wait_and_then_shown_it(taped, tmp_path):
    path = tmp_path / "run.mcap"
    async with console(path, live=True) as address, client(address) as looker:
        assert [await looker.frame(), await looker.frame()] == ["welcome", "waiting"]
        assert looker.heard[1]["message"] == "the run has not begun to write its recording"
        taped(tmp_path)
        assert await looker.frame() == "snapshot"


async def test_who_waits_for_a_recording_that_is_none_is_told_so(tmp_path):
    path = tmp_path / "run.mcap"
    async with console(path, live=True) as address, client(address) as looker:
        assert [await looker.frame(), await looker.frame()] == ["welcome", "waiting"]
        path.write_text("words")
        assert await looker.frame() == "waiting"
        assert looker.heard[2]["message"] == "this is no recording: it does not begin as MCAP"


async def test_a_recording_that_has_ended_plays_from_its_beginning(recording):
    async with console(recording) as address, client(address) as looker:
        await looker.until(lambda state: state and state["clock"]["now"] > 1000.2)
        clock = looker.state["clock"]
        assert clock["playing"]
        assert not clock["live"]
        assert clock["begin"] == 1000.0
        assert clock["head"] == 1062.0
        assert clock["now"] < 1010.0
        assert (clock["ended"], clock["broken_off"]) == ("the mission has ended", False)


async def test_what_is_shown_after_a_seek_is_what_was_so_then(recording):
    async with console(recording) as address, client(address) as looker:
        for at, lost, said in ((1061.5, False, 2), (1042.0, True, 3), (1050.5, False, 2), (1000.0, False, 3)):
            await looker.say(type="pause")
            await looker.say(type="seek", time=at)
            await looker.until(lambda state, at=at: state and state["clock"]["now"] == at)
            assert looker.state["vehicles"]["uav0"]["link"]["lost"] is lost
            assert sum(
                each["left"] for each in looker.state["sayings"].values() if each["message"] == "status"
            ) in (said, 2)


async def test_it_plays_as_fast_as_is_asked_and_rests_at_the_end(recording):
    async with console(recording) as address, client(address) as looker:
        await looker.say(type="play", speed=100)
        await looker.until(lambda state: state and not play(state))
        assert looker.state["clock"]["now"] == 1062.0
        assert looker.state["clock"]["speed"] == 100


async def test_times_outside_the_recording_are_its_ends(recording):
    async with console(recording) as address, client(address) as looker:
        await looker.say(type="pause")
        for asked, shown in ((1e300, 1062.0), (-5, 1000.0)):
            await looker.say(type="seek", time=asked)
            await looker.until(lambda state, shown=shown: state and state["clock"]["now"] == shown)


async def test_a_growing_recording_is_shown_as_it_grows(taped, tmp_path):
    tape = taped(tmp_path)
    async with console(tape.path, live=True) as address, client(address) as looker:
        await looker.until(lambda state: state and state["vehicles"]["uav0"]["believed"] == "west0")
        assert looker.state["clock"]["live"]
        tape.turn(60, uav(EAST, 60))
        await looker.until(lambda state: state["vehicles"]["uav0"]["believed"] == "east0")
        tape.recorder.close("the mission has ended", 1061.0)
        await looker.until(lambda state: state["clock"]["ended"] is not None)


async def test_a_recording_that_breaks_off_says_so_and_time_stands_still_at_its_end(taped, tmp_path):
    tape = taped(tmp_path)
    tape.turn(60, uav(EAST, 60))
    async with console(tape.path) as address, client(address) as looker:
        await looker.say(type="live")
        await looker.until(lambda state: state and state["clock"]["ended"] and state["clock"]["live"])
        clock = looker.state["clock"]
        assert (clock["broken_off"], clock["now"]) == (True, clock["head"])
        assert clock["ended"] == "the recording breaks off here: its run was killed, or is not over yet"


async def test_who_looks_back_while_it_goes_on_may_return_to_the_newest_moment(taped, tmp_path):
    tape = taped(tmp_path)
    tape.turn(60, uav(EAST, 60))
    async with console(tape.path, live=True) as address, client(address) as looker:
        await looker.say(type="seek", time=1001.0)
        await looker.until(lambda state: state and state["vehicles"]["uav0"]["believed"] == "west0")
        assert not looker.state["clock"]["live"]
        await looker.say(type="live")
        await looker.until(lambda state: state["clock"]["live"])
        assert looker.state["vehicles"]["uav0"]["believed"] == "east0"


# --- actions


async def test_an_action_is_performed_for_who_asks_and_answered(taped, tmp_path):
    done = []

    async def perform(action, by):
        done.append((action, by))
        return (
            Outcome("", {"uav1": "a pilot flies it"}, ("look",)) if len(done) == 1 else Outcome("not twice")
        )

    tape = taped(tmp_path)
    async with console(tape.path, live=True, perform=perform) as address, client(address) as looker:
        await looker.until(bool)
        told = {"refusal": "", "left_out": {"uav1": "a pilot flies it"}, "notes": ["look"]}
        for name, answer in (("1", told), ("2", {"refusal": "not twice", "left_out": {}, "notes": []})):
            await looker.say(type="act", id=name, action={"order": {"order": "hold", "vehicle": None}})
            assert await looker.answer() == {"type": "answer", "id": name, **answer}
        assert done == [(RequestedAction(order=Order("hold", None)), "Ana")] * 2


@pytest.mark.parametrize(
    ("token", "live", "why"),
    [("looks-on", True, "this link only watches"), ("may-act", False, "this console only watches")],
)
async def test_nobody_acts_who_may_only_watch_and_nobody_in_the_past(
    recording, taped, tmp_path, token, live, why
):
    async def perform(_action, _by):
        raise AssertionError

    tape = taped(tmp_path)
    path = tape.path if live else recording
    more = {"perform": perform} if live else {}
    async with (
        console(path, live=live, **more) as address,
        client(address, hello=HELLO | {"token": token}) as looker,
    ):
        await looker.until(bool)
        await looker.say(type="act", id="1", action={"give_back": {"vehicle": "uav0"}})
        assert (await looker.answer())["refusal"].startswith(why)


async def test_nobody_acts_without_a_name(taped, tmp_path):
    async def perform(_action, _by):
        raise AssertionError

    tape = taped(tmp_path)
    async with (
        console(tape.path, live=True, perform=perform) as address,
        client(address, hello=HELLO | {"name": ""}) as looker,
    ):
        await looker.until(bool)
        await looker.say(type="act", id="1", action={"order": {"order": "hold", "vehicle": "uav0"}})
        assert "say who you are first" in (await looker.answer())["refusal"]


async def test_who_looks_back_is_told_to_go_to_the_newest_moment_before_acting(taped, tmp_path):
    async def perform(_action, _by):
        raise AssertionError

    tape = taped(tmp_path)
    tape.turn(60, uav(EAST, 60))
    async with console(tape.path, live=True, perform=perform) as address, client(address) as looker:
        await looker.say(type="seek", time=1001.0)
        await looker.until(lambda state: state and not state["clock"]["live"])
        await looker.say(type="act", id="1", action={"order": {"order": "hold", "vehicle": "uav0"}})
        assert "go to the newest one" in (await looker.answer())["refusal"]


# --- what clients do to it


@pytest.mark.parametrize(
    "text",
    ["", "[]", "{", "null", '{"type":"act"}', '{"type":"seek","time":"now"}', '{"type":"seek","time":NaN}',
     '{"type":"play","speed":0.1}', '{"type":"play","speed":true}', '{"type":"act","id":"1","action":{"say":{}}}',
     '{"type":"act","id":"1","action":{"order":{"order":"land","vehicle":null}}}', '{"type":"seek","time":1e999}',
     '{"type":"act","id":"1","action":{"acknowledge":{"alert":"-1"}}}', "[" * 10_000, '{"type":"hello"}'],
)  # fmt: skip
async def test_what_is_not_understood_is_answered_with_an_error(recording, text):
    async with console(recording) as address, client(address) as looker:
        await looker.until(bool)
        await looker.socket.send_str(text)
        assert (await looker.answer())["type"] == "error"
        await looker.say(type="pause")
        await looker.until(lambda state: not play(state))


async def test_bytes_are_no_text_and_too_much_at_once_ends_the_connection(recording):
    async with console(recording) as address, client(address) as looker, client(address) as other:
        await looker.until(bool)
        await looker.socket.send_bytes(b"{}")
        assert "text" in (await looker.answer())["message"]
        await looker.socket.send_str("x" * 20_000)
        async with asyncio.timeout(10):
            while (message := await looker.socket.receive()).type is aiohttp.WSMsgType.TEXT:
                pass
        assert message.data == 1009
        await other.until(bool)


async def test_who_asks_too_often_is_let_go(recording):
    async with console(recording) as address, client(address) as looker:
        await looker.until(bool)
        for _ in range(200):
            await looker.say(type="pause")
        async with asyncio.timeout(10):
            while (message := await looker.socket.receive()).type is aiohttp.WSMsgType.TEXT:
                pass
        assert message.data == 4429


async def test_who_takes_nothing_does_not_hold_up_the_others(recording, monkeypatch):
    monkeypatch.setattr("adapters.console.browser_session.STALLED", 1.0)
    async with console(recording) as address:
        stalled = raw(address)
        async with client(address) as looker:
            await looker.say(type="play", speed=10)
            await looker.until(lambda state: state and state["clock"]["now"] > 1030.0)
            assert looker.frames > 20
        stalled.close()
