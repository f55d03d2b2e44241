"""The page in use, as stories: by keys, in the past, under a hand, on a phone, in the dark, with hostile names."""

import re
import time

import pytest
from browsers import DESK, PHONE, overflow
from page_driving import HOLD, by_mouse
from page_harness import card, crowd, world

# --- without a mouse


def test_everything_is_done_by_keys(operates):
    ana = operates()
    reaches_all_that_acts_by_tab(ana)
    reads_the_keys_in_the_help_and_chooses_units_there(ana)
    opens_and_closes_the_help_between_two_keys(ana)
    chooses_vehicles_as_they_are_shown(ana)


def reaches_all_that_acts_by_tab(ana):
    label = "e => (e.getAttribute('aria-label') || e.textContent).trim()"
    wanted = ana.page.locator("button:visible:enabled").evaluate_all(
        f"all => all.filter((e) => e.tabIndex >= 0).map({label})"
    )
    reached = set()
    for _ in range(80):
        ana.presses("Tab")
        reached.add(ana.focused(label))
        if reached >= set(wanted):
            break
    assert set(wanted) <= reached


def reads_the_keys_in_the_help_and_chooses_units_there(ana):
    ana.opens("uav0")
    ana.sees(".card[data-name=uav0]", "10.1 kn · 119 m above home")
    ana.presses("?")
    ana.sees("dialog[open]")
    listed = {each.upper() for each in ana.texts("dialog dt")}
    assert {"?", "ESC", "L", "SPACE", "[", "]", "J", "K", "F", "O", "R", "T"} <= listed
    ana.page.locator("dialog select").select_option("metric")
    ana.presses("Escape")
    ana.sees_no("dialog[open]")
    ana.sees(".card[data-name=uav0]", "5.2 m/s · 119 m above home")
    ana.sees(".map-position", "°N 8.7")


OPENS = """async () => {
  const press = (key) => document.activeElement.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
  press("?");
  await new Promise((done) => setTimeout(done));
  press("b");
  return document.querySelectorAll("dialog[open]").length;
}"""
CLOSES = """async () => {
  const dialog = document.querySelector("dialog[open]");
  const closed = new Promise((done) => dialog.addEventListener("close", done, { once: true }));
  dialog.close();
  const element = document.activeElement;
  element.dispatchEvent(new KeyboardEvent("keydown", { key: " ", bubbles: true }));
  await closed;
  return element.textContent;
}"""


def opens_and_closes_the_help_between_two_keys(ana):
    """A key that follows the one that opens it is no shortcut; one that follows its closing is."""
    ana.page.evaluate("document.activeElement.blur()")
    assert (ana.page.evaluate(OPENS), ana.asked()) == (1, [])
    assert ana.page.evaluate(CLOSES) == "Close"
    assert ana.asked() == [{"type": "pause"}]
    ana.presses("l")
    assert ana.asked() == [{"type": "live"}]


def chooses_vehicles_as_they_are_shown(ana):
    ana.presses("Escape")
    ana.sees_no(".card.chosen")  # as Tab has chosen one on the map
    ana.opens("uav1")
    ana.page.locator(".card[data-name=uav1] [aria-label^='Hold']").hover()
    ana.told(vehicles={"boat0": card(3, kind="USV", why="lost too")})
    ana.sees("[data-row=boat0]", "lost too")
    ana.presses("Escape", "j")
    ana.sees(".card[data-name=uav1]")
    ana.presses("j")
    ana.sees(".card[data-name=uav10]")


# --- the past


def test_an_operator_looks_at_the_past_and_comes_back_to_now(operates):
    state = world()
    begin = state["clock"]["begin"] = 1_800_000_000.0  # 08:00:00 UTC
    state["clock"] |= {"head": begin + 600, "now": begin + 600}
    ana = operates(state)
    goes_back_and_finds_the_way_to_now_where_orders_were(ana)
    goes_to_a_time_that_is_typed(ana)
    comes_to_now_just_after_the_slider_was_moved(ana)
    sees_all_clocks_follow_the_slider_and_moves_it_again_at_once(ana)
    chooses_a_speed_without_playing(ana)
    is_heard_in_order_before_an_answer_comes(ana)


def goes_back_and_finds_the_way_to_now_where_orders_were(ana):
    ana.opens("uav0")
    ana.presses("b")
    ana.sees(".screen.past")
    ana.sees_no(".held")
    ana.clicks(".card .now")
    ana.sees(HOLD)
    ana.sees_no(".screen.past")
    assert [each["type"] for each in ana.asked()] == ["seek", "live"]


def sought(ana):
    """Return the moments that were asked for, in seconds from the beginning."""
    return [each["time"] - 1_800_000_000.0 for each in ana.asked() if each["type"] == "seek"]


def goes_to_a_time_that_is_typed(ana):
    ana.presses("g", *"07:59", "Enter")
    ana.sees(".notice", "“07:59” is no time from 08:00:00 to 08:10:00 UTC")
    ana.page.locator("#goto").fill("08:03:20")
    ana.presses("Enter")
    ana.sees(".ends .shown", "08:03:20 UTC")
    ana.sees(".screen.past")
    ana.presses("b", "Shift+B")
    assert sought(ana) == pytest.approx([200, 190, 130], abs=0.01)


SLIDER = "input[type=range]"
MOVES = """to => { const e = document.querySelector("input[type=range]"); e.value = to;
  e.dispatchEvent(new Event("input", { bubbles: true })); }"""
RELEASES = "document.querySelector('input[type=range]').dispatchEvent(new Event('change'))"


def comes_to_now_just_after_the_slider_was_moved(ana):
    ana.page.locator(SLIDER).focus()
    key = "document.activeElement.dispatchEvent(new KeyboardEvent('keydown', { key: 'l', bubbles: true }))"
    ana.page.evaluate(f"() => {{ ({MOVES})(0); {key}; {RELEASES} }}")
    ana.waits(400)
    assert ana.asked() == [{"type": "live"}]


def sees_all_clocks_follow_the_slider_and_moves_it_again_at_once(ana):
    ana.harness.is_slow = True
    ana.page.evaluate(MOVES, 60)
    ana.sees(".ends .shown", "08:01:00 UTC")
    ana.sees(".clock .time", "08:01:00")
    ana.waits(100)
    ana.page.evaluate(RELEASES)
    ana.page.evaluate(MOVES, 200)
    ana.waits(500)
    assert float(ana.page.locator(SLIDER).input_value()) == 200
    assert sought(ana) == [60, 200]
    ana.page.evaluate(RELEASES)
    ana.waits(400)
    ana.harness.is_slow = False


def chooses_a_speed_without_playing(ana):
    ana.presses("l", "Space")
    ana.page.locator("#speed").select_option("5")
    ana.page.locator("#speed").blur()
    ana.presses("Space")
    assert ana.asked() == [{"type": "live"}, {"type": "pause"}, {"type": "play", "speed": 5}]


def is_heard_in_order_before_an_answer_comes(ana):
    ana.presses("l")
    ana.sees(".badge.live", "LIVE")
    ana.harness.is_slow = True
    ana.presses("Space", ",", "Space", ".")
    ana.sees_that("document.getElementById('speed').value === '5'")
    ana.presses("Space", "l", "Space")
    slow, fast = {"type": "play", "speed": 2}, {"type": "play", "speed": 5}
    live, pause = {"type": "live"}, {"type": "pause"}
    assert ana.asked() == [live, pause, slow, fast, pause, live, pause]


# --- under a hand


def test_a_button_stays_under_the_hand_whatever_happens_around_it(operates):
    ana = operates()
    keeps_a_button_pressed_while_others_get_worse(ana)
    keeps_the_pointer_over_a_button_while_all_above_grows_and_shrinks(ana)
    sees_a_hundred_vehicles_worst_first(ana)


def keeps_a_button_pressed_while_others_get_worse(ana):
    ana.opens("uav0")
    with by_mouse(ana.page, HOLD):
        before = ana.box(HOLD)
        ana.told(vehicles={"boat0": card(3, kind="USV", why="lost")})
        assert ana.box(HOLD)["y"] == before["y"]
    ana.page.mouse.move(10, 300)
    ana.sees(".fleet:first-child", "boat0")
    ana.told(vehicles={"boat0": card(kind="USV")})


STAYED = "([button, top]) => Math.abs(document.querySelector(button).getBoundingClientRect().top - top) <= 1"


def keeps_the_pointer_over_a_button_while_all_above_grows_and_shrinks(ana):
    button = ".card [aria-label^='Return boat0']"
    ana.opens("boat0")
    ana.page.locator(button).hover()
    before = ana.box(button)["y"]
    cards = ana.harness.state["vehicles"].copy()
    for name, why in (("uav1", "a long reason; " * 40), ("uav1", ""), ("uav10", ""), ("uav0", "")):
        ana.told(vehicles={name: cards[name] | {"why": why}, "boat0": card(3, kind="USV")})
        assert ana.count(f"[data-row={name}] b") == bool(why)
        ana.sees_that(STAYED, [button, before])
    ana.page.mouse.move(10, 300)
    ana.sees(".fleet:first-child", "boat0")


def sees_a_hundred_vehicles_worst_first(ana):
    gone = dict.fromkeys(ana.harness.state["vehicles"])
    many = crowd(100, 1_000)
    ana.told(vehicles=gone | many["vehicles"], entities=many["entities"])
    level = "all => all.map((e) => Number(e.className.match(/level-(.)/)[1]))"
    levels = ana.page.locator(".fleet").evaluate_all(level)
    assert (len(levels), levels) == (100, sorted(levels, reverse=True))
    assert re.search(r"\b100\b", ana.page.inner_text("#cards-title"))


# --- on a phone


def test_a_phone_shows_the_map_first_and_orders_what_is_chosen_there(operates):
    ana = operates(world() | {"vehicles": {"uav0": card()}}, size=PHONE, has_touch=True)
    orders_the_only_vehicle_from_the_map(ana)
    reads_of_a_lost_one_the_reason_above_its_orders(ana)
    reads_what_a_return_ends_above_the_button(ana)
    taps_the_map_which_leaves_no_tip_over_the_orders_of_another(ana)
    sees_a_tip_go_when_the_map_gets_another_size(ana)


def orders_the_only_vehicle_from_the_map(ana):
    assert ana.page.get_by_role("tab", selected=True).inner_text() == "Map"
    ana.sees(".subject [aria-label^='Hold uav0']")
    assert ana.page.get_by_role("button", name="Follow").is_enabled()
    assert ana.page.evaluate("document.documentElement.scrollHeight - innerHeight") == 0
    boxes = [each.bounding_box() for each in ana.page.locator(".top > *:visible, [role=tab]").all()]
    assert [box for box in boxes if box["x"] < 0 or box["x"] + box["width"] > PHONE["width"]] == []


def reads_of_a_lost_one_the_reason_above_its_orders(ana):
    ana.told(vehicles={"uav0": world()["vehicles"]["uav1"]})
    ana.sees(".subject", "when last heard: RTL · 119 m")
    ana.sees(".subject .why", "taken over by the fail-safe")
    assert ana.box(".subject .why")["y"] < ana.box(".subject .orders")["y"]


def reads_what_a_return_ends_above_the_button(ana):
    ends = "breaks an assumption of the mission: all vehicles are commanded to hold"
    ana.told(vehicles={"uav0": card(on_return=ends)})
    told = ana.page.locator(".on-return:visible")
    assert ends in told.inner_text()
    assert not told.evaluate("e => e.scrollHeight > e.clientHeight + 1")
    assert ends in ana.page.locator("[aria-label^='Return uav0']:visible").get_attribute("aria-label")


SEEN_AT = (
    "([x, y]) => document.querySelector('.map-canvas') && document.elementFromPoint(x, y)?.closest('#map')"
)


def taps_the_map_which_leaves_no_tip_over_the_orders_of_another(ana):
    ana.told(vehicles=world()["vehicles"])
    ana.sees_no(".subject")
    ana.sees_that(SEEN_AT, [195, 400])
    ana.page.touchscreen.tap(195, 400)
    ana.sees(".chosen-name")
    ana.presses("j")
    ana.sees(".subject")
    assert ana.page.locator(".map-tip").is_hidden()


def sees_a_tip_go_when_the_map_gets_another_size(ana):
    ana.presses("Escape")
    ana.sees_no(".subject")
    ana.page.mouse.move(190, 400)
    ana.page.mouse.move(195, 400)
    ana.sees(".map-tip")
    ana.presses("j")
    ana.sees(".subject")
    ana.page.locator(".map-tip").wait_for(state="hidden")


TABS = ["Map", "Vehicles", "Actions", "Bigraph", "Steps", "Agents", "Stations"]
WIDER = "all => all.filter((e) => e.scrollWidth > e.clientWidth + 1).map((e) => e.className)"


def test_a_phone_shows_each_tab_without_moving_sideways(operates):
    ana = operates(size=PHONE, has_touch=True)
    for tab in TABS:
        ana.page.get_by_role("tab", name=tab, exact=True).click()
        ana.sees("[role=tab][aria-selected=true]", tab)
        assert overflow(ana.page) == 0
        assert (
            ana.page.locator(
                ".cards .scroll, .panel, .fleet .name, .fleet .row > :has(.battery)"
            ).evaluate_all(WIDER)
            == []
        )
        assert (tab == "Vehicles") == (ana.count(".fleet .name") == 4)
        timeline = ana.box(".timeline")
        assert timeline["y"] + timeline["height"] <= PHONE["height"]


def test_a_small_desk_shows_a_fleet_of_fifty_without_moving_in_any_direction(operates):
    ana = operates(world() | crowd(54, 354), size={"width": 1024, "height": 768})
    ana.clicks(".fleet .name")
    ana.sees(".card.chosen")
    for script in ("scrollWidth - innerWidth", "scrollHeight - innerHeight"):
        assert ana.page.evaluate(f"document.documentElement.{script}") == 0
    boxes = [
        each.bounding_box() for each in ana.page.locator(".top > *:visible, .map-tools > *:visible").all()
    ]
    assert [box for box in boxes if box["x"] < 0 or box["x"] + box["width"] > 1024] == []
    assert ana.page.locator(".cards .scroll, .panel, aside").evaluate_all(WIDER) == []


def test_a_row_says_whole_how_a_vehicle_is_and_for_how_long_its_link_is_lost(operates):
    state = world()
    link = {"heard": time.time() - 3_000, "lost": True}
    state["vehicles"]["uav1"] |= {"link": link, "word": "taken over"}
    for size in (DESK, {"width": 1024, "height": 768}, PHONE):
        ana = operates(state, size=size)
        if size is PHONE:
            ana.clicks("#tab-vehicles")
        ana.sees("[data-row=uav1] .link", "link lost 50 min")
        assert ana.page.locator("[data-row=uav1] .row > :not(.rest)").evaluate_all(WIDER) == []


def test_the_start_panel_shows_why_a_vehicle_refuses_to_arm_on_a_small_desk(operates):
    item = {"what": "uav0 is heard", "done": True, "detail": "", "vehicle": "uav0"}
    item |= {"fence": "not on board: it is sent before the first flight"}
    refuses = ["PreArm: Compass not calibrated", "PreArm: Battery 1 unhealthy"]
    start = {"state": "ready", "by": "", "items": [item | {"refuses": refuses}]}
    ana = operates(world() | {"preflight": start}, size={"width": 1024, "height": 768})
    ana.sees(".preflight .bad", "Battery 1 unhealthy")
    assert ana.page.locator(".preflight .rows").evaluate_all(WIDER) == []


OVERLAPPING = """([one, other]) => {
  const textBoxes = (each) => {
    const range = document.createRange();
    range.selectNodeContents(each);
    return [...range.getClientRects()];
  };
  const boxes = (selector) => [...document.querySelectorAll(selector)].filter((each) => each.checkVisibility())
    .flatMap((each) => each.matches("button") ? [each.getBoundingClientRect()] : textBoxes(each));
  const isBefore = (a, b) => a.right - 1 < b.left || a.bottom - 1 < b.top;
  const isApart = (a, b) => isBefore(a, b) || isBefore(b, a);
  const [first, second] = [boxes(one), boxes(other)];
  if (first.length === 0 || second.length === 0) return -1;
  return first.filter((a) => second.some((b) => !isApart(a, b))).length;
}"""
"""The number of texts and buttons of one selector that lie upon those of another; -1 if there are none."""


def test_the_texts_of_the_time_line_do_not_meet_in_a_window_of_any_width(operates):
    for width in (780, 900, 961, 1024):
        ana = operates(size={"width": width, "height": 768})
        ana.sees(".ends .shown", "UTC")
        for other in (".legend .sort", ".transport button"):
            assert ana.page.evaluate(OVERLAPPING, [".ends span", other]) == 0, (width, other)
        assert ana.page.evaluate("innerWidth - document.querySelector('.timeline').scrollWidth") >= 0


def test_the_button_that_enlarges_a_panel_covers_none_of_its_words(operates):
    ana = operates(mode="replay", size={"width": 1024, "height": 768})
    ana.sees(".panel .none", "nothing can be done in it")
    assert ana.page.evaluate(OVERLAPPING, [".panel .none", ".enlarge"]) == 0


def test_the_card_of_an_ended_run_says_when_its_vehicle_was_last_heard(operates):
    ana = operates()
    ana.opens("uav0")
    ended = ana.harness.state["vehicles"]["uav0"] | {"level": 0, "word": "ended", "why": ""}
    heard = ended["link"]["heard"]
    ana.told(vehicles={"uav0": ended | {"link": {"heard": heard, "lost": False, "over": True}}})
    ana.sees("[data-row=uav0] .level", "ended")
    ana.sees("[data-row=uav0] .link", "last heard ")
    ana.sees(".card[data-name=uav0]", "when last heard: 10.1 kn")


# --- how it looks

TEXTS = """() => {
  const rgb = (text) => { const n = text.match(/[0-9.]+/g).map(Number); return n.length < 4 ? [...n, 1] : n; };
  const over = ([r, g, b, a], [x, y, z]) => [r * a + x * (1 - a), g * a + y * (1 - a), b * a + z * (1 - a)];
  const paper = (element) => {
    const layers = [];
    for (let e = element; e; e = e.parentElement) {
      layers.push(rgb(getComputedStyle(e).backgroundColor));
      if (layers.at(-1)[3] === 1) break;
    }
    return layers.reduceRight((below, layer) => over(layer, below), [255, 255, 255]);
  };
  const light = (c) => {
    const [r, g, b] = c.map((v) => (v /= 255) <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const found = [];
  const all = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (all.nextNode()) {
    const e = all.currentNode.parentElement;
    if (!all.currentNode.data.trim() || e.closest("svg, #map, :disabled, .unseen")) continue;
    if (!e.checkVisibility({ opacityProperty: true })) continue;
    const back = paper(e);
    const [a, b] = [light(over(rgb(getComputedStyle(e).color), back)), light(back)];
    const what = `${e.className}: ${all.currentNode.data.slice(0, 30)}`;
    found.push([(Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05), what]);
  }
  return found;
}"""


def test_all_text_has_the_contrast_of_wcag_aa_and_all_of_the_screen_is_in_the_window(operates):
    ana = operates()
    ana.page.emulate_media(reduced_motion="reduce")
    assert ana.page.evaluate("document.documentElement.scrollHeight - innerHeight") == 0
    ana.clicks(".others")
    ana.sees(".alert-list")
    for scheme in ("light", "dark"):
        ana.page.emulate_media(color_scheme=scheme)
        ana.sees(f"html[data-theme={scheme}]")
        for number, tab in enumerate(TABS[2:], 1):
            reads_all_of_a_tab(ana, number, tab)


def reads_all_of_a_tab(ana, number, tab):
    ana.presses(str(number))
    ana.sees("[role=tab][aria-selected=true]", tab)
    ratios = ana.page.evaluate(TEXTS)
    assert len(ratios) > 40
    assert [(ratio, what) for ratio, what in ratios if ratio < 4.5] == []


# --- what comes from others is text

HOSTILE = '<img src=x onerror="document.title=1">"\'&amp;'
SECTIONS = ["vehicles", "entities", "agents", "sayings", "actions", "alerts", "steps", "stations", "mission"]
FOUL = '<script>document.title=1</script><a href="javascript:1"><text x="9" y="9" onclick="1">uav0</text></a>'


def hostile(value):
    """Return a state in which each name and text is an attempt at markup."""
    if isinstance(value, dict):
        return {key: hostile(each) for key, each in value.items()}
    if isinstance(value, list):
        return [hostile(each) for each in value]
    return HOSTILE if isinstance(value, str) else value


def test_what_comes_from_others_is_never_markup_nor_script(operates):
    state = world()
    for section in SECTIONS:
        state[section] = {
            f"{HOSTILE}{key}" if section in ("vehicles", "entities") else key: hostile(value)
            for key, value in state[section].items()
        }
    picture = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9" onload="1">{FOUL}</svg>'
    state["bigraph"] |= {"svg": picture, "text": HOSTILE}
    ana = operates(state, refused=["inline event handler"])
    opens_every_tab_and_a_card(ana)
    sees_texts_and_a_picture_without_a_script(ana)


def opens_every_tab_and_a_card(ana):
    for number, tab in reversed([*enumerate(TABS[2:], 1)]):
        ana.presses(str(number))
        ana.sees("[role=tab][aria-selected=true]", tab)
        ana.sees("[role=tabpanel]")
    ana.clicks(".fleet .name")
    ana.sees(".card")
    assert HOSTILE in ana.texts(".card")[0]


def sees_texts_and_a_picture_without_a_script(ana):
    ana.presses("2")
    ana.sees(".frame svg")
    assert ana.count(".frame script, .frame [onclick], .frame [onload], .frame a[href], img") == 0
    assert HOSTILE in ana.page.title()
