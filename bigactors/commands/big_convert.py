"""`bigactors big convert`: a model of bigraphs in the file format of another tool."""

from argparse import Namespace
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from bigactors.exits import Exit
from bigactors.files import check_writable, write_text
from bigactors.mistakes import Mistake
from bigactors.terminal import say_text, tell
from bigraphs import Bigraph, BigraphError
from bigraphs.examples import example_names, example_text
from bigraphs.exchange.xmi_reading import read_xmi
from bigraphs.exchange.xmi_writing import write_xmi
from bigraphs.notation import read_bgm, read_system
from bigraphs.notation.big.parser import parse_model
from bigraphs.notation.big.portable import portable, unportable
from bigraphs.notation.big.writer import checked_text, model_of
from bigraphs.notation.files import read_text
from bigraphs.system import System, SystemKind, Value

READ: Final = ("big", "bgm", "xmi")
WRITTEN: Final = ("big", "xmi")


def convert(options: Namespace) -> Exit:
    """Read a file of one format, and write it in another."""
    shipped = options.file in example_names() and not Path(options.file).exists()
    text = example_text(options.file) if shipped else read_text(Path(options.file))
    source = "big" if shipped else options.source or _format_of(options.file, READ, "--from")
    target = options.target or _format_of(options.output, WRITTEN, "--to")
    if options.output != "-":
        check_writable(options.output)
    system = _read(text, source, dict(options.const))
    for warning in system.warnings:
        tell(f"warning: {warning.render(options.file)}")
    written = (
        _as_xmi(system, options.initial)
        if target == "xmi"
        else _as_big(text, source, system, dict(options.const))
    )
    if options.output == "-":
        say_text(written)
    else:
        write_text(options.output, written)
        tell(f"written: {options.output}")
    return Exit.HOLDS


def _format_of(file: str, known: tuple[str, ...], option: str) -> str:
    """Return the format of a file by its suffix."""
    ending = Path(file).suffix.removeprefix(".")
    if ending not in known:
        raise Mistake(
            f"the ending of '{file}' names no format", f"give {option} {' or '.join(known)}", place=file
        )
    return ending


def _read(text: str, source: str, constants: dict[str, Value]) -> System:
    if source == "big":
        return read_system(text, constants=constants)
    if constants:
        raise BigraphError("file", f"a .{source} file has no constants", "leave --const out")
    return read_bgm(text) if source == "bgm" else _state(read_xmi(text))


def _state(bigraph: Bigraph) -> System:
    """Return a system without rules whose only state is the bigraph."""
    for what in (*(f"site {site}" for site in range(len(bigraph.sites))), *bigraph.inner.names):
        hint = "fill its sites and close its inner names there, or read it in Python: read_xmi takes both"
        raise BigraphError("ground", f"a state has no sites and inner names, and this one has {what}", hint)
    return System(SystemKind.BRS, bigraph.signature, bigraph)


def _as_big(text: str, source: str, system: System, constants: dict[str, Value]) -> str:
    """Return a `.big` file: a `.big` model keeps its declarations, other models get new ones."""
    model = portable(parse_model(text), system, constants) if source == "big" else model_of(system)
    if lost := unportable(model):
        tell(f"warning: BigraphER does not read {', '.join(lost)}")
    return checked_text(model)


def _as_xmi(system: System, initial_only: bool) -> str:
    """Return the first state as XMI. Refuse a system with more than a state, unless `initial_only`."""
    if not initial_only and (lost := [*_more_than_a_state(system)]):
        hint = "with --initial, the first state is written alone"
        raise BigraphError("notation", f"XMI holds one bigraph, and this file has {', '.join(lost)}", hint)
    kinds = [
        control.name
        for control in system.signature.controls
        if control.status != "active" or not (control.ordered or control.arity in (0, 1))
    ]
    if kinds:
        tell(
            f"warning: XMI does not say that ports are interchangeable or places not active: {', '.join(kinds)}"
        )
    return write_xmi(system.initial)


def _more_than_a_state(system: System) -> Iterator[str]:
    for number, what in (
        (sum(1 for _ in system.rules()), "rules"),
        (len(system.predicates), "predicates"),
        (len(system.properties), "properties"),
        (len(system.sorting.places) + len(system.sorting.links), "sorts"),
    ):
        if number:
            yield f"{what} ({number:,})"
