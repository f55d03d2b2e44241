"""`bigactors new`: a small first mission."""

import re
from argparse import Namespace
from pathlib import Path
from typing import Final

from bigactors.exits import Exit
from bigactors.mistakes import Mistake, unreadable
from bigactors.terminal import say

DESCRIPTION: Final = """\
Write a small mission with comments into NAME.mission. Its properties hold. One of its comments shows how to violate
one, and the trace that follows. An existing file stays as it is."""

EXAMPLES: Final = (
    "bigactors new patrol",
    "bigactors new missions/patrol",
)

ARGUMENTS: Final = """\
  name NAME as named  the mission's name, or the path of its file, with or without .mission"""


def run(options: Namespace) -> Exit:
    """Write a mission, and print the next steps."""
    path = Path(options.name.removesuffix(".mission") + ".mission")
    _write(path, new_mission(path.stem))
    say(f"{path} is written. Next:")
    say(
        f"  bigactors check --watch {path}  its properties hold; break one as its comment shows, save, and see it fail"
    )
    say(f"  bigactors show {path}           draws it, as a bigraph and on a map")
    return Exit.HOLDS


def new_mission(name: str) -> str:
    """Return the mission's text; raises Mistake for an invalid name."""
    from importlib.resources import files as resources

    from specs.grammar import RESERVED

    if not re.fullmatch(r"[^\W\d_]\w*", name) or name in RESERVED:
        reason = "is a word of the language" if name in RESERVED else "is no name"
        raise Mistake(f"'{name:.60}' {reason}", "a mission's name has letters, digits and _, a letter first")
    text = (resources("bigactors") / "templates" / "new.mission").read_text(encoding="utf-8")
    return text.replace("\nmission new\n", f"\nmission {name}\n")


def _write(path: Path, text: str) -> None:
    from bigactors.files import check_writable

    check_writable(str(path))
    try:
        with path.open("x", encoding="utf-8") as file:
            file.write(text)
    except FileExistsError:
        raise Mistake("it exists already, and is left as it is", "choose another name", str(path)) from None
    except OSError as error:
        raise unreadable(str(path), error) from error
