"""Pages in a browser, with chromium and playwright where both are there: who reads them, as stories."""

import json
import re
from io import BytesIO
from itertools import product

import pytest
from browsers import DESK, PHONE, TABLET, Watch, chromium, faults, overflow, says, spilled, until
from drawn_missions import observing, oil_spill, run
from PIL import Image, ImageStat

from bigactors.checking import Checked
from bigactors.mission_lookup import digest_of
from bigactors.pages import Story, trace_page
from bigactors.trace_files import evidence_of, story_of, write_evidence
from bigraphs.exploration import explore
from bigraphs.exports import to_html
from bigraphs.notation import read_system
from checker import Step, Trace, check, replay
from specs.elaboration import load_mission


@pytest.fixture(scope="module")
def browser():
    with chromium() as found:
        yield found


@pytest.fixture
def opened(browser, tmp_path):
    """Open a page; at the end, it may have had no error, and have asked for nothing else."""
    watch, pages = Watch(), []

    def open_page(text):
        (tmp_path / "page.html").write_text(text, encoding="utf-8")
        page = watch.over(browser.new_page(viewport=DESK), f"file://{tmp_path}/page.html")
        page.goto(f"file://{tmp_path}/page.html")
        pages.append(page)
        return page

    yield open_page
    for page in pages:
        page.close()
    watch.saw_nothing()


# --- a trace --------------------------------------------------------------------------------------------------


def violation(name, prop):
    """Return the page of a violation of a shipped mission, as `check --trace` writes it."""
    mission = load_mission(name)
    checked = Checked(name, mission, digest_of(mission), check(mission), False)
    return trace_page(next(story_of(checked, each) for each in evidence_of(checked) if each.property == prop))


SIZES = """() => [...document.querySelectorAll('.stage .frame')].flatMap((frame) => [...frame.querySelectorAll('text')]
  .map((text) => parseFloat(getComputedStyle(text).fontSize) * text.getScreenCTM().d))"""
"""The heights in pixels of all lettering of the map and of the bigraph."""

SPILLED = """() => [...document.querySelectorAll('.lanes-pane .step')].filter((box) => {
  const [inner, lane] = [box.getBoundingClientRect(), box.closest('td').getBoundingClientRect()];
  return inner.left < lane.left - 1 || inner.right > lane.right + 1 || box.scrollWidth > box.clientWidth + 1;
}).length"""
"""The number of boxes that are not within their lanes."""


def test_a_reader_learns_who_did_what_and_when_from_the_page_of_a_race(opened):
    page = opened(violation("look_before_entry_racy", "race_freedom"))
    about = "race_freedom is violated: a command rests on an observation that is no longer true"
    says(page, "header", re.compile(f"look_before_entry_racy.*{about}"))
    says(page, ".controls output", "step 12 of 12")
    told = page.locator(".story a").all_inner_texts()
    assert [each.strip() for each in told] == [
        "b on uav1 looks into gate0, and sees nobody at step 7",
        "uav0 moves from north0 to gate0, as a wants at step 8",
        "b acts on what it saw: uav1 moves from south0 to gate0 at step 12",
    ]
    assert page.locator(".lanes-pane tr.guilty .role").all_inner_texts() == ["sensed", "changed", "acted"]
    page.locator(".story a").first.click()
    says(page, ".controls output", "step 7 of 12")
    assert page.locator(".stage.guilty").count() == 1
    page.keyboard.press("ArrowLeft")
    says(page, ".controls output", "step 6 of 12")
    assert page.locator(".stage.guilty").count() == 0
    says(page, "footer", re.compile(r".*CTR\(b, MOVE_HOST_TO gate0\) depends on .*sha256:[0-9a-f]{64}.*"))


@pytest.mark.parametrize(
    ("name", "prop"), [("broken_endurance", "endurance"), ("broken_deadlock", "deadlock_freedom")]
)
def test_lettering_is_large_enough_boxes_stay_in_their_lanes_and_dark_pictures_are_dark(opened, name, prop):
    page = opened(violation(name, prop))
    for scheme, size in (("light", DESK), ("dark", DESK), ("dark", PHONE)):
        page.emulate_media(color_scheme=scheme)
        page.set_viewport_size(size)
        page.reload()
        page.wait_for_selector(".stage .frame text")
        assert min(page.evaluate(SIZES)) >= 7.9
        assert page.evaluate(SPILLED) == 0
        assert overflow(page) == 0
        for place in range(2):
            picture = Image.open(BytesIO(page.locator(".stage .frame").nth(place).screenshot())).convert("L")
            assert (ImageStat.Stat(picture).mean[0] < 80) == (scheme == "dark")


SEEN = """() => [...document.querySelectorAll('.stage .frame')].map((frame) => {
  const outer = frame.getBoundingClientRect();
  return [...frame.querySelectorAll('text')].every((text) => {
    const { left, right, top, bottom } = text.getBoundingClientRect();
    return left >= outer.left - 1 && right <= outer.right + 1 && top >= outer.top - 1 && bottom <= outer.bottom + 1;
  });
})"""
"""Whether all texts of the map, and of the bigraph, are within their frames."""


def test_pictures_are_whole_on_a_tablet_and_a_phone_says_where_only_a_part_is_shown(opened):
    page = opened(violation("look_before_entry_racy", "race_freedom"))
    for size, wholes in ((DESK, [True, True]), (TABLET, [True, True]), (PHONE, [False, True])):
        page.set_viewport_size(size)
        page.reload()
        page.wait_for_selector(".stage .frame text")
        assert page.evaluate(SEEN) == wholes
        assert page.locator(".stage .part").count() == wholes.count(False)
    for _ in range(3):
        page.locator(".stage button", has_text="−").first.click()
    until(page, "document.querySelectorAll('.stage .part').length === 0")
    assert page.evaluate(SEEN) == [True, True]


def test_the_page_of_a_run_with_dates_has_gaps_where_time_passes(opened):
    page = opened(violation("broken_endurance", "endurance"))
    gaps = page.evaluate(
        "Object.fromEntries([...document.querySelectorAll('tr.later th')].map((th) => "
        "[th.dataset.lapse, parseInt(getComputedStyle(th).getPropertyValue('--gap'))]))"
    )
    assert gaps == {"+ 6.7 min": 117, "+ 10 s": 18, "+ 6.8 min": 120}


def test_a_trace_is_stepped_through_searched_and_read_on_a_phone(opened):
    configurations, labels = run(oil_spill())
    steps = (Step(label, 0, target) for label, target in zip(labels, configurations[1:], strict=True))
    trace = Trace(configurations[0], tuple(steps))
    page = opened(trace_page(Story("t", "", False, trace)))
    wanted = [n for n, step in enumerate(trace.steps, 1) if step.label.rule == "req_obs"]
    page.fill("input[type=search]", "REQ_OBS")
    says(page, ".lanes-pane output", f"{len(wanted)} found")
    page.press("input[type=search]", "Enter")
    says(page, ".controls output", f"step {wanted[0]} of {len(trace)}")
    page.evaluate("document.activeElement.blur()")
    page.keyboard.press("Home")
    page.keyboard.press("ArrowRight")
    says(page, ".controls output", f"step 1 of {len(trace)}")
    assert page.get_attribute("tr[aria-current=step]", "data-step") == "1"
    page.keyboard.press("End")
    says(page, ".controls output", f"step {len(trace)} of {len(trace)}")


def test_each_step_of_a_loop_is_reached_folded_and_unfolded_on_desk_and_phone(opened):
    flight = observing(1_000)  # a step each half second
    page = opened(trace_page(Story("t", "", False, flight, times=tuple(n / 2 for n in range(len(flight))))))
    for size in (DESK, PHONE):
        page.set_viewport_size(size)
        page.evaluate("location.hash = '#c1234'")
        says(page, ".controls output", f"step 1234 of {len(flight)} · 616.5 s")
        fold = page.locator("tr[aria-current=step] button[aria-expanded]")
        fold.click()
        assert page.get_attribute("tr[aria-current=step]", "data-step") == "1234"
        assert flight.steps[1233].label.rule in page.inner_text("tr[aria-current] .step")
        assert page.locator(".lanes-pane tr").count() < 450
        page.evaluate("location.hash = '#c20'")
        page.locator("button[aria-expanded=true]").click()
        assert page.locator(".lanes-pane tr").count() < 40
        assert overflow(page) == 0


READ = {
    "look_before_entry_racy": ("race_freedom-stale-observation_race", [("b", 7), ("a", 8), ("b", 12)]),
    "broken_corridor": ("never_over_the_prison-invariant", [("south", 5)]),
    "broken_deadlock": (
        "deadlock_freedom-deadlock",
        [("corridor", 7), ("first", 11), ("pad", 18), ("second", 22)],
    ),
    "broken_endurance": ("endurance-exhausted", [("patrol", 17)]),
}
"""The folder of a violation's trace, and who is to blame at which steps, as the page alone says it."""


@pytest.mark.parametrize("name", READ)
def test_who_did_what_and_when_is_read_from_the_page_alone_as_the_trace_has_it(opened, tmp_path, name):
    folder, blamed = READ[name]
    mission = load_mission(name)
    write_evidence(Checked(name, mission, digest_of(mission), check(mission), False), tmp_path)
    page = opened((tmp_path / folder / "trace.html").read_text(encoding="utf-8"))
    for scheme, size in product(("light", "dark"), (TABLET, PHONE, DESK)):
        page.emulate_media(color_scheme=scheme)
        page.set_viewport_size(size)
        assert (spilled(page), overflow(page), faults(page)) == ([], 0, []), (scheme, size)
    told = [each.strip() for each in page.locator(".story li").all_inner_texts()]
    read = [
        found.groups()
        for found in (re.fullmatch(r"(.*) at step (\d+)(?: · (.*))?", each) for each in told)
        if found
    ]
    trace = replay(
        mission.initial, json.loads((tmp_path / folder / "trace.json").read_text(encoding="utf-8"))
    )
    assert [int(step) for _, step, _ in read] == [step for _, step in blamed]
    for (words, _, date), (who, step) in zip(read, blamed, strict=True):
        assert trace.steps[step - 1].label.agent == who
        assert re.search(rf"\b{who}\b", words)
        assert date == (trace.date(step - 1) if trace.dates else None)


def test_without_scripts_the_page_has_its_story_and_its_lanes(browser, tmp_path):
    (tmp_path / "page.html").write_text(violation("look_before_entry_racy", "race_freedom"), encoding="utf-8")
    context = browser.new_context(java_script_enabled=False)
    page = context.new_page()
    page.goto(f"file://{tmp_path}/page.html")
    says(page, ".story", re.compile(".*looks into gate0, and sees nobody at step 7 · .*at step 12"))
    assert page.locator("main > div > svg").count() == 4
    context.close()


# --- a system of bigraphs -------------------------------------------------------------------------------------


def switches():
    """Return the page of ten switches: a thousand states."""
    start = " | ".join(f"On{{s{number}}}" for number in range(10))
    text = (
        f"atomic ctrl On = 1; atomic ctrl Off = 1; big start = {start};\n"
        "react off = On{x} --> Off{x}; react on = Off{x} --> On{x};\n"
        "begin brs init start; rules = [ {off, on} ]; end"
    )
    return to_html(explore(read_system(text)), "switches")


def test_states_are_seen_enlarged_and_followed_on_desk_and_phone(opened):
    page = opened(switches())
    sees_the_first_state_and_can_read_it(page)
    page.set_viewport_size(PHONE)
    page.reload()
    sees_the_first_state_and_can_read_it(page)
    page.set_viewport_size(DESK)
    page.reload()
    enlarges_by_the_wheel(page)
    goes_to_a_state_and_along_a_way_to_it(page)


FIRST = '[data-state="0"] circle'


def sees_the_first_state_and_can_read_it(page):
    pane, state = (page.locator(each).bounding_box() for each in ("#graph", FIRST))
    assert pane["x"] < state["x"] < pane["x"] + pane["width"] - state["width"]
    assert pane["y"] < state["y"] < pane["y"] + pane["height"] - state["height"]
    assert state["width"] > 14
    assert overflow(page) == 0


def enlarges_by_the_wheel(page):
    before = page.locator(FIRST).bounding_box()["width"]
    page.locator('[data-state="0"]').hover()
    page.mouse.wheel(0, -300)
    width = f"document.querySelector({FIRST!r}).getBoundingClientRect().width"
    until(page, f"before => {width} > 1.5 * before", before)


def goes_to_a_state_and_along_a_way_to_it(page):
    page.click("#whole")
    page.fill("#find", "200")
    page.press("#find", "Enter")
    says(page, "#name", "state 200")
    assert page.locator("#picture .node").count() == 10
    assert page.locator("#picture svg path").count() == 10
    page.click("#path button >> nth=0")
    says(page, "#name", "state 0")
    page.click('[data-state="5"] circle')
    says(page, "#name", "state 5")
    assert page.inner_text("#moves").count("→") == 10
