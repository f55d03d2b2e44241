"""Every block of every page is run, and does what the page shows.

A page is one session: its blocks run in their order, in a folder of their own, by the names of an installation
(`bigactors/checkout.py`).
Comments above a block say what is special about it:

    <!-- file: patrol.mission -->    the block is the content of this file
    <!-- frame: oil_spill -->        its declarations take the places of those in this mission, or join them: a shipped
                                     mission, a file of the page, or one beside it
    <!-- not run: needs a radio -->  the reason why it is only shown
"""

import doctest
import json
import os
import re
import sys
import tomllib
from contextlib import suppress
from dataclasses import dataclass, field
from difflib import SequenceMatcher
from pathlib import Path
from signal import SIGKILL
from subprocess import DEVNULL, PIPE, STDOUT, CompletedProcess, Popen

import pytest
import yaml
from pygments.lexers import get_all_lexers
from repository import PAGES, ROOT, name_of

from bigactors import Limits, check, load_mission
from bigactors.docs import GENERATED
from bigraphs.notation import read_system
from docs.lexers import LEXERS
from specs.missions import shipped_missions

LONG = {
    *(f"docs/tutorial/{name}.md" for name in ("first-mission", "flight", "race")),
    *(f"docs/explanation/{name}.md" for name in ("reduction", "time")),
    "docs/reference/output.md",
    *(
        f"docs/how-to/{name}.md"
        for name in ("bigraphs", "connect-a-vehicle", "own-rule", "python", "write-a-plugin")
    ),
}
"""Pages that fly, or show many commands one after the other."""

NOT_RUN = 45
"""How many blocks are only shown; each says why."""

FENCE = re.compile(r"^((?:<!-- [^\n]+ -->\n)*)```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
INDENTED = re.compile(r"(?<=\n\n) {4}(?![-*\d]).+")
TIME = re.compile(r"\b\d+\.\d+ s\b")
MARK = r"code=$?; printf '\0%s\0\n' $code; (exit $code)"
"""Separates the outputs of several commands."""

MOST = 2_000
"""How many configurations of a mission are explored, where no command of the page explores them all."""

LONGEST = 300
"""Seconds that a command may take; the slowest flies the live demonstration."""


@dataclass(frozen=True)
class Block:
    """A fenced block: where it is, its kind, its text, and what the comments above it say."""

    place: str
    kind: str
    text: str
    notes: dict[str, str]

    @property
    def name(self):
        return self.notes.get("file", re.sub(r"\W", "_", self.place) + f".{self.kind}")


def by_length(page):
    """Return a page as a parameter: some are for the long tests."""
    return pytest.param(page, marks=pytest.mark.long) if name_of(page) in LONG else page


def blocks(page):
    """Yield the blocks of a page."""
    text = page.read_text(encoding="utf-8")
    for found in FENCE.finditer(text):
        notes = dict(re.findall(r"<!-- ([\w ]+): (.+) -->", found[1]))
        line = text.count("\n", 0, found.start(2)) + 1
        yield Block(f"{name_of(page)}:{line}", found[2], found[3], notes)


def declarations(mission):
    """Return the declarations of a mission, each under the words that tell it from the others."""
    pieces = re.split(r"^(?=[A-Za-z])", mission, flags=re.MULTILINE)
    return {re.match(r"(?:(?:def|rule|BigActor) )?\w*", piece)[0]: piece for piece in pieces}


def framed(block, folder):
    """Return the mission of a block, with what its frame has and the block has not."""
    if "frame" not in block.notes:
        return block.text
    name = block.notes["frame"]
    beside = (ROOT / block.place).parent / name
    path = beside if beside.exists() else shipped_missions().get(name, folder / name)
    whole = declarations(path.read_text(encoding="utf-8")) | declarations(block.text)
    return "\n\n".join(piece.strip() for piece in whole.values() if piece.strip()) + "\n"


def split(shown):
    """Return a command, which may go on behind a backslash, and the output that is shown of it."""
    return re.match(r"((?:[^\n]*\\\n)*[^\n]*)\n?(.*)", shown, re.DOTALL).groups()


def marked(output):
    """Yield what each of several commands has written, and its exit code."""
    *parts, _ = output.split("\0\n")
    for part in parts:
        written, _, code = part.rpartition("\0")
        yield written, code


def alike(expected, found):
    """Tell whether an output is as it is shown, whatever the times and wherever `...` stands."""
    expected, found = (TIME.sub("0.00 s", each.strip()) + "\n" for each in (expected, found))
    return doctest.OutputChecker().check_output(expected, found, doctest.ELLIPSIS)


def renewed(expected, found):
    """Return an expected output with the lines that a command prints now; `...` stays."""
    before, now = expected.splitlines(keepends=True), found.splitlines(keepends=True)
    lines = []
    for tag, i, j, k, m in SequenceMatcher(None, before, now, autojunk=False).get_opcodes():
        elided = any("..." in line for line in before[i:j])
        lines += before[i:j] if tag == "equal" or elided else now[k:m]
    return "".join(lines)


@dataclass(frozen=True)
class Session:
    """A folder and an environment in which the blocks of a page run.

    `updated` collects what the page is to show instead, with `pytest --update`.
    """

    folder: Path
    variables: dict[str, str]
    checked: set[str] = field(default_factory=set)
    updated: dict[str, str] | None = None

    def run(self, block):
        getattr(self, block.kind)(block)

    def write(self, block, text):
        path = self.folder / block.name
        path.write_text(text, encoding="utf-8")
        return path

    def mission(self, block):
        text = framed(block, self.folder)
        mission = load_mission(self.write(block, text))
        if text not in self.checked:  # parts of one mission come to the same
            self.checked.add(text)
            check(mission, limits=Limits(configurations=MOST))

    def big(self, block):
        self.write(block, block.text)
        assert list(read_system(block.text).rules())

    def python(self, block):
        done = self.process([sys.executable, self.write(block, block.text).name])
        assert done.returncode == 0, f"{block.place}\n{done.stdout}"

    def pycon(self, lines):
        """Run all that a page says to the interpreter, in one session."""
        (self.folder / "session.txt").write_text(lines, encoding="utf-8")
        done = self.process([sys.executable, "-m", "doctest", "session.txt"])
        assert done.returncode == 0, done.stdout

    def sh(self, block):
        done = self.process(["bash", "-euc", block.text])
        assert done.returncode == 0, f"{block.place}\n{done.stdout}"

    def console(self, block):
        commands, outputs = zip(
            *map(split, re.split(r"^\$ ", block.text, flags=re.MULTILINE)[1:]), strict=True
        )
        done = self.process(["bash", "-c", "\n".join(f"{each}\n{MARK}" for each in commands)])
        for command, expected, (found, code) in zip(commands, outputs, marked(done.stdout), strict=True):
            message = f"{block.place}: {command}\n{found}"
            if self.updated is not None and expected and not alike(expected, found):
                self.updated[f"$ {command}\n{expected}"] = f"$ {command}\n{renewed(expected, found)}"
                continue
            assert code == "0" if not expected else alike(expected, found), message

    def toml(self, block):
        assert tomllib.loads(self.write(block, block.text).read_text(encoding="utf-8"))

    def json(self, block):
        assert json.loads(self.write(block, block.text).read_text(encoding="utf-8"))

    def yaml(self, block):
        assert yaml.safe_load(self.write(block, block.text).read_text(encoding="utf-8"))

    def text(self, block):
        """See what is generated compared by `tests/bigactors/test_docs.py`."""

    ebnf = text

    def process(self, command):
        """Run a command, with what it has started, and nothing of that beyond its end."""
        with Popen(
            command,
            cwd=self.folder,
            env=self.variables,
            stdin=DEVNULL,
            stdout=PIPE,
            stderr=STDOUT,
            encoding="utf-8",
            start_new_session=True,
        ) as process:
            try:
                output, _ = process.communicate(timeout=LONGEST)
            finally:
                with suppress(ProcessLookupError):
                    os.killpg(process.pid, SIGKILL)
        return CompletedProcess(command, process.returncode, output)


KINDS = {"big", "console", "ebnf", "json", "mission", "pycon", "python", "sh", "text", "toml", "yaml"}


def is_run(block):
    return "not run" not in block.notes


def variables(site):
    """Return the environment of a page's blocks: the checkout, and what the page itself installs into a folder."""
    hidden = ("CI", "PYTEST", "PYTHON")  # in CI pytest prints its summary in full, and no page shows that
    kept = {name: value for name, value in os.environ.items() if not name.startswith(hidden)}
    return kept | {
        "COLUMNS": "100",
        "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
        "PIP_DISABLE_PIP_VERSION_CHECK": "1",
        "PIP_NO_INDEX": "1",
        "PIP_TARGET": str(site),
        "PYTHONPATH": f"{ROOT}{os.pathsep}{site}",
        "PYTHONUTF8": "1",
    }


@pytest.mark.parametrize("page", list(map(by_length, PAGES)), ids=name_of)
def test_the_blocks_of_a_page_do_what_it_shows(page, tmp_path, request):
    updated = {} if request.config.getoption("--update") else None
    session = Session(tmp_path, variables(tmp_path / "site"), updated=updated)
    shown = list(filter(is_run, blocks(page)))
    for block in reversed(shown):
        if block.notes.keys() & {"file", "frame"} == {"file"}:
            session.write(block, block.text)  # what is shown above may need it
    for block in shown:
        if block.kind != "pycon":
            session.run(block)
    if lines := "\n".join(block.text for block in shown if block.kind == "pycon"):
        session.pycon(lines)
    if updated:
        text = page.read_text(encoding="utf-8")
        for before, after in updated.items():
            text = text.replace(before, after)
        page.write_text(text, encoding="utf-8")


@pytest.mark.parametrize("page", sorted((ROOT / "docs").rglob("*.txt")), ids=name_of)
def test_a_session_of_the_python_reference_does_what_it_shows(page, tmp_path):
    Session(tmp_path, variables(tmp_path / "site")).pycon(page.read_text(encoding="utf-8"))


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_a_block_has_a_kind_by_which_it_is_run(page):
    assert [block.place for block in blocks(page) if is_run(block) and block.kind not in KINDS] == []
    text = FENCE.sub("", page.read_text(encoding="utf-8"))
    assert "```" not in text
    assert [block.place for block in blocks(page) if not block.kind] == []
    assert INDENTED.findall(text) == []


def test_the_site_can_colour_each_block():
    languages = LEXERS.keys() | {alias for _, aliases, _, _ in get_all_lexers() for alias in aliases}
    assert [block.place for page in PAGES for block in blocks(page) if block.kind not in languages] == []


def test_a_block_that_only_shows_something_is_generated_or_says_why():
    silent = [
        block.place
        for page in PAGES
        if not page.read_text(encoding="utf-8").startswith(GENERATED)
        for block in blocks(page)
        if block.kind in {"text", "ebnf"} and is_run(block)
    ]
    assert silent == []


def test_the_blocks_that_are_not_run_are_counted():
    shown = [block.place for page in PAGES for block in blocks(page) if not is_run(block)]
    assert len(shown) == NOT_RUN, shown
