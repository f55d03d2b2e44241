"""What a run reads on its operator's socket, and a client in the run's answers."""

import json
from contextlib import suppress

from hypothesis import given
from json_mutations import mutated
from scale import examples

from adapters.live import operator_socket
from adapters.live.operator_socket import MOST_BYTES, NobodyListens, fates, order
from adapters.live.turn_result import Answer

LINES = [
    {"agent": "op1", "message": "go", "by": "Ana"},
    {"give_back": "uav0", "at": "127.0.0.1:14550", "by": ""},
    {"order": "hold", "vehicle": None, "by": "Ana"},
    {"order": "return", "vehicle": "uav0"},
    {"acknowledge": 1, "by": "Ana"},
    {"start": True, "by": "Ana"},
]
ANSWERS = [
    {"refusal": ""},
    {"refusal": "", "left_out": {"uav1": "a pilot flies it"}, "notes": ["look"]},
    {"refusal": "", "fates": {"uav0": ["sent", "ordered to hold by the operator"]}},
]


@examples(400)
@given(mutated(LINES))
async def test_a_line_with_a_fault_is_a_message_or_is_refused(line):
    heard, started = [], []

    async def listener(said):
        heard.append(said)
        return Answer(said, "")

    def start(by):
        started.append(by)
        return ""

    answer = await operator_socket._answer(line, listener, str, dict, start)
    assert isinstance(answer["refusal"], str)
    assert len(heard) + len(started) <= 1
    for said in heard:
        json.dumps(said.texts, ensure_ascii=False).encode()
        assert all(len(text) <= MOST_BYTES for text in said.texts)


@examples(200)
@given(mutated(ANSWERS))
async def test_an_answer_with_a_fault_is_read_or_is_no_runs(answer):
    async def exchange(_path, _line):
        return answer

    before, operator_socket._exchange = operator_socket._exchange, exchange
    try:
        for asking in (order("x", "hold", None), fates("x")):
            with suppress(NobodyListens):
                await asking
    finally:
        operator_socket._exchange = before
