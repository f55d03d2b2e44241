"""What axe-core finds wrong with the page for people who use it without a mouse, or without seeing it: nothing."""

import pytest
from browsers import DESK, PHONE
from page_harness import PAGE, Harness, world

AXE = PAGE / "node_modules" / "axe-core" / "axe.min.js"
RUN = "axe.run(document, { resultTypes: ['violations'] })"
START = {
    "what": "uav0 is heard",
    "done": True,
    "detail": "",
    "vehicle": "uav0",
    "fence": "none",
    "refuses": [],
}


@pytest.mark.parametrize("size", [DESK, PHONE], ids=["desk", "phone"])
def test_axe_finds_no_fault_in_any_panel_nor_before_the_start(browser, size):
    if not AXE.exists():
        pytest.skip("axe-core is not there: `make parts` fetches it")
    with Harness(world()) as harness:
        context = browser.new_context(
            viewport=size, bypass_csp=True
        )  # the page's policy lets no test's script in
        page = context.new_page()
        page.add_init_script("if (location.port) localStorage['bigactors.name'] ??= 'Ana'")
        page.goto(harness.link)
        page.locator("html[data-drawn]").wait_for()
        page.add_script_tag(path=AXE)
        tabs = ["actions", "bigraph", "steps", "agents", "stations"]
        for tab in tabs if size is DESK else ["map", "vehicles", *tabs]:
            page.click(f"#tab-{tab}")
            page.locator(f"#tab-{tab}[aria-selected=true]").wait_for()
            if page.locator(".fleet .name:visible").count() and not page.locator(".card.chosen").count():
                page.click(".fleet .name")
            assert faults(page) == [], tab
        harness.change(preflight={"state": "ready", "by": "", "items": [START]})
        page.locator(".preflight").wait_for()
        assert faults(page) == []
        context.close()


def faults(page):
    """Return the rules that axe finds violated, each with the first element."""
    return [(each["id"], each["nodes"][0]["html"]) for each in page.evaluate(RUN)["violations"]]
