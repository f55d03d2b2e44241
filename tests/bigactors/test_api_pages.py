import re

import pytest

from bigactors.api_pages import FOLDER, PAGES, api_pages, public_names


@pytest.mark.parametrize("page", PAGES)
def test_every_public_name_is_in_an_example_and_has_its_signature_and_docstring(page):
    module, _ = PAGES[page]
    said = re.findall(
        r"^(?:>>>|\.\.\.) (.+)$", (FOLDER / f"{page}.txt").read_text(encoding="utf-8"), re.MULTILINE
    )
    used = set(re.findall(r"\w+", "\n".join(said)))
    assert [name for name in public_names(module) if name not in used] == []
    text = api_pages()[page]
    assert [name for name in public_names(module) if f"\n### {name}\n" not in text] == []


def test_a_page_has_nothing_that_differs_between_two_runs():
    assert "0x" not in re.sub(r"0x[A-Z0-9]+", "", "".join(api_pages().values()))
