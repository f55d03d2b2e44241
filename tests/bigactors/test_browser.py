"""Pages in a browser, with chromium and playwright where both are there: who reads them, as stories."""

import re

import pytest
from browsers import DESK, PHONE, Watch, chromium, overflow, says
from drawn_missions import PLACEMENTS, SIGNATURE, observing, oil_spill, run

from bigactors.pages import Story, trace_page
from bigraphs.exploration import explore
from bigraphs.exports import to_html
from bigraphs.notation import read_system
from checker import Step, Trace
from physical import point
from semantics.behaviours.program import Program
from semantics.state.initial import initial
from semantics.state.physical_model import Placed
from semantics.state.setting import Setting


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


def test_a_trace_is_stepped_through_searched_and_read_on_a_phone(opened):
    configurations, labels = run(oil_spill())
    steps = (Step(label, 0, target) for label, target in zip(labels, configurations[1:], strict=True))
    trace = Trace(configurations[0], tuple(steps))
    page = opened(trace_page(Story("t", "", False, trace)))
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.id") == "play"
    goes_from_one_step_that_says_so_to_the_next(page, trace)
    steps_by_the_arrows(page, trace)
    page.set_viewport_size(PHONE)
    for scheme, colour in (("light", "rgb(255, 255, 255)"), ("dark", "rgb(28, 33, 40)")):
        page.emulate_media(color_scheme=scheme)
        paper = page.evaluate("getComputedStyle(document.querySelector('section')).backgroundColor")
        assert (overflow(page), paper) == (0, colour)


def goes_from_one_step_that_says_so_to_the_next(page, trace):
    wanted = [n for n, step in enumerate(trace.steps, 1) if step.label.rule == "req_obs"]
    page.keyboard.press("/")
    page.keyboard.type("REQ_OBS")
    says(page, "#found", f"{len(wanted)} found")
    page.keyboard.press("Enter")
    says(page, "#number", f"c{wanted[0]} of c{len(trace)}")
    says(page, "#found", f"1 of {len(wanted)}")


def steps_by_the_arrows(page, trace):
    page.evaluate("document.activeElement.blur()")
    page.keyboard.press("Home")
    page.keyboard.press("ArrowRight")
    says(page, "#number", f"c1 of c{len(trace)}")
    assert page.get_attribute("tr[aria-current=step]", "data-row") == "1"
    page.keyboard.press("End")
    says(page, "#number", f"c{len(trace)} of c{len(trace)}")


def test_what_is_folded_is_unfolded_by_a_click(opened):
    names = [f"uav{n}" for n in range(36)]
    setting = Setting(SIGNATURE, {"searchArea0": "Location"} | dict.fromkeys(names, "UAV"), Program())
    there = dict.fromkeys(names, Placed(point(37.0, -8.7)))
    c = initial(setting, {"searchArea0": PLACEMENTS["searchArea0"]} | there, {}, {})
    page = opened(trace_page(Story("t", "", False, Trace(c))))
    for model in ("L", "P"):
        page.click(f'[data-picture^="{model}"] [data-names] text')
        says(page, "#names", f"UAV ×36: {', '.join(names)}")
        page.click(".caption")


def test_each_step_of_a_loop_is_reached_folded_and_unfolded_on_desk_and_phone(opened):
    flight = observing(1_000)  # a step each half second
    page = opened(trace_page(Story("t", "", False, flight, times=tuple(n / 2 for n in range(len(flight))))))
    for size in (DESK, PHONE):
        page.set_viewport_size(size)
        fold = page.locator("tr[data-from]").first
        begin, end = (int(fold.get_attribute(f"data-{name}")) for name in ("from", "to"))
        goes_to_a_step_in_the_fold(page, flight, fold, begin)
        unfolds_it_and_folds_it_again(page, flight, fold, begin)
        page.locator(".caption").click()
        page.keyboard.press("j")
        says(page, "#number", re.compile(f"^c{min(end + 1, len(flight))} of"))
        assert overflow(page) == 0
    finds_steps_in_the_fold(page)


def goes_to_a_step_in_the_fold(page, flight, fold, begin):
    page.evaluate(f"location.hash = '#c{begin + 500}'")
    says(page, "#number", f"c{begin + 500} of c{len(flight)} · {(begin + 499) / 2:.1f} s")
    says(page, "#caption", str(flight.steps[begin + 499].label))
    assert fold.get_attribute("aria-current") == "step"
    assert page.locator("tr.unfolded").count() == 0


def unfolds_it_and_folds_it_again(page, flight, fold, begin):
    fold.locator("button").click()
    assert page.locator("tr.unfolded[data-row]").count() == 200
    assert page.get_attribute("tr[aria-current]", "data-row") == str(begin + 500)
    assert flight.steps[begin + 499].label.rule in page.inner_text("tr[aria-current] .step")
    page.locator("tr.more button").last.click()
    says(page, "#number", re.compile(f"^c{begin + 600} of"))
    fold.locator("button").click()
    assert page.locator("tr.unfolded").count() == 0


def finds_steps_in_the_fold(page):
    page.fill("#find", "c1234")
    page.press("#find", "Enter")
    says(page, "#number", re.compile("^c1234 of"))
    page.fill("#find", "rcv_obs")
    says(page, "#found", "1000 found")


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
    page.wait_for_function(f"before => {width} > 1.5 * before", arg=before)


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
