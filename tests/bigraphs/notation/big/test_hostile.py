import time

import pytest
from big_files import mistakes, system
from hypothesis import given
from hypothesis import strategies as st

from bigraphs.errors import NotationError
from bigraphs.notation import read_system


@pytest.mark.parametrize(
    "text",
    [
        "ctrl A = 0; big a = " + "A." * 20_000 + "1;",
        "ctrl A = 0; big a = " + "(" * 20_000,
        "int n = " + "-" * 20_000 + "1;",
        "int n = " + "2 ^ " * 5_000 + "2;",
        "int n = " + "(" * 190 + "1" + ")" * 190 + " + " + " + ".join(["1"] * 5_000) + ";",
        "int n = " + "9" * 9_000 + ";",
        "int n = 2 ^ 2 ^ 2 ^ 2 ^ 2 ^ 2;",
        "big a = id(999999999);",
        "big a = ([{0}], 999999999);",
        "big a = split(20000) * merge(20000);",
        "ctrl A = 999999999;",
        "\n".join(f"int n{n} = n{n + 1};" for n in range(1_000)),
        "ctrl A = 0;" + "\n".join(f"big b{n} = A.b{n + 1};" for n in range(1_000)),
        "ctrl A = 0; big b0 = A | A;\n" + "\n".join(f"big b{n} = b{n - 1} | b{n - 1};" for n in range(1, 60)),
        "ctrl A = 0; fun big f(n) = f(n + 1) | f(n + 2); big s = f(0);",
        "begin brs init s; rules = [" + "{r}, " * 5_000 + "{r}]; end",
        "ctrl A = 0; react r = " + " || ".join(["A"] * 1_000) + " --> A;",
        "\x00\ud800",
    ],
    ids=lambda text: f"{text[:30]!r}…{len(text)}",
)
def test_hostile_texts_are_refused_soon(text):
    started = time.process_time()
    with pytest.raises(NotationError):
        read_system(text)
    assert time.process_time() - started < 8


def test_the_work_of_one_file_is_bounded(monkeypatch):
    monkeypatch.setattr("bigraphs.notation.big.expression_evaluation.MAX_WORK", 2_000)
    text = system("".join(f"big b{n} = par(100, A.1);" for n in range(20)))
    assert "reading this file takes bigraphs of more than 2000 parts in all" in [
        mistake.message for mistake in mistakes(text)
    ]


def test_the_number_of_words_of_one_file_is_bounded():
    (found,) = mistakes("begin brs init s; rules = [" + "{r}, " * 80_000 + "{r}]; end")
    assert found.code == "too-long"


PIECES = st.sampled_from(
    [
        *("ctrl A = 0;", "atomic ctrl Z = 1;", "fun ctrl K(n) = 1;", "big s = A.1;", "react r = A --> A;"),
        *(
            "fun big f(n) = K(n){x} | f(n - 1);",
            "int n = 3;",
            "begin brs",
            "init s;",
            "rules = [{r}];",
            "end",
        ),
        *(
            "int m = {1, 2};",
            "big",
            "s",
            "=",
            "A",
            ".",
            "(",
            ")",
            "{x}",
            "|",
            "||",
            "share",
            "by",
            "in",
            "1",
            ";",
        ),
        *(
            "/x",
            "par(",
            "3,",
            "-->",
            "@ [0]",
            "if",
            "!",
            "ctx",
            "place A = {A};",
            "link l = {Z};",
            "sort",
            "\x1f",
        ),
    ]
)


@given(st.lists(PIECES, max_size=25).map(" ".join))
def test_any_text_is_read_or_refused_with_places_in_it(text):
    try:
        read_system(text)
    except NotationError as error:
        places = [mistake.offset for mistake in error.mistakes]
    else:
        places = []
    assert places == sorted(places)
    assert all(0 <= place <= len(text) for place in places)
