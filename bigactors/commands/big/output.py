"""The output files of `bigactors big`."""

from argparse import Namespace
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from bigactors.files import check_writable, json_text, write_json, write_text
from bigactors.terminal import say_text
from bigraphs.transitions import TransitionSystem


def check_outputs(options: Namespace) -> None:
    """Raise Mistake for an unwritable path, before the exploration."""
    for path in (options.html, options.svg, options.dot, options.json):
        if path and path != "-":
            check_writable(path)
    for prefix in (options.prism, options.storm):
        if prefix:
            check_writable(f"{prefix}.tra")


def write_outputs(options: Namespace, found: TransitionSystem) -> Iterator[str]:
    """Write the requested files, and yield their names."""
    wanted = options.html, options.svg, options.dot, options.json, options.prism, options.storm
    if not any(wanted):
        return
    from bigraphs.exports import graph_svg, prism_files, storm_files, to_dot, to_html, to_json  # only full
    from bigraphs.exports.html import MOST_STATES, first_states  # writes them

    title = Path(options.file).name
    if options.html:
        yield _write(options.html, to_html(found, title))
    if options.svg:
        yield _write(options.svg, graph_svg(first_states(found, MOST_STATES)))
    if options.dot:
        yield _write(options.dot, to_dot(found))
    if options.json == "-":
        say_text(json_text(to_json(found)))
    elif options.json:
        yield _write(options.json, json_text(to_json(found)))
    for prefix, write in ((options.prism, prism_files), (options.storm, storm_files)):
        if prefix:
            for suffix, text in write(found).items():
                yield _write(prefix + suffix, text)


def write_data(path: str, value: Any) -> None:
    """Write data as JSON into a file, or to standard output if that is `-`."""
    if path == "-":
        say_text(json_text(value))
    else:
        write_json(path, value)


def _write(path: str, text: str) -> str:
    write_text(path, text)
    return path
