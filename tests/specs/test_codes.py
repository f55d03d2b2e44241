"""The table of mistakes."""

import re

from specs.codes import RANGES, Code, code_list, explain, find_code


def test_numbers_are_unique_and_in_a_known_range():
    numbers = [code.number for code in Code]
    assert len(set(numbers)) == len(numbers)
    assert all(re.fullmatch(r"LS\d{3}", number) and number[:3] in RANGES for number in numbers)


def test_every_code_is_explained_in_sentences():
    for code in Code:
        assert code.title
        assert code.explanation.endswith((".", "?")), code
        assert "  " not in code.explanation


def test_a_code_is_found_by_its_number_in_either_case():
    assert find_code(" ls107 ") is Code.MISSING_ARROW
    assert find_code("LS999") is None
    assert explain(Code.MISSING_ARROW).startswith("LS107: branch without '=>' (syntax)\n\nA case is written")


def test_the_list_has_each_code():
    assert code_list().count("\n- **LS") == len(Code)
