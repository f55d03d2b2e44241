"""What is shown beside something: names, constructs with the rules that serve them, and mistakes explained."""

from pathlib import Path

import pytest

from bigactors.lsp.edited_mission import reading_of
from bigactors.lsp.hover import SERVED_BY, hover
from specs import explain, find_code
from specs import syntax as s

MISSIONS = Path(__file__).parents[3] / "specs/missions"
TAKEOVER = (MISSIONS / "takeover.mission").read_text(encoding="utf-8")


def shown(words, text=TAKEOVER):
    found = hover(reading_of("m", text, MISSIONS), text.index(words))
    return "" if found is None else found.text


@pytest.mark.parametrize(
    ("words", "parts"),
    [
        ("mission0: ", ["**entity** `mission0`", "mission0: Location = box", "area: "]),
        ("Vessel\n", ["**kind** `Vessel`", "1 of it: vessel0"]),
        ("control:gcs0, internet", ["**channel** `control:gcs0`", "links uav0, gcs0"]),
        ("tower hosted_at", ["**bigActor** `tower`", "BigActor tower hosted_at gcs0"]),
        ("take(", ["**rule** `take`", "rule take("]),
        ("obs =>", ["**variable** `obs`", "bound in line"]),
        ("MOVE", ["`MOVE entity TO place`", "⟨req_ctr : a, control(R ⇒ R′)⟩", "**actuate**"]),
        ("react", ["**rcv_obs**", "**rcv_msg**"]),
        ("race_freedom", ["`race_freedom`: "]),
    ],
)
def test_a_name_or_a_construct_tells_what_it_is(words, parts):
    text = shown(words)
    assert [part for part in parts if part not in text] == []


def test_a_mistake_is_explained():
    text = TAKEOVER.replace("hosted_at gcs0", "hosted_at gcs9")
    assert explain(find_code("LS201")) in shown("gcs9", text)


def test_nothing_is_shown_of_comments_and_empty_lines():
    assert shown("An emergency") == ""
    assert shown("\n\n") == ""


def test_each_statement_that_takes_a_step_tells_its_rules():
    silent = {s.Skip, s.While, s.Choose, s.ChooseFrom} - SERVED_BY.keys()
    statements = {each for each in s.Statement.__args__ if each not in SERVED_BY}
    assert statements == silent
