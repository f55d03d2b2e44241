"""`signature standard`, and the signature to paste where kinds are not declared."""

import re
from pathlib import Path

import pytest
from elaborating import elaborated, mistakes

from specs.codes import Code
from specs.formatter import format_mission
from specs.standard_signature import STANDARD

ROOT = Path(__file__).parents[2]
MISSIONS = ROOT / "specs" / "missions"
OWN_SIGNATURE = re.compile(r"^signature (?:\{.*?^\}|standard)\n", re.MULTILINE | re.DOTALL)
TUGS = """
world {
  basin0: Location = box (37.04, -8.59) (36.94, -8.79)
  tug0: Tug = point (37.0, -8.6)
}
BigActor a hosted_at tug0 with_behavior { control(MOVE_HOST_TO basin0) }
"""


def test_standard_declares_the_kinds_of_the_paper():
    tugs = TUGS.replace("Tug", "UAV")
    standard, written = (elaborated(text + tugs) for text in ("signature standard", STANDARD))
    assert standard.setting.signature == written.setting.signature
    assert standard.setting.signature["Vessel"].carries == {"Drifter", "Station"}


def test_a_kind_beside_the_standard_ones_adds_to_that_of_its_name():
    inside = elaborated("signature standard { kind Location contains Tug  kind Tug driven }" + TUGS)
    beside = elaborated(
        "signature { kind Tug driven  kind Location contains Tug }\nsignature standard" + TUGS
    )
    assert inside.setting.signature == beside.setting.signature
    assert inside.setting.signature["Location"].contains >= {"Tug", "UAV"}
    assert inside.setting.signature["UAV"].driven


def test_a_standard_kind_may_be_added_to_once():
    (found,) = mistakes("signature standard { kind UAV passive  kind UAV }" + TUGS.replace("Tug", "UAV"))
    assert found.code is Code.DUPLICATE_NAME


def test_standard_is_a_name_elsewhere():
    assert elaborated("signature standard" + TUGS.replace("tug0", "standard").replace("Tug", "UAV"))


def test_the_standard_signature_is_one_line_in_the_canonical_layout():
    assert format_mission("signature   standard\nscheduler fcfs") == "signature standard\nscheduler fcfs\n"
    own = "signature standard {\n  kind Tug driven\n}\n"
    assert format_mission("signature standard { kind Tug driven }") == own
    assert "// why" in format_mission("signature standard { // why\n }")


def test_without_a_signature_there_is_one_error_with_one_to_paste():
    (found,) = mistakes(TUGS)
    assert found.code is Code.UNKNOWN_KIND
    assert found.message == "no signature declares Location and Tug"
    assert found.hint == "write: signature standard { kind Location contains Tug  kind Tug driven }"


def test_a_kind_that_the_signature_lacks_is_reported_once_however_many_use_it():
    (found,) = mistakes(
        "signature { kind Location contains Location }\nworld { tug1: Tug absent }"
        'check { reachable "r": exists x: Tug . present x }' + TUGS
    )
    assert found.message == "unknown kind 'Tug', used 3 times"
    assert found.hint == "declare it: signature { kind Tug driven }"


@pytest.mark.parametrize("path", sorted(MISSIONS.glob("*.mission")), ids=lambda path: path.stem)
def test_the_proposed_signature_makes_a_mission_sound_that_has_lost_its_own(path):
    text = OWN_SIGNATURE.sub("", path.read_text(encoding="utf-8"))
    (found,) = mistakes(text, MISSIONS)
    elaborated(text + found.hint.removeprefix("write: "), MISSIONS)
