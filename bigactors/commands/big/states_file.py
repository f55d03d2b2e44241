"""The checkpoints of `bigactors big full` and `bigactors big check`."""

from argparse import Namespace
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from bigactors.code_digest import build_digest
from bigactors.files import file_stem
from bigactors.mistakes import Mistake
from bigraphs.exploration import Saving
from bigraphs.saved_search import ARRAYS, SavedSearch
from checker.engines.archive import Kinds, read_archive, write_archive
from checker.engines.contract import CheckpointError
from semantics.state.canonical import digest

SCHEMA: Final = "bigactors.states/1"
KINDS: Final[Kinds] = {name: np.dtype(kind).type for name, kind in ARRAYS.items()}


@dataclass(frozen=True, slots=True)
class StatesFile:
    """The checkpoint of a system.

    Attributes:
        path: Its file.
        digest: The digest of the text of the system, of its constants and of the build.
    """

    path: Path
    digest: str

    def write(self, saved: SavedSearch) -> None:
        """Replace the checkpoint; raises OSError if it can't be written."""
        head = {"schema": SCHEMA, "digest": self.digest, **saved.head}
        write_archive(self.path, head, KINDS, [np.asarray(saved.arrays[name]) for name in KINDS])

    def read(self) -> SavedSearch | None:
        """Return the saved search, None if there is none; raises Mistake if it is damaged or of another system."""
        if not self.path.exists():
            return None
        try:
            head, arrays = read_archive(self.path, SCHEMA, KINDS)
        except CheckpointError as error:
            raise Mistake(str(error), "leave --resume out to begin anew") from error
        if head.get("digest") != self.digest:
            what = "this checkpoint is of another system, other constants or another version"
            raise Mistake(what, "leave --resume out to begin anew", str(self.path))
        return SavedSearch(head, arrays)


def saving_of(options: Namespace, folder: str, text: str) -> Saving:
    """Return the way in which the exploration of the system in a text is saved."""
    bound = digest((Path(options.file).suffix, text, sorted(map(repr, options.const)), build_digest()))
    file = StatesFile(Path(folder) / file_stem(Path(options.file).name) / "states.checkpoint", bound)
    return Saving(str(file.path), file.write, options.every, file.read() if options.resume else None)
