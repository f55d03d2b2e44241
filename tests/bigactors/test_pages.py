"""Pages: one file that needs nothing else, whatever names and messages a mission has."""

import base64
import hashlib
import json
import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import pytest
from drawn_missions import CHANNELS, KINDS, PLACEMENTS, SIGNATURE, observing, oil_spill, run

from bigactors.pages import Story, page_of, scripts, telling, trace_page
from bigactors.pictures import Panels
from checker import Step, Trace, check
from checker.reports.causes import causes_of
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
    "html",
    "head",
    "meta",
    "title",
    "style",
    "body",
    "header",
    "h1",
    "p",
    "main",
    "footer",
    "div",
    "script",
    "a",
}


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


def data_of(page):
    """Return the data of a page's script."""
    return json.loads(
        re.search(r'<script type="application/json" id="run">(.*?)</script>', page, re.DOTALL)[1]
    )


def trace_of(configuration):
    configurations, labels = run(configuration)
    steps = (Step(label, 0, target) for label, target in zip(labels, configurations[1:], strict=True))
    return Trace(configurations[0], tuple(steps))


@pytest.fixture(scope="module")
def trace():
    return trace_of(oil_spill())


@pytest.fixture(scope="module")
def page(trace):
    return trace_page(Story("oil spill", "found: a witness", False, trace, notes=("digest",)))


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


def test_a_page_has_every_step_and_the_look_of_every_configuration(page, trace):
    data = data_of(page)
    assert [data["deeds"][deed]["label"] for deed in data["steps"]] == [
        str(step.label) for step in trace.steps
    ]
    assert len(data["order"]) == len(trace) + 1
    assert {number for look in data["looks"] for number in look["pictures"]} == set(
        range(len(data["pictures"]))
    )
    assert all(each.startswith("<svg ") for each in data["pictures"])


def test_what_looks_alike_is_drawn_once(page, trace):
    assert 4 <= len(data_of(page)["pictures"]) < 3 * (len(trace) + 1)


def test_where_few_are_to_be_drawn_the_last_ones_are(trace):
    told = telling(Story("t", "", False, trace, drawn=1))
    looks = [told.data["looks"][place] for place in told.data["order"]]
    assert None not in looks[-1]["pictures"]
    assert len({look["pictures"][0] for look in looks} - {None}) == 1
    undrawn = sum(None in look["pictures"] for look in looks)
    words = (
        f"not drawn: {undrawn} of {len(trace) + 1} configurations: "
        "a page made by `show` with --step K has those around c_K"
    )
    assert told.left_out == (words,)
    begun = telling(Story("t", "", False, trace, start=5, drawn=1)).data  # in the middle
    assert None not in begun["looks"][begun["order"][5]]["pictures"]


# --- steps that repeat ------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def looping():
    return observing(12)


def test_steps_that_only_repeat_others_are_folded_and_each_is_in_the_page(looping):
    times = tuple(100.0 + 0.5 * number for number in range(len(looping)))
    told = telling(Story("t", "", False, looping, times=times))
    ((_, last, about),) = told.data["folds"]
    assert last == len(looping) == len(told.data["order"]) - 1
    assert about.startswith("again ")
    assert len(told.data["looks"]) < 12
    assert None not in told.data["order"]
    assert told.left_out == ()
    assert told.data["moments"][-1] == 500 * (len(looping) - 1)
    assert telling(Story("t", "", False, looping, unfolded=True)).data["folds"] == []


def test_of_a_trace_that_no_page_can_hold_the_ends_and_what_is_around_the_start_are_shown(trace, monkeypatch):
    monkeypatch.setattr("bigactors.pages.story.MOST_FRAMES", 4)
    told = telling(Story("t", "", False, trace, start=3))
    held = [number for number, place in enumerate(told.data["order"]) if place is not None]
    assert {0, 3, len(trace)} < set(held)
    assert len(held) == 4
    assert f"left out: {len(trace) - 3} of {len(trace) + 1} configurations" in "".join(
        Reader(page_of(told)).texts
    )


def test_a_run_that_repeats_leads_back(trace):
    data = data_of(trace_page(Story("t", "", False, replace(trace, loop=2), drawn=1)))
    assert (data["loop"], data["end"]) == (2, f"↻ c{len(trace)} is c2: from there on again and again")


def test_a_trace_without_steps_is_a_page(trace):
    data = data_of(trace_page(Story("t", "", False, Trace(trace.initial))))
    assert (data["steps"], data["order"]) == ([], [0])


def test_all_maps_of_a_run_have_one_view(trace):
    panels = Panels.of(trace.configurations, 100)
    grids = {
        tuple(re.findall(r">([\d.]+°[NSEW])<", panels.physical(c, None).shapes)) for c in trace.configurations
    }
    assert len(grids) == 1


def test_the_same_trace_gives_the_same_small_page(trace, page):
    assert trace_page(Story("oil spill", "found: a witness", False, trace, notes=("digest",))) == page
    assert len(page.encode()) < 120_000 + 30_000 * (len(trace) + 1)
    assert len(trace_page(Story("t", "", False, observing(5_000))).encode()) < 800_000


# --- that it is safe and self-contained -----------------------------------------------------------------------


@pytest.fixture(scope="module", params=["plain", "hostile"])
def any_page(request, page):
    if request.param == "plain":
        return page
    return trace_page(Story(HOSTILE, HOSTILE, True, hostile_trace(), notes=(HOSTILE,)))


def test_nothing_is_loaded_from_anywhere(any_page):
    read = Reader(any_page)
    for tag, attributes in read.elements:
        assert tag in WRITTEN | DRAWN
        assert not {"src", "srcset", "action", "formaction", "data", "poster", "background"} & set(attributes)
        assert not [name for name in attributes if name.startswith("on") or name == "xlink:href"]
        assert attributes.get("href", "#").startswith("#")
        assert "url(" not in attributes.get("style", "")
    styles = any_page[any_page.index("<style>") : any_page.index("</style>")]
    assert "url(" not in styles
    assert "@import" not in styles


def test_the_only_code_is_ours_and_the_policy_names_its_digest(any_page):
    code = scripts.script()
    assert any_page.count("<script") == 2  # the data of the run, and the code
    assert f"<script>{code}</script>" in any_page
    digest = base64.b64encode(hashlib.sha256(code.encode()).digest()).decode()
    (policy,) = Reader(any_page).all("meta", http_equiv="Content-Security-Policy")
    assert policy["content"].startswith("default-src 'none'; ")
    assert f"script-src 'sha256-{digest}'" in policy["content"]
    assert "The MIT License" in code
    assert "Apache License" in code


def test_hostile_names_are_text(any_page):
    read = Reader(any_page)
    assert read.all("img") == []
    assert not any(sign in any_page for sign in ("\x00", "\x1b", "\ud800"))


def test_hostile_names_are_shown_as_they_are():
    page = trace_page(Story(HOSTILE, "", False, hostile_trace()))
    assert "".join(Reader(page).texts).count(HOSTILE) >= 3
    assert json.dumps(data_of(page), ensure_ascii=False).count(json.dumps(HOSTILE)[1:-1]) >= 6


def test_in_a_clone_without_the_parts_of_npm_the_page_has_its_story_and_its_lanes(race, monkeypatch):
    monkeypatch.setattr("bigactors.pages.story.script", lambda: "")
    page = trace_page(Story("race", "", True, race, len(race), causes_of(race)))
    assert page.count("<script") == 1
    texts = " ".join(Reader(page).texts)
    assert all(
        words in texts for words in ("acts on what lookout saw", "sensed", "changed", "acted", "req_ctr")
    )


# --- the steps of a race --------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def race():
    """A stale-observation race, as a trace."""
    mission = load_mission(ROOT / "tests" / "corpus" / "violated" / "stale_message.mission")
    found = check(mission.initial, mission.properties).verdicts["race_freedom"].violations
    return found[0].trace


def test_the_three_steps_of_a_race_carry_their_words(race):
    data = data_of(trace_page(Story("race", "", True, race, causes=causes_of(race))))
    assert data["roles"] == {str(number): role for number, role in race.race.roles.items()}
    assert [each["step"] for each in data["causes"]] == list(race.race)
