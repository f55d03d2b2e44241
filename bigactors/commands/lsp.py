"""`bigactors lsp`: the language server."""

import contextlib
import os
import sys
from argparse import Namespace
from typing import Final

from bigactors.exits import Exit
from bigactors.mistakes import Mistake

DESCRIPTION: Final = """\
Speak the Language Server Protocol over standard input and output. An editor starts this command;
docs/how-to/editors.md shows the configuration of editors."""

EXAMPLES: Final = ("bigactors lsp",)

ARGUMENTS: Final = """\
  --stdio  use standard input and output (the default, and the only way)"""


def run(options: Namespace) -> Exit:
    """Serve an editor until it ends the session."""
    from physical.wordings import install_extra

    del options
    try:
        from bigactors.lsp.language_server import make_server
    except ModuleNotFoundError as error:
        if (error.name or "").split(".")[0] not in ("pygls", "lsprotocol"):
            raise
        raise Mistake("an editor is served by pygls, which is not installed", install_extra("lsp")) from error
    # The protocol owns the standard output: all other output goes to the standard error.
    streams = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    with (
        streams[0],
        streams[1],
        contextlib.redirect_stdout(sys.stderr),
        contextlib.closing(make_server()) as server,
    ):
        server.start_io(*streams)
    return Exit.HOLDS
