"""What was learned of one agent, in the names of another one."""

import pytest

from checker.engines.fast.rule_cache import Exchange, NoImage
from checker.reduction.configuration_renaming import Renaming
from semantics.behaviours.values import Text, show
from semantics.state.configuration import Label

SWAP = Exchange(frozenset(), unordered=False, renaming=Renaming({"uav0": "uav1", "uav1": "uav0"}))


@pytest.mark.parametrize(
    "message",
    ["uav0", Text("uav0"), ("at", "uav0", Text('say "uav0" \\')), (Text("uav1"), ("uav0", Text("uav0")))],
)
def test_a_label_under_an_exchange_names_the_others_and_leaves_texts(message):
    about = f"send({show(message)}, b)"
    image = f"send({show(SWAP.renaming.value(message))}, b)"
    assert SWAP.label(Label("req_snd", "uav0", about)) == Label("req_snd", "uav1", image)


def test_whether_a_word_that_is_displayed_is_a_name_cannot_be_told():
    assert SWAP.shown("nobody is there") == "nobody is there"
    with pytest.raises(NoImage):
        SWAP.shown("uav0 is there")
