"""The arguments of `bigactors lsp`."""

from bigactors.arguments.parser import Command, Parser


def fill(parser: Parser) -> None:
    """Add the arguments of `bigactors lsp`."""
    parser.add_argument(
        "--stdio", action="store_true", help="speak over the standard input and output (the only way)"
    )


COMMAND = Command(
    "lsp",
    "serve an editor: mistakes, completion, renaming, verdicts",
    "Speak the Language Server Protocol over the standard input and output. An editor starts this; "
    "docs/how-to/editors.md says how to set it up.",
    ("bigactors lsp",),
    fill,
)
