"""Loops that ask and never wait."""

import pytest
from checked_missions import load

ASKS = "control(MOVE_HOST_TO gate0)"
LOOKS = "observe(PARENT(HOST)) react { case o: Observation => skip }"
UNPACED = {
    "a loop that only asks": f"loop {{ {ASKS} }}",
    "a loop that waits on one way only": f"loop {{ if HOST == uav0 {{ {LOOKS} }} {ASKS} }}",
    "a loop that calls what asks": "loop { go() }",
    "a while that nothing ends": f"while HOST == uav0 {{ {ASKS} }}",
    "a loop that goes through places": "loop { for p in [gate0, south0] { control(MOVE_HOST_TO p) } }",
}
PACED = {
    "a loop that waits": f"loop {{ {ASKS} {LOOKS} }}",
    "a loop that waits for a message": f'loop {{ {ASKS} react {{ case "go" => skip }} }}',
    "a loop that waits for a while": f'loop {{ {ASKS} react {{ case "go" => skip after 5 s => skip }} }}',
    "a while that counts": f"let n = 0 while n < 3 {{ {ASKS} n = n + 1 }}",
    "a loop that ends in one that waits": f"loop {{ {ASKS} loop {{ {LOOKS} }} }}",
}


def warned(body):
    text = f"def go() = {{ {ASKS} }}\nBigActor a hosted_at uav0 with_behavior {{ {body} }}\n"
    return [each.message for each in load(text).warnings if each.code.number == "LS708"]


@pytest.mark.parametrize("body", UNPACED.values(), ids=UNPACED)
def test_who_asks_and_never_waits_is_warned_of(body):
    (message,) = warned(body)
    assert message.startswith("a asks for this in a loop that never waits (line ")


@pytest.mark.parametrize("body", PACED.values(), ids=PACED)
def test_who_waits_in_each_turn_is_not(body):
    assert warned(body) == []
