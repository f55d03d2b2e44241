"""The protocol of a console: what its reference says of it, and what is read of it."""

import asyncio
import json
import re
import sys
from contextlib import suppress

import pytest
from console_clients import ACCESS, DOCS, HELLO, OF_CLIENT, OF_SERVER, SCHEMA, console
from hypothesis import given
from json_mutations import mutated
from page_harness import with_alarms, world
from scale import examples

from adapters.console.browser_requests import MOST_BYTES, Unreadable, read_request
from physical import PhysicalError, read_json


async def test_the_client_of_the_page_follows(recording):
    page = (DOCS / "console.md").read_text(encoding="utf-8")
    code = page.partition("```python\n")[2].partition("```")[0]
    async with console(recording) as address:
        link = f"{address}/#token={ACCESS.watch}"
        process = await asyncio.create_subprocess_exec(
            sys.executable, "-c", code, link, stdout=asyncio.subprocess.PIPE
        )
        try:
            async with asyncio.timeout(20):
                while not (said := await process.stdout.readline()).startswith(b"{'uav0':"):
                    assert said == b"{}\n"
        finally:
            process.kill()
            await process.wait()


def act(**action):
    return {"type": "act", "id": "1", "action": action}


FRAMES = [
    HELLO,
    {"type": "seek", "time": 1.5},
    {"type": "play", "speed": 0.5},
    {"type": "pause"},
    {"type": "live"},
    *(
        act(**action)
        for action in (
            {"say": {"agent": "tower", "message": "handover"}},
            {"order": {"order": "hold", "vehicle": None}},
            {"order": {"order": "return", "vehicle": "uav0"}},
            {"give_back": {"vehicle": "uav0"}},
            {"acknowledge": {"alert": "17"}},
            {"start": True},
        )
    ),
]


def test_what_a_client_says_is_understood_and_in_the_schema():
    for said in FRAMES:
        OF_CLIENT.validate(said)
        assert read_request(json.dumps(said))


def test_the_state_that_tests_of_the_page_show_is_one_of_the_schema():
    OF_SERVER.validate({"type": "snapshot", "n": 1, "state": with_alarms(world())})


WITH_A_LINE_FEED = act(acknowledge={"alert": "1\n"})
"""Not of the schema either, but of what Python's regular expressions make of it: their `$` passes a last line feed."""


@pytest.mark.parametrize(
    ("said", "fault"),
    [
        ({"type": "stop"}, "`$.type`: invalid value 'stop'"),
        ({"type": "play", "speed": 101}, "`$.speed`: expected `float` <= 100.0"),
        ({"type": "play", "speed": 0.4}, "`$.speed`: expected `float` >= 0.5"),
        ({"type": "play", "speed": None}, "`$.speed`: expected `float`, got `null`"),
        ({"type": "seek", "time": True}, "`$.time`: expected `float`, got `bool`"),
        ({"type": "seek"}, "`$`: it lacks `time`"),
        (act(say={"agent": "a"}), "`$.action.say`: it lacks `message`"),
        (act(), "`$.action`: expected one of 'say', 'order'"),
        (act(start=False), "`$.action`: expected one of 'say'"),
        (act(start=True, give_back={"vehicle": "a"}), "`$.action`: expected one of 'say'"),
        (act(fly=1), "`$.action`: object contains unknown field `fly`"),
        (WITH_A_LINE_FEED, "`$.action.acknowledge.alert`: expected `str` matching regex"),
        ([], "`$`: expected `object`, got `array`"),
    ],
)
def test_what_the_schema_refuses_is_refused_with_the_place_of_the_fault(said, fault):
    assert not OF_CLIENT.is_valid(said) or said == WITH_A_LINE_FEED
    with pytest.raises(Unreadable, match=re.escape(fault)):
        read_request(json.dumps(said))


@examples(500)
@given(mutated(FRAMES))
def test_a_frame_with_a_fault_is_understood_or_refused_and_understood_if_it_is_in_the_schema(said):
    text = said.decode("utf-8", "replace")
    try:
        read_request(text)
    except Unreadable as refused:
        assert len(str(refused)) < 1_000  # noqa: PT017
        with suppress(PhysicalError):
            assert not OF_CLIENT.is_valid(read_json(text, MOST_BYTES))


def test_the_reference_lists_the_sections_of_the_schema_in_their_order():
    page = (DOCS / "console.md").read_text(encoding="utf-8")
    listed = re.findall(
        r"^\| `(\w+)` \|", page.partition("## The sections")[2].partition("\n## ")[0], re.MULTILINE
    )
    assert listed == list(SCHEMA["$defs"]["sections"]["properties"])


def objects(part):
    """Yield all that a schema says of objects with members."""
    if isinstance(part, dict):
        if "properties" in part:
            yield part
        part = list(part.values())
    for each in part if isinstance(part, list) else []:
        yield from objects(each)


def test_a_misspelt_member_is_refused_in_every_object_of_the_schema():
    assert [each for each in objects(SCHEMA) if each.get("additionalProperties") is not False] == []
