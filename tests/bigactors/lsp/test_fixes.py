"""Quick fixes: applied, each mends the mistake that it is offered for."""

from pathlib import Path

import pytest

from bigactors.lsp.edited_mission import reading_of
from bigactors.lsp.fixes import fixes
from bigactors.lsp.renaming import replaced

MISSIONS = Path(__file__).parents[3] / "specs/missions"
OIL_SPILL = (MISSIONS / "oil_spill.mission").read_text(encoding="utf-8")


def mistakes(text):
    return reading_of("m", text, MISSIONS).diagnosis.mistakes


@pytest.mark.parametrize(
    ("right", "wrong", "title"),
    [
        ("MOVE_HOST_TO searchArea0", "MOVE_HOST_TO serchArea0", "Write 'searchArea0'"),
        ("kind UAV driven", "kind UAV drivn", "Write 'driven'"),
        ("oilSpill0 drifts among", "oilSpill0 drift among", "Write 'drifts'"),
        ("obs => control", "obs control", "Put '=>' before it"),
        ("uav0: UAV = point", "uav0: UAV point", "Put '=' before it"),
        ("(36.94, -8.79)", "(36.94 -8.79)", "Put ',' before it"),
        ("observe(CHILDREN(PARENT(HOST)))", "observe(CHILDREN(PARENT(HOST))))", "Remove it"),
        ("observe(CHILDREN", "§ observe(CHILDREN", "Remove it"),
        ('"over the spill": actually', '"over the spill: actually', 'Close the string with "'),
    ],
)
def test_what_is_offered_mends_the_mistake(right, wrong, title):
    assert right in OIL_SPILL
    text = OIL_SPILL.replace(right, wrong)
    (found,) = mistakes(text)
    (fix,) = (fix for fix in fixes(found, text) if fix.title == title)
    after = replaced(text, (fix.span,), fix.text)
    if "string" in title:  # where it ends is for the user to say
        assert [each.code.number for each in mistakes(after)] != [found.code.number]
    else:
        assert after.split() == OIL_SPILL.split()


def mended(text):
    """Return a text with the one fix of its one mistake, and what that is called."""
    (found,) = mistakes(text)
    (fix,) = fixes(found, text)
    return replaced(text, (fix.span,), fix.text), fix.title


def test_a_channel_that_is_not_declared_can_be():
    after, title = mended(OIL_SPILL.replace("environment {", "environment {\n  wifi drops"))
    assert (title, mistakes(after)) == ("Declare 'channel wifi'", ())


@pytest.mark.parametrize(
    ("text", "after"),
    [
        (
            "// a comment\nmission m\n\nenvironment {\n  wifi drops\n}\n",
            "// a comment\nmission m\n\nworld {\n  channel wifi\n}\n",
        ),
        (
            "mission m\n\nworld {\n  uav0: UAV absent\n}\n",
            "mission m\n\nsignature standard\n\nworld {\n  uav0: UAV absent\n}\n",
        ),
        (OIL_SPILL.replace('"over the spill":', "“over the spill”:"), OIL_SPILL),
    ],
    ids=["a section behind the header", "the paper's signature", "straight quotes"],
)
def test_what_is_missing_or_from_elsewhere_is_mended(text, after):
    found, _ = mended(text)
    assert found.startswith(after)
    assert mistakes(found) == ()
