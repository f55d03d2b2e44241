import pytest

from specs import Code


@pytest.mark.parametrize("code", Code)
def test_every_code_is_explained(bigactors, code):
    exit_code, out, err = bigactors("explain", code.number)
    assert (exit_code, err) == (0, "")
    assert out.startswith(f"{code.number}: {code.title} ")


def test_without_a_code_all_are_listed(bigactors):
    _, out, _ = bigactors("explain")
    assert [line.split()[0] for line in out.splitlines()[:-2]] == sorted(code.number for code in Code)


def test_an_unknown_code_is_told(bigactors):
    assert bigactors("explain", "LS999") == (
        2,
        "",
        "bigactors: there is no code 'LS999'\n  hint: bigactors explain lists them all\n",
    )
