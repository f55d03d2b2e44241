"""`bigactors fmt`: mission files in the canonical layout, with the same meaning."""

from argparse import Namespace
from typing import Final

from bigactors.exits import Exit, worst
from bigactors.mistakes import Mistake
from bigactors.terminal import say, say_text, tell

DESCRIPTION: Final = """\
Rewrite mission files in the canonical layout, with their comments. A file with a syntax error stays as it is."""

EXAMPLES: Final = ("bigactors fmt oil_spill.mission", "bigactors fmt --check specs/missions/*.mission")

ARGUMENTS: Final = """\
  files FILE...  a mission file

at most one of
  --check  write nothing; exit code 1 if a file would change
  --stdout  print the formatted text instead of writing it"""


def run(options: Namespace) -> Exit:
    """Format each file; a file that does not parse is left unchanged."""
    return worst([_file(path, options) for path in options.files])


def _file(path: str, options: Namespace) -> Exit:
    from bigactors.files import write_text

    try:
        before, after = formatted(path)
    except Mistake as mistake:
        tell(str(mistake))
        return Exit.MISTAKE
    if options.stdout:
        say_text(after)
        return Exit.HOLDS
    if before == after:
        return Exit.HOLDS
    if options.check:
        say(f"{path} would be formatted")
        return Exit.VIOLATED
    write_text(path, after)
    say(f"{path} formatted")
    return Exit.HOLDS


def formatted(path: str) -> tuple[str, str]:
    """Return a mission file's text and its formatted text; raises Mistake if it does not parse."""
    from bigactors.diagnostic_output import as_mistake
    from bigactors.files import read_bytes
    from specs import MissionError, Source, decode, format_mission, parse
    from specs.preprocessing import MAX_BYTES

    data = read_bytes(path, MAX_BYTES)
    try:
        source = decode(path, data)
        mission = parse(source)
        result = format_mission(source.text, path)
        if parse(Source(path, result)) != mission:
            raise AssertionError(f"formatting {path} would change its meaning; it is left as it is")
    except MissionError as error:
        raise as_mistake(error) from error
    return data.decode("utf-8"), result
