"""What a misspelt word was meant to be, and where nothing near is told."""

import pytest

from bigraphs.notation.spelling import did_you_mean, listed, nearest


@pytest.mark.parametrize(
    ("word", "among", "meant"),
    [
        ("serchArea0", ["searchArea0", "searchArea1", "uav0"], ("searchArea0",)),
        ("raect", ["react", "reach"], ("react",)),
        ("hots", ["host", "spawn"], ("host",)),
        ("UAVs", ["UAV", "Vessel"], ("UAV",)),
        ("uav00", ["uav0"], ("uav0",)),
        ("OilSpil", ["OilSpill", "oilSpill0"], ("OilSpill", "oilSpill0")),
    ],
)
def test_a_word_with_few_wrong_letters_is_recognised(word, among, meant):
    assert nearest(word, among) == meant


@pytest.mark.parametrize(
    ("word", "among"),
    [
        ("Lake", ["Tanker"]),
        ("q", ["p", "SELF"]),
        ("c3", ["c1", "c2"]),
        ("uav7", ["uav1"]),
        ("radio", ["vhf", "region"]),
        ("swimmer", ["simmering_water"]),
        ("", ["a"]),
        ("a" * 61, ["a" * 60]),
    ],
)
def test_what_only_resembles_a_word_or_is_its_neighbour_is_not_suggested(word, among):
    assert did_you_mean(word, among) == ""


def test_long_lists_are_cut():
    names = [f"cell{number:02}" for number in range(12)]
    assert listed(names, "entities") == (
        "the entities are cell00, cell01, cell02, cell03, cell04, cell05, cell06, cell07 and 4 more"
    )
    assert listed(["a"], "entities") == "the only entity is a"
    assert listed((), "rules") == "there are no rules"
