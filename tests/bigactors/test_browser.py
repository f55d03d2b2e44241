"""Pages in a browser, with chromium and playwright where both are there."""

import shutil

import pytest
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

PHONE, DESK = {"width": 390, "height": 844}, {"width": 1280, "height": 800}


@pytest.fixture(scope="module")
def browser():
    playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
    chromium = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if chromium is None:
        pytest.skip("there is no chromium")
    with playwright.sync_playwright() as started:
        found = started.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
        yield found
        found.close()


@pytest.fixture
def opened(browser, tmp_path):
    """Open pages; at the end, none may have had an error."""
    errors, pages = [], []

    def open_page(text, size, **options):
        (tmp_path / "page.html").write_text(text, encoding="utf-8")
        page = browser.new_page(viewport=size, **options)
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.on("console", lambda message: errors.append(message.text) if message.type == "error" else None)
        page.goto(f"file://{tmp_path}/page.html")
        pages.append(page)
        return page

    yield open_page
    for page in pages:
        page.close()
    assert errors == []


def overflow(page):
    return page.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth")


# --- a trace --------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def trace():
    configurations, labels = run(oil_spill())
    steps = (Step(label, 0, target) for label, target in zip(labels, configurations[1:], strict=True))
    return Trace(configurations[0], tuple(steps))


def test_the_tab_key_finds_play_and_the_arrows_step(opened, trace):
    page = opened(trace_page(Story("t", "", False, trace)), DESK)
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.id") == "play"
    page.keyboard.press("ArrowRight")
    assert page.inner_text("#number") == f"c1 of c{len(trace)}"
    assert page.get_attribute("tr[aria-current=step]", "data-row") == "1"
    page.keyboard.press("End")
    assert page.inner_text("#number") == f"c{len(trace)} of c{len(trace)}"


def test_the_search_goes_from_one_step_that_says_so_to_the_next(opened, trace):
    page = opened(trace_page(Story("t", "", False, trace)), DESK)
    wanted = [n for n, step in enumerate(trace.steps, 1) if step.label.rule == "req_obs"]
    page.keyboard.press("/")
    page.keyboard.type("REQ_OBS")
    assert page.inner_text("#found") == f"{len(wanted)} found"
    page.keyboard.press("Enter")
    assert page.inner_text("#number") == f"c{wanted[0]} of c{len(trace)}"
    assert page.inner_text("#found") == f"1 of {len(wanted)}"


def test_what_is_folded_is_unfolded_by_a_click(opened):
    names = [f"uav{n}" for n in range(36)]
    setting = Setting(SIGNATURE, {"searchArea0": "Location"} | dict.fromkeys(names, "UAV"), Program())
    there = dict.fromkeys(names, Placed(point(37.0, -8.7)))
    c = initial(setting, {"searchArea0": PLACEMENTS["searchArea0"]} | there, {}, {})
    page = opened(trace_page(Story("t", "", False, Trace(c))), DESK)
    for model in ("L", "P"):
        page.click(f'[data-picture^="{model}"] [data-names] text')
        assert page.inner_text("#names") == f"UAV ×36: {', '.join(names)}"
        page.click(".caption")


@pytest.fixture(scope="module")
def rounds():
    """A flight of a thousand observations, a step each half second."""
    flight = observing(1_000)
    return Story("t", "", False, flight, times=tuple(n / 2 for n in range(len(flight))))


@pytest.mark.parametrize("size", [DESK, PHONE], ids=["desk", "phone"])
def test_each_step_of_a_loop_is_reached_folded_and_unfolded(opened, rounds, size):
    page, last = opened(trace_page(rounds), size), len(rounds.trace)
    fold = page.locator("tr[data-from]").first
    begin, end = (int(fold.get_attribute(f"data-{name}")) for name in ("from", "to"))
    page.evaluate(f"location.hash = '#c{begin + 500}'")
    label = str(rounds.trace.steps[begin + 499].label)
    page.wait_for_function("document.querySelector('#number').textContent.includes(' s')")
    assert page.inner_text("#caption") == label
    assert page.inner_text("#number") == f"c{begin + 500} of c{last} · {(begin + 499) / 2:.1f} s"
    assert fold.get_attribute("aria-current") == "step"
    assert page.locator("tr.unfolded").count() == 0
    fold.locator("button").click()
    assert page.locator("tr.unfolded[data-row]").count() == 200
    assert page.get_attribute("tr[aria-current]", "data-row") == str(begin + 500)
    assert rounds.trace.steps[begin + 499].label.rule in page.inner_text("tr[aria-current] .step")
    page.locator("tr.more button").last.click()
    assert page.inner_text("#number").startswith(f"c{begin + 600} of")
    fold.locator("button").click()
    assert page.locator("tr.unfolded").count() == 0
    page.locator(".caption").click()
    page.keyboard.press("j")
    assert page.inner_text("#number").startswith(f"c{min(end + 1, last)} of")
    assert overflow(page) == 0


def test_the_search_finds_steps_in_a_fold(opened, rounds):
    page = opened(trace_page(rounds), DESK)
    page.fill("#find", "c1234")
    page.press("#find", "Enter")
    assert page.inner_text("#number").startswith("c1234 of")
    page.fill("#find", "rcv_obs")
    assert page.inner_text("#found") == "1000 found"


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_a_phone_shows_a_trace_without_moving_the_page_sideways(opened, trace, scheme):
    page = opened(trace_page(Story("t", "", False, trace)), PHONE, color_scheme=scheme)
    assert overflow(page) == 0
    paper = page.evaluate("getComputedStyle(document.querySelector('section')).backgroundColor")
    assert paper == {"light": "rgb(255, 255, 255)", "dark": "rgb(28, 33, 40)"}[scheme]


# --- a system of bigraphs -------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def switches():
    """The page of ten switches: a thousand states."""
    start = " | ".join(f"On{{s{number}}}" for number in range(10))
    text = (
        f"atomic ctrl On = 1; atomic ctrl Off = 1; big start = {start};\n"
        "react off = On{x} --> Off{x}; react on = Off{x} --> On{x};\n"
        "begin brs init start; rules = [ {off, on} ]; end"
    )
    return to_html(explore(read_system(text)), "switches")


@pytest.mark.parametrize("size", [DESK, PHONE], ids=["desk", "phone"])
def test_the_first_state_is_in_view_and_can_be_read(opened, switches, size):
    page = opened(switches, size)
    pane, state = (page.locator(each).bounding_box() for each in ("#graph", '[data-state="0"] circle'))
    assert pane["x"] < state["x"] < pane["x"] + pane["width"] - state["width"]
    assert pane["y"] < state["y"] < pane["y"] + pane["height"] - state["height"]
    assert state["width"] > 14
    assert overflow(page) == 0


def test_a_click_on_a_state_shows_its_bigraph_and_a_way_to_it(opened, switches):
    page = opened(switches, DESK)
    page.click("#whole")
    page.fill("#find", "200")
    page.press("#find", "Enter")
    assert page.inner_text("#name") == "state 200"
    assert page.locator("#picture .node").count() == 10
    assert page.locator("#picture svg path").count() == 10
    page.click("#path button >> nth=0")
    assert page.inner_text("#name") == "state 0"
    page.click('[data-state="5"] circle')
    assert page.inner_text("#name") == "state 5"
    assert page.inner_text("#moves").count("→") == 10


def test_the_wheel_makes_the_states_larger(opened, switches):
    page = opened(switches, DESK)
    before = page.locator('[data-state="0"] circle').bounding_box()["width"]
    page.locator('[data-state="0"]').hover()
    page.mouse.wheel(0, -300)
    assert page.locator('[data-state="0"] circle').bounding_box()["width"] > 1.5 * before
