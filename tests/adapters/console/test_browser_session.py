"""What one browser is shown by a console, what it may ask for, and what becomes of one that misbehaves."""

import asyncio
from contextlib import asynccontextmanager

import aiohttp
import pytest
from console_clients import HELLO, PROTOCOL, client, console, play, raw
from live_missions import EAST, WEST
from recorded import Tape, uav

from adapters.console.browser_requests import Order, RequestedAction
from adapters.live.operator_socket import Outcome


@asynccontextmanager
async def looking(path, hello=HELLO, **more):
    """Serve a recording; yield a client of it."""
    async with console(path, **more) as address, client(address, hello=hello) as looker:
        yield looker


async def test_who_says_hello_is_welcomed_and_gets_a_snapshot(recording):
    async with looking(recording) as looker:
        assert [await looker.frame(), await looker.frame()] == ["welcome", "snapshot"]
        welcome = {"type": "welcome", "protocol": PROTOCOL, "version": "1", "role": "act", "mode": "replay"}
        assert looker.heard == [welcome | {"tiles": False, "recording": ""}]
        assert set(looker.state["vehicles"]) == {"uav0"}
        assert looker.state["mission"]["name"] == "tour.mission"


async def test_who_comes_before_the_run_has_begun_is_told_to_wait_and_then_shown_it(tmp_path):
    path = tmp_path / "run.mcap"
    async with looking(path, live=True) as looker:
        assert [await looker.frame(), await looker.frame()] == ["welcome", "waiting"]
        assert looker.heard[1]["message"] == "the run has not begun to write its recording"
        with Tape(path) as tape:
            tape.turn(0, uav(WEST, 0))
            assert await looker.frame() == "snapshot"


async def test_who_waits_for_a_recording_that_is_none_is_told_so(tmp_path):
    path = tmp_path / "run.mcap"
    async with looking(path, live=True) as looker:
        assert [await looker.frame(), await looker.frame()] == ["welcome", "waiting"]
        path.write_text("words")
        assert await looker.frame() == "waiting"
        assert looker.heard[2]["message"] == "this is no recording: it does not begin as MCAP"


async def test_a_recording_that_has_ended_plays_from_its_beginning_to_its_end(recording):
    async with looking(recording) as looker:
        await looker.until(lambda state: state["clock"]["now"] > 1000.2)
        clock = {"playing": True, "live": False, "begin": 1000.0, "head": 1062.0, "broken_off": False}
        clock |= {"ended": "the mission has ended"}
        assert looker.state["clock"].items() >= clock.items()
        assert looker.state["clock"]["now"] < 1010.0
        await looker.say(type="play", speed=100)
        await looker.until(lambda state: not play(state))
        assert (looker.state["clock"]["now"], looker.state["clock"]["speed"]) == (1062.0, 100)


async def test_what_is_shown_after_a_seek_is_what_was_so_then_or_at_the_nearest_end(recording):
    async with looking(recording) as looker:
        await looker.say(type="pause")
        for asked, at, lost, left in [
            (1061.5, 1061.5, False, 2),
            (1042.0, 1042.0, True, 3),
            (1050.5, 1050.5, False, 2),
            (1000.0, 1000.0, False, 3),
            (1e300, 1062.0, False, 2),
            (-5, 1000.0, False, 3),
        ]:
            await looker.say(type="seek", time=asked)
            await looker.until(lambda state, at=at: state["clock"]["now"] == at)
            assert looker.state["vehicles"]["uav0"]["link"]["lost"] is lost
            assert looker.state["sayings"]['op "status"']["left"] == left


async def test_a_growing_recording_is_shown_as_it_grows_and_who_looks_back_may_return(flight):
    async with looking(flight.path, live=True) as looker:
        await looker.until(lambda state: state["vehicles"]["uav0"]["believed"] == "west0")
        assert looker.state["clock"]["live"]
        flight.turn(60, uav(EAST, 60))
        await looker.until(lambda state: state["vehicles"]["uav0"]["believed"] == "east0")
        await looker.say(type="seek", time=1001.0)
        await looker.until(lambda state: state["vehicles"]["uav0"]["believed"] == "west0")
        assert not looker.state["clock"]["live"]
        await looker.say(type="live")
        await looker.until(lambda state: state["clock"]["live"])
        assert looker.state["vehicles"]["uav0"]["believed"] == "east0"
        flight.end(61)
        await looker.until(lambda state: state["clock"]["ended"] is not None)


async def test_a_recording_that_breaks_off_says_so_and_time_stands_still_at_its_end(flight):
    flight.turn(60, uav(EAST, 60))
    async with looking(flight.path) as looker:
        await looker.say(type="live")
        await looker.until(lambda state: state["clock"]["ended"] and state["clock"]["live"])
        clock = looker.state["clock"]
        assert (clock["broken_off"], clock["now"]) == (True, clock["head"])
        assert clock["ended"] == "the recording breaks off here: its run was killed, or is not over yet"


# --- actions


async def test_an_action_is_performed_for_who_asks_and_answered(flight):
    done = []
    outcomes = [Outcome("", {"uav1": "a pilot flies it"}, ("look",)), Outcome("not twice")]

    async def perform(action, by):
        done.append((action, by))
        return outcomes[len(done) - 1]

    async with looking(flight.path, live=True, perform=perform) as looker:
        await looker.until(bool)
        told = {"refusal": "", "left_out": {"uav1": "a pilot flies it"}, "notes": ["look"]}
        for name, answer in (("1", told), ("2", {"refusal": "not twice", "left_out": {}, "notes": []})):
            await looker.say(type="act", id=name, action={"order": {"order": "hold", "vehicle": None}})
            assert await looker.answer() == {"type": "answer", "id": name, **answer}
        assert done == [(RequestedAction(order=Order("hold", None)), "Ana")] * 2


async def never(_action, _by):
    raise AssertionError


@pytest.mark.parametrize(
    ("hello", "live", "looks_back", "why"),
    [
        pytest.param({"token": "looks-on"}, True, False, "this link only watches", id="who watches"),
        pytest.param({}, False, False, "this console only watches", id="in a recording"),
        pytest.param({"name": ""}, True, False, "enter your name first", id="without a name"),
        pytest.param({}, True, True, "go to the newest one", id="in the past"),
    ],
)
async def test_nobody_acts_who_may_not(recording, flight, hello, live, looks_back, why):
    flight.turn(60, uav(EAST, 60))
    path, more = (flight.path, {"perform": never}) if live else (recording, {})
    async with looking(path, HELLO | hello, live=live, **more) as looker:
        if looks_back:
            await looker.say(type="seek", time=1001.0)
        await looker.until(lambda state: not (looks_back and state["clock"]["live"]))
        assert why in await looker.act(give_back={"vehicle": "uav0"})


# --- what clients do to it


MISUNDERSTOOD = [
    *("", "[]", "{", "null", '{"type":"act"}', '{"type":"hello"}', "[" * 10_000),
    *('{"type":"seek","time":"now"}', '{"type":"seek","time":NaN}', '{"type":"seek","time":1e999}'),
    *('{"type":"play","speed":0.1}', '{"type":"play","speed":true}'),
    '{"type":"act","id":"1","action":{"say":{}}}',
    '{"type":"act","id":"1","action":{"order":{"order":"land","vehicle":null}}}',
    '{"type":"act","id":"1","action":{"acknowledge":{"alert":"-1"}}}',
]


async def test_what_is_not_understood_is_answered_with_an_error_and_the_next_is_heard(recording):
    async with looking(recording) as looker:
        await looker.until(bool)
        for text in MISUNDERSTOOD:
            await looker.socket.send_str(text)
            assert (await looker.answer())["type"] == "error", text
        await looker.socket.send_bytes(b"{}")
        assert "text" in (await looker.answer())["message"]
        await looker.say(type="pause")
        await looker.until(lambda state: not play(state))


async def code_of(looker):
    """Wait until a connection is closed; return why."""
    async with asyncio.timeout(10):
        while (message := await looker.socket.receive()).type is aiohttp.WSMsgType.TEXT:
            pass
    return message.data


@pytest.mark.parametrize(
    ("text", "times", "code"),
    [
        pytest.param("x" * 20_000, 1, 1009, id="who says too much at once"),
        pytest.param('{"type":"pause"}', 200, 4429, id="who asks too often"),
    ],
)
async def test_who_overwhelms_it_is_let_go_and_others_are_not(recording, text, times, code):
    async with console(recording) as address, client(address) as looker, client(address) as other:
        await looker.until(bool)
        for _ in range(times):
            await looker.socket.send_str(text)
        assert await code_of(looker) == code
        await other.until(bool)


async def test_who_takes_nothing_does_not_hold_up_the_others(recording, monkeypatch):
    monkeypatch.setattr("adapters.console.browser_session.STALLED", 1.0)
    async with console(recording) as address:
        stalled = raw(address)
        async with client(address) as looker:
            await looker.say(type="play", speed=10)
            await looker.until(lambda state: state["clock"]["now"] > 1030.0)
            assert looker.frames > 20
        stalled.close()
