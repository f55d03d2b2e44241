"""What is offered at a place: the words and the sorts of names that may stand there, and no others."""

from pathlib import Path

import pytest

from bigactors.lsp.completion import complete
from bigactors.lsp.edited_mission import reading_of

MISSIONS = Path(__file__).parents[3] / "specs/missions"
TAKEOVER = (MISSIONS / "takeover.mission").read_text(encoding="utf-8")
BODY = "\ndef fly(place) = {\n  skip\n}\nBigActor x hosted_at gcs0 with_behavior {\n  let foo = uav0\n  "
CHECK = "\ncheck {\n  "
ENTITIES = {"airfield0", "gcs0", "gcs1", "gcs2", "holding0", "mission0", "shore0", "uav0", "vessel0"}
CHANNELS = {"control:gcs0", "control:gcs1", "control:gcs2", "internet"}
KINDS = {"Location", "Station", "UAV", "Vessel"}
AGENTS = {"tower", "emergency", "bridge"}


def offered(text, behind=""):
    """Return what is offered between two texts, by sort."""
    found = complete(reading_of("m", text + behind, MISSIONS), len(text))
    sorts = {}
    for each in found.all:
        sorts.setdefault(each.sort, set()).add(each.text)
    return sorts


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("\nBigActor x hosted_at ", {"entity": ENTITIES}),
        (BODY + "control(", {"rule": {"take"}}),
        (BODY + "control(MOVE ", {"entity": ENTITIES, "variable": {"foo"}}),
        (BODY + "observe(CHILDREN(", {"entity": ENTITIES, "variable": {"foo"}}),
        (BODY + "send foo to ", {"agent": {*AGENTS, "x"}, "variable": {"foo"}}),
        (BODY + "let y = foo of ", {"kind": KINDS}),
        (CHECK + 'invariant "i": uav0 in ', {"entity": ENTITIES}),
        (CHECK + 'invariant "i": pending ', {"agent": AGENTS}),
        (CHECK + 'invariant "i": forall u: ', {"kind": KINDS}),
        (CHECK + 'invariant "i": tower.', {"variable": {"obs"}}),
        ("\nenvironment {\n  uav0 leaves ", {"channel": CHANNELS}),
        ("\nenvironment {\n  uav0 drifts among ", {"entity": ENTITIES}),
        ("\nenvironment {\n  observe may miss ", {"entity": ENTITIES, "kind": KINDS}),
        ("\nenvironment {\n  ", {"entity": ENTITIES, "channel": CHANNELS}),
        ("\nbelieves {\n  ", {"entity": ENTITIES}),
        ("\nworld {\n  uav9: ", {"kind": KINDS}),
        ("\nrule land(u: ", {"kind": KINDS}),
        ("\nsignature {\n  kind Buoy contains ", {"kind": KINDS}),
    ],
)
def test_names_of_the_sorts_that_fit_are_offered(text, expected):
    found = offered(TAKEOVER + text)
    names = {sort: found[sort] for sort in found if sort not in ("word", "function", "command")}
    assert names == expected


def test_quantifiers_go_through_kinds_all_bigactors_and_families():
    family = "\nBigActor patrol[i] for u in UAV hosted_at u with_behavior { skip }"
    found = offered(TAKEOVER + family + CHECK + 'invariant "i": forall x: ')
    assert (found["kind"], found["family"]) == (KINDS, {"patrol"})
    assert "agents" in found["word"]
    assert "agents" not in offered(TAKEOVER + "\nworld {\n  uav9: ").get("word", set())


def test_a_statement_may_begin_where_one_has_ended():
    found = offered(TAKEOVER + BODY, "\n}\n")
    assert {"observe", "control", "loop", "let"} <= found["word"]
    assert not {"and", "in", "of", "environment"} & found["word"]
    assert found["behaviour"] == {"fly"}
    assert found["variable"] == {"foo"}


def test_words_are_offered_where_only_words_may_stand():
    assert offered("scheduler ")["word"] == {"program_order", "unordered", "fcfs"}
    assert offered(TAKEOVER + BODY + "react {\n    case m: ") == {"word": {"Observation", "Message"}}
    assert {"MOVE_HOST_TO", "HAND", "PUT"} <= offered(TAKEOVER + BODY + "control(")["command"]
    assert "race_freedom" in offered(TAKEOVER + CHECK)["word"]


@pytest.mark.parametrize(
    "text", ["// a comment ", 'check {\n  invariant "a ', "BigActor ", "signature {\n  kind "]
)
def test_nothing_is_offered_within_comments_strings_and_new_names(text):
    assert {sort for sort in offered(text) if sort != "word"} == set()


def test_without_a_signature_the_kinds_of_the_paper_are_offered():
    assert {"UAV", "Vessel", "OilSpill"} <= offered("world {\n  uav0: ")["kind"]


def test_a_variable_is_not_offered_behind_its_block():
    found = offered(TAKEOVER + BODY + "loop {\n    let inner = 1\n  }\n  display(", ")\n}\n")
    assert found["variable"] == {"foo"}


def test_what_is_begun_is_replaced_whole():
    text = "world {\n  a: A linked control:gc"
    found = complete(reading_of("m", text + "s0\n}\n", MISSIONS), len(text))
    assert (found.span.start, found.span.end) == (text.index("control"), len(text) + 2)
