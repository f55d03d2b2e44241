"""The output of `bigactors big`: files, states as lines of text, and the folders of long searches."""

from argparse import Namespace
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from bigactors.files import check_writable, json_text, make_folder, write_json, write_text
from bigactors.mistakes import Mistake
from bigactors.terminal import say_text
from bigraphs import Bigraph, BigraphError
from bigraphs.notation import write_big
from bigraphs.signature import Signature
from bigraphs.transitions import TransitionSystem
from physical.wordings import counted

LONG: Final = 300
"""The number of characters beyond which a state is replaced by its size, unless it is the requested output."""


def state_text(bigraph: Bigraph) -> str:
    """Return a state in the notation of `.big`, with named nodes as in `.bgm` files: `u0_UAV`.

    A state that nests too deeply for the notation gives its size.
    """
    named = {f"{node.name}_{node.control}": node for node in bigraph.nodes if node.name is not None}
    controls = [replace(bigraph.signature[node.control], name=label) for label, node in named.items()]
    nodes = [
        node if node.name is None else replace(node, control=f"{node.name}_{node.control}", name=None)
        for node in bigraph.nodes
    ]
    signature = Signature((*bigraph.signature.controls, *controls))
    try:
        return write_big(replace(bigraph, signature=signature, nodes=tuple(nodes)))
    except BigraphError:
        return _size(bigraph)


def state_line(bigraph: Bigraph) -> str:
    """Return a state in its notation if that is short, else its size."""
    written = state_text(bigraph)
    return written if len(written) <= LONG else f"{_size(bigraph)}; 'bigactors big show' prints it"


def _size(bigraph: Bigraph) -> str:
    kinds = len({node.control for node in bigraph.nodes})
    nodes = f"{counted(len(bigraph.nodes), 'node')} of {counted(kinds, 'control')}"
    links = f"{counted(bigraph.edges, 'edge')}, {counted(len(bigraph.outer_names), 'name')}"
    return f"{nodes} in {counted(bigraph.regions, 'region')}, {links}"


def checkpoint_folder(options: Namespace) -> str | None:
    """Return the folder for checkpoints; raises Mistake for --resume without one."""
    if options.resume and options.checkpoint is None:
        raise Mistake("--resume goes on from a checkpoint", "give its folder: --checkpoint DIR")
    folder: str | None = options.checkpoint
    return folder


def spill_folder(options: Namespace) -> str | None:
    """Return the folder for --spill, which it makes; raises Mistake without a limit on memory."""
    folder: str | None = options.spill
    if folder is not None:
        if options.max_memory is None:
            raise Mistake("--spill needs a limit on memory", "give it: --max-memory SIZE")
        make_folder(folder)
    return folder


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
