"""Pages: one file that needs nothing else, whatever names and messages a mission has."""

import base64
import hashlib
import re
from dataclasses import replace
from html.parser import HTMLParser
from importlib.resources import files as resources
from pathlib import Path

import pytest
from drawn_missions import CHANNELS, KINDS, PLACEMENTS, SIGNATURE, observing, oil_spill, run

from bigactors.pages import Story, page_of, telling, trace_page
from bigactors.pictures import Panels
from checker import Step, Trace, check
from checker.reports.lanes import Repetition
from semantics.behaviours.program import Program
from semantics.state.agents import mailbox_cell
from semantics.state.initial import initial
from semantics.state.setting import Setting
from specs.elaboration import load_mission

ROOT = Path(__file__).parents[2]
HOSTILE = "</script><img src=//evil.example/x onerror=alert(1)>&amp;\"' $x^2$"
EMPTY = {"meta", "input", "br", "img", "link"}
DRAWN = {"g", "path", "text", "tspan", "use", "defs", "clippath", "rect", "circle", "ellipse", "line", "svg"}
WRITTEN = {
    "html", "head", "meta", "title", "style", "noscript", "body", "header", "h1", "h2", "p", "main", "section",
    "table", "thead", "tbody", "tfoot", "tr", "th", "td", "a", "div", "b", "ul", "li", "span", "small", "button",
    "strong", "input", "output", "figure", "details", "summary", "pre", "script", "template",
}  # fmt: skip


class Reader(HTMLParser):
    """What a browser finds in a page: elements with their attributes, and text; balanced, or it says so."""

    def __init__(self, page):
        super().__init__()
        self.elements, self.texts, self.open = [], [], []
        self.feed(page)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))
        if tag not in EMPTY:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.texts.append(data)

    def all(self, tag, **attributes):
        return [
            found
            for name, found in self.elements
            if name == tag
            and all(found.get(key.replace("_", "-")) == value for key, value in attributes.items())
        ]


def trace_of(configuration):
    configurations, labels = run(configuration)
    steps = (Step(label, 0, target) for label, target in zip(labels, configurations[1:], strict=True))
    return Trace(configurations[0], tuple(steps))


@pytest.fixture(scope="module")
def trace():
    return trace_of(oil_spill())


@pytest.fixture(scope="module")
def page(trace):
    return trace_page(Story("oil spill", "found: a witness", False, trace, note="digest"))


def hostile_trace():
    """A run in which every name is hostile."""
    named = {name: f"{name}{HOSTILE}" for name in KINDS}
    kinds = {named[name]: kind for name, kind in KINDS.items()}
    setting = Setting(SIGNATURE, kinds, Program(()))
    placements = {named[name]: each for name, each in PLACEMENTS.items() if name != "drifter0"}
    channels = {named[name]: tuple(f"{each}{HOSTILE}" for each in on) for name, on in CHANNELS.items()}
    c = initial(setting, placements, channels, {f"a{HOSTILE}": (named["uav0"], ())})
    return Trace(c.with_({mailbox_cell(f"a{HOSTILE}"): (HOSTILE, "\x00\x1b\ud800")}))


# --- what it shows --------------------------------------------------------------------------------------------


def test_a_page_has_a_row_and_a_frame_for_each_configuration(page, trace):
    read = Reader(page)
    assert [each["data-row"] for _, each in read.elements if "data-row" in each] == [
        str(number) for number in range(len(trace) + 1)
    ]
    frames = [each for _, each in read.elements if "data-frame" in each]
    assert [each["data-label"] for each in frames] == [
        "the first configuration",
        *(str(step.label) for step in trace.steps),
    ]
    pictures = {each["data-picture"] for each in read.all("svg") if "data-picture" in each}
    assert {frame[key] for frame in frames for key in ("data-l", "data-p")} == pictures


def test_what_looks_alike_is_drawn_once(page, trace):
    pictures = [each for each in Reader(page).all("svg") if "data-picture" in each]
    assert 4 <= len(pictures) < 2 * (len(trace) + 1)


def test_the_lanes_say_who_did_what_and_what_it_changed(page):
    flight = "MOVE_HOST_TO searchArea0"
    assert {"searcher", "req_ctr"} <= set(Reader(page).texts)
    assert all(words in page for words in (f"control({flight})", f"+ CTR(searcher, {flight})"))


def test_where_few_are_to_be_drawn_the_last_ones_are(trace):
    told = telling(Story("t", "", False, trace, drawn=1))
    assert [frame.number for frame in told.frames if frame.logical][-1] == len(trace)
    assert len({frame.logical.key for frame in told.frames if frame.logical}) == 1
    undrawn = sum(None in (each.logical, each.physical) for each in told.frames)
    words = (
        f"{undrawn} of {len(trace) + 1} configurations are not drawn: "
        "a page made by `show` with --step K has those around c_K"
    )
    assert told.left_out == (words,)
    begun = telling(Story("t", "", False, trace, start=5, drawn=1))  # in the middle
    assert begun.frames[5].logical
    assert begun.frames[5].physical


# --- steps that repeat ------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def looping():
    return observing(12)


def test_steps_that_only_repeat_others_are_one_row_and_each_is_in_the_page(looping):
    times = tuple(100.0 + 0.5 * number for number in range(len(looping)))
    told = telling(Story("t", "", False, looping, times=times))
    (again,) = (row for row in told.rows if isinstance(row, Repetition))
    assert again.last == len(looping) == len(told.order) - 1
    assert len(told.rows) - 1 + len(again.steps) == len(looping)
    assert len(told.frames) < 12
    assert None not in told.order
    assert told.left_out == ()
    assert told.seconds[-1] == 0.5 * (len(looping) - 1)


def test_unfolded_each_step_has_a_row(looping):
    told = telling(Story("t", "", False, looping, unfolded=True))
    assert [row.number for row in told.rows] == list(range(1, len(looping) + 1))


def test_of_a_trace_that_no_page_can_hold_the_ends_and_what_is_around_the_start_are_shown(
    looping, monkeypatch
):
    monkeypatch.setattr("bigactors.pages.story.MOST_ROWS", 6)
    monkeypatch.setattr("bigactors.pages.story._looks", lambda trace: tuple(range(len(trace) + 1)))
    told = telling(Story("t", "", False, looping, start=20, unfolded=True))
    held = [number for number, place in enumerate(told.order) if place is not None]
    assert held == [0, 1, 2, 19, 20, 47, 48]
    read = Reader(page_of(told))
    assert [(each["data-from"], each["data-to"]) for _, each in read.elements if "data-from" in each] == [
        ("3", "18"),
        ("21", "46"),
    ]
    words = (
        "42 of 49 configurations are left out, between c3 and c46: "
        "a page made by `show` with --step K has those around c_K"
    )
    assert words in read.texts


def test_a_run_that_repeats_leads_back(trace):
    read = Reader(trace_page(Story("t", "", False, replace(trace, loop=2), drawn=1)))
    assert read.all("body")[0]["data-loop"] == "2"
    assert f"↻ c{len(trace)} is c2: from there on again and again" in read.texts


def test_a_trace_without_steps_is_a_page(trace):
    read = Reader(trace_page(Story("t", "", False, Trace(trace.initial))))
    assert [each["max"] for each in read.all("input", type="range")] == ["0"]


def test_all_maps_of_a_run_have_one_view(trace):
    panels = Panels.of(trace.configurations, 100)
    grids = {
        tuple(re.findall(r">([\d.]+°[NSEW])<", panels.physical(c, None).picture.shapes))
        for c in trace.configurations
    }
    assert len(grids) == 1


def test_the_same_trace_gives_the_same_small_page(trace, page):
    assert trace_page(Story("oil spill", "found: a witness", False, trace, note="digest")) == page
    assert len(page.encode()) / (len(trace) + 1) < 40_000
    assert len(trace_page(Story("t", "", False, observing(5_000))).encode()) < 500_000


# --- that it is safe and self-contained -----------------------------------------------------------------------


@pytest.fixture(scope="module", params=["plain", "hostile"])
def any_page(request, page):
    if request.param == "plain":
        return page
    return trace_page(Story(HOSTILE, HOSTILE, True, hostile_trace(), note=HOSTILE, details=(HOSTILE,)))


def test_nothing_is_loaded_from_anywhere(any_page):
    read = Reader(any_page)
    for tag, attributes in read.elements:
        assert tag in WRITTEN | DRAWN
        assert not {"src", "srcset", "action", "formaction", "data", "poster", "background"} & set(attributes)
        assert not [name for name in attributes if name.startswith("on") or name == "xlink:href"]
        assert attributes.get("href", "#").startswith("#")
        assert "url(" not in attributes.get("style", "")
        assert all("http" not in (value or "") for value in attributes.values())
    styles = any_page[any_page.index("<style>") : any_page.index("</style>")]
    assert "url(" not in styles
    assert "@import" not in styles


def test_the_only_script_is_ours_and_the_policy_names_its_digest(any_page):
    script = (resources("bigactors.pages") / "trace.js").read_text(encoding="utf-8")
    assert any_page.count("<script") == 1
    assert f"<script>{script}</script>" in any_page
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    (policy,) = Reader(any_page).all("meta", http_equiv="Content-Security-Policy")
    assert policy["content"].startswith("default-src 'none'; ")
    assert f"script-src 'sha256-{digest}'" in policy["content"]


def test_hostile_names_are_text(any_page):
    read = Reader(any_page)
    assert read.all("img") == []
    assert not any(sign in any_page for sign in ("\x00", "\x1b", "\ud800"))


def test_hostile_names_are_shown_as_they_are():
    texts = "".join(Reader(trace_page(Story(HOSTILE, "", False, hostile_trace()))).texts)
    assert texts.count(HOSTILE) >= 8


def test_ids_are_there_once_and_references_lead_to_them(any_page):
    read = Reader(any_page)
    ids = [each["id"] for _, each in read.elements if "id" in each]
    assert len(ids) == len(set(ids))
    clips = {each["clip-path"][5:-1] for _, each in read.elements if "clip-path" in each}
    assert clips <= set(ids)


def test_a_page_can_be_used_without_a_pointer_or_sight(any_page):
    read = Reader(any_page)
    assert read.elements[0] == ("html", {"lang": "en"})
    assert all(each.get("aria-label") or each.get("title") for each in read.all("button"))
    assert all(
        each.get("role") == "img" and each["aria-label"] for each in read.all("svg") if "data-picture" in each
    )
    labels = [each["aria-label"] for each in read.all("input")]
    assert labels == ["configuration", "find in the steps; Enter goes on"]
    assert {each.get("scope") for each in read.all("th")} == {"row", "col"}
    stops = ("a", "button", "input", "summary", "select", "textarea")  # of the tab key
    first = next(attributes for tag, attributes in read.elements if tag in stops)
    assert first["id"] == "play"


def test_the_page_of_a_run_with_dates_has_gaps_where_time_passes():
    found = check(load_mission("broken_endurance")).verdicts["endurance"].violations[0].trace
    page = trace_page(Story("broken_endurance", "", True, found))
    gaps = dict(re.findall(r"--gap: (\d+)px; --lapse: &#x27;\+ ([^&]+)&#x27;", page.replace("'", "&#x27;")))
    assert gaps == {"146": "6:40", "18": "10 s", "150": "6:50"}
    assert "<small>14:20</small>" in page


# --- the steps of a race --------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def race():
    """A stale-observation race, as a trace."""
    mission = load_mission(ROOT / "tests" / "corpus" / "violated" / "stale_message.mission")
    found = check(mission.initial, mission.properties).verdicts["race_freedom"].violations
    return found[0].trace


def test_the_three_steps_of_a_race_carry_their_words_and_the_head_leads_to_them(race):
    page = Reader(trace_page(Story("race", "", True, race)))
    words = [words["class"] for tag, words in page.elements if tag == "strong"]
    assert words == ["role"] * 3
    assert [each for each in page.texts if each in ("sensed", "changed", "acted")] == [
        "sensed", "changed", "acted",  # the head
        "sensed", "changed", "acted",  # the rows
    ]  # fmt: skip
    linked = [words["href"] for tag, words in page.elements if tag == "a"]
    assert linked[:3] == [f"#c{number}" for number in race.race]
    captions = [
        words["data-label"] for tag, words in page.elements if "data-label" in words
    ]  # without scripts
    roles = [each.rpartition(" ")[2] for each in captions if each.endswith("]")]
    assert roles == ["[sensed]", "[changed]", "[acted]"]
    assert any(each.startswith("c3: ") and each.endswith(" [sensed]") for each in page.texts)
    other = trace_page(Story("none", "", True, replace(race, race=None)))
    assert not any(words in other for words in ('class="role"', "the race:"))
