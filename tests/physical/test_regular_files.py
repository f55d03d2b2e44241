"""What has no end, or has somebody to be waited for, is no file: it is refused before a byte of it is read."""

import ast
import os
import re
import socket
from contextlib import closing
from pathlib import Path

import pytest

from physical import open_file

ROOT = Path(__file__).parents[2]


def test_a_file_is_read(tmp_path):
    (tmp_path / "a").write_bytes(b"text")
    with open_file(tmp_path / "a") as file:
        assert file.read() == b"text"


def pipe(path):
    os.mkfifo(path)


def bound(path):
    with closing(socket.socket(socket.AF_UNIX)) as listener:
        listener.bind(str(path))


def endless(path):
    path.symlink_to("/dev/zero")


@pytest.mark.parametrize(
    ("make", "called"), [(pipe, "a pipe"), (bound, "a socket"), (endless, "a device"), (os.mkdir, None)]
)
def test_what_is_no_file_is_refused(tmp_path, make, called):
    make(tmp_path / "x")
    expected = f"this is {called}, not a file: save its content to a file, and give that"
    with pytest.raises(OSError, match=expected if called else "Is a directory"):
        open_file(tmp_path / "x")


def test_what_is_not_there_is_told():
    with pytest.raises(FileNotFoundError):
        open_file("nowhere")
    with pytest.raises(ValueError, match="null"):
        open_file("a\0b")


OWN = {
    "bigactors/__init__.py",
    "bigactors/commands/big/storm.py",
    "bigactors/commands/big/storm_worker.py",
    "bigactors/code_digest.py",
    "bigactors/commands/new.py",
    "bigactors/docs.py",
    "bigactors/module_map.py",
    "bigactors/lsp/language_server.py",
    "bigactors/lsp/worker.py",
    "bigactors/notebook.py",
    "bigactors/pages/scripts.py",
    "bigactors/studio/child_process.py",
    "bigactors/studio/exploring.py",
    "bigactors/studio/mission_file.py",
    "bigactors/studio/simulated_flight.py",
    "bigraphs/examples/__init__.py",
    "bigraphs/exports/html.py",
    "checker/engines/cluster/ray_crew.py",
    "checker/engines/fast/compiled/loop_cache.py",
    "physical/land.py",
    "physical/svg/widths.py",
    "specs/grammar.py",
    "bigraphs/notation/lalr.py",
    "bigraphs/notation/parse_tables.py",
}
"""Which read files of ours, or what a process of ours says."""

ALONE = {"physical/regular_files.py", "physical/untrusted_text.py", "bigraphs/notation/system_files.py"}
"""Who reads what others wrote; bigraphs know none of our rooms."""


READING = re.compile(r"open\b|json|msgspec|\.read_(text|bytes)\b")
"""What stands in every file that `reads` finds something in: no other is parsed."""


def reads(node):
    """Tell whether a call opens a file to read it, or parses JSON, without the two functions that are for it."""
    words = [
        each.value
        for each in [*node.args, *(by.value for by in node.keywords)]
        if isinstance(each, ast.Constant)
    ]
    match node.func:
        case ast.Name("open") | ast.Attribute(attr="open"):
            return "rb" in words or "r" in words
        case ast.Attribute(ast.Name("json"), "load" | "loads"):
            return True
        case ast.Attribute(ast.Attribute(ast.Name("msgspec")), "decode" | "Decoder"):
            return True
    return isinstance(node.func, ast.Attribute) and node.func.attr in {"read_text", "read_bytes"}


def test_all_that_others_wrote_is_read_by_the_functions_that_bound_it():
    found = {
        str(path.relative_to(ROOT))
        for room in (
            "adapters",
            "bigactors",
            "bigraphs",
            "checker",
            "physical",
            "semantics",
            "specs",
        )
        for path in (ROOT / room).rglob("*.py")
        if (text := path.read_text(encoding="utf-8")) and READING.search(text)
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.Call) and reads(node)
    }
    assert found - OWN <= ALONE
