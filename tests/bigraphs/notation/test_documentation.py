import re
from pathlib import Path

import pytest

from bigraphs.notation import read_system
from bigraphs.notation.codes import CODES

PAGE = (Path(__file__).parents[3] / "docs" / "reference" / "big.md").read_text(encoding="utf-8")
FILES = re.findall(r"```big\n(.*?)```", PAGE, re.DOTALL)


@pytest.mark.parametrize("text", FILES, ids=lambda text: text.split(";")[0])
def test_a_file_in_the_documentation_is_read(text):
    assert list(read_system(text).rules())


def test_every_code_is_documented():
    assert all(f"\n- `{code}`: {meaning}\n" in PAGE for code, meaning in CODES.items())
