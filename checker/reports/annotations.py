"""Reports as workflow commands with which GitHub Actions annotates lines.

Source: https://docs.github.com/actions/reference/workflow-commands-for-github-actions.
"""

from collections.abc import Iterable, Iterator

from checker.reports.results import CheckResult, Issue, Level, clean

COMMANDS = {Level.WRONG: "error", Level.WARNING: "warning", Level.INCOMPLETE: "warning", Level.BUG: "error"}


def annotations(results: Iterable[CheckResult]) -> Iterator[str]:
    """Yield a command for each issue; no error exactly where every property holds."""
    for result in results:
        yield from (_command(result, issue) for issue in result.issues())


def _command(result: CheckResult, issue: Issue) -> str:
    said = {"file": result.file, **_place(issue), "title": f"{result.name}: {issue.title}"}
    where = ",".join(f"{key}={escape_property(value)}" for key, value in said.items())
    message = "\n".join((issue.message, *issue.details))
    return f"::{COMMANDS[issue.level]} {where}::{escape_message(message)}"


def _place(issue: Issue) -> dict[str, str]:
    """Return the place of an issue; GitHub supports columns on a single line only."""
    place = {"line": issue.line, "endLine": issue.end_line}
    if issue.end_line in (0, issue.line):
        place |= {"col": issue.column, "endColumn": issue.end_column}
    return {key: str(number) for key, number in place.items() if number and issue.line}


def escape_message(text: str) -> str:
    r"""Return a text escaped so that it can't end a command.

    >>> escape_message("100%\n::error::x")
    '100%25%0A::error::x'
    """
    return clean(text).replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def escape_property(text: str) -> str:
    """Return a text escaped so that it can't end a property either.

    >>> escape_property("a,line=1::b")
    'a%2Cline=1%3A%3Ab'
    """
    return escape_message(text).replace(":", "%3A").replace(",", "%2C")
