"""Explore a mission for the studio, in a process that can be killed: a question and an answer a line."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from contextlib import redirect_stdout
from pathlib import Path
from typing import Any, TextIO

from bigactors.lsp.edited_mission import reading_of
from bigactors.mistakes import describe_bug
from bigactors.studio.exploration import Exploration


def main() -> None:
    """Answer the lines of the standard input; the first is the mission's text."""
    with redirect_stdout(sys.stderr):
        for answer in answers(sys.stdin):
            print(json.dumps(answer), file=sys.__stdout__, flush=True)


def answers(lines: TextIO) -> Iterator[dict[str, Any]]:
    """Yield the answer to each line: `answer`, or `refused` in words."""
    asked = json.loads(lines.readline())
    mission = reading_of(asked["name"], asked["text"], Path(asked["directory"])).diagnosis.elaborated
    if mission is None:
        yield {"refused": "the text has mistakes: this is still the text before them"}
        return
    given = None if asked["given"] is None else Path(asked["given"])
    exploration = Exploration(mission, Path(asked["directory"]), given)
    yield {"answer": {}}
    for line in lines:
        try:
            yield {"answer": exploration.handle(json.loads(line))}
        except Exception as error:  # the page shows it, and the exploration goes on
            yield {"refused": describe_bug(error)}


if __name__ == "__main__":
    main()
