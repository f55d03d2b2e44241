"""The folders of long searches: for checkpoints, and for what leaves the memory."""

from argparse import Namespace

from bigactors.files import make_folder
from bigactors.mistakes import Mistake


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
