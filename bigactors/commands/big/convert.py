"""`bigactors big convert`: a model of bigraphs in BigraphER's language."""

from argparse import Namespace
from pathlib import Path
from typing import Final

from bigactors.exits import Exit
from bigactors.files import check_writable, write_text
from bigactors.mistakes import Mistake
from bigactors.terminal import say_text, tell
from bigraphs import BigraphError
from bigraphs.examples import example_names, example_text
from bigraphs.notation import read_bgm, read_system
from bigraphs.notation.big.parser import parse_model
from bigraphs.notation.big.portable import portable, unportable
from bigraphs.notation.big.writer import checked_text, model_of
from bigraphs.notation.system_files import read_text
from bigraphs.system import System, Value

READ: Final = ("big", "bgm")


def convert_file(options: Namespace) -> Exit:
    """Read a file of either language, and write it in BigraphER's."""
    shipped = options.file in example_names() and not Path(options.file).exists()
    text = example_text(options.file) if shipped else read_text(Path(options.file))
    source = "big" if shipped else options.source or _language_of(options.file)
    if options.output != "-":
        if Path(options.output).suffix != ".big":
            raise Mistake("a .big file is written", "give OUT the ending .big", place=options.output)
        check_writable(options.output)
    system = _read(text, source, dict(options.const))
    for warning in system.warnings:
        tell(f"warning: {warning.render(options.file)}")
    written = _written(text, source, system, dict(options.const))
    if options.output == "-":
        say_text(written)
    else:
        write_text(options.output, written)
        tell(f"written: {options.output}")
    return Exit.HOLDS


def _language_of(file: str) -> str:
    """Return the language of a file by its suffix."""
    ending = Path(file).suffix.removeprefix(".")
    if ending not in READ:
        hint = f"give --from {' or '.join(READ)}"
        raise Mistake(f"the ending of '{file}' names no language that is read", hint, place=file)
    return ending


def _read(text: str, source: str, constants: dict[str, Value]) -> System:
    if source == "big":
        return read_system(text, constants=constants)
    if constants:
        raise BigraphError("file", f"a .{source} file has no constants", "leave --const out")
    return read_bgm(text)


def _written(text: str, source: str, system: System, constants: dict[str, Value]) -> str:
    """Return a `.big` file: a `.big` model keeps its declarations, other models get new ones."""
    model = portable(parse_model(text), system, constants) if source == "big" else model_of(system)
    if lost := unportable(model):
        tell(f"warning: BigraphER does not read {', '.join(lost)}")
    return checked_text(model)
