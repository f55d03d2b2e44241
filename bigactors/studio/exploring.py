"""Explore a mission for the studio, in a process that can be killed: a question and an answer a line."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from contextlib import redirect_stdout
from pathlib import Path
from typing import Any, TextIO

from bigactors.mistakes import describe_bug
from bigactors.studio.exploration import Exploration
from specs import MissionError, Source
from specs.diagnostics import render_all
from specs.elaboration import diagnose
from specs.parser import read


def main() -> None:
    """Answer the lines of the standard input; the first is the mission's text."""
    with redirect_stdout(sys.stderr):
        for answer in answers(sys.stdin):
            print(json.dumps(answer), file=sys.__stdout__, flush=True)


def answers(lines: TextIO) -> Iterator[dict[str, Any]]:
    """Yield the answer to each line: `answer`, or `refused` in words."""
    asked = json.loads(lines.readline())
    source = Source(asked["name"], asked["text"])
    try:
        exploration = _exploration(source, Path(asked["directory"]))
        yield {"answer": {}}
    except MissionError as error:
        yield {"refused": render_all(error.diagnostics, error.source)}
        return
    for line in lines:
        try:
            yield {"answer": exploration.handle(json.loads(line))}
        except Exception as error:  # the page shows it, and the exploration goes on
            yield {"refused": describe_bug(error)}


def _exploration(source: Source, directory: Path) -> Exploration:
    diagnosis = diagnose(read(source), source, directory)
    if diagnosis.elaborated is None:
        raise MissionError(source, diagnosis.mistakes)
    return Exploration(diagnosis.elaborated)


if __name__ == "__main__":
    main()
