"""The user's mistakes on the command line and in files, and the message after our own bugs."""

import traceback
from collections.abc import Iterable


class Mistake(Exception):
    """A mistake that the user has to correct: printed without a traceback, exit code 2.

    Attributes:
        message: The cause: the text found, and the text expected.
        hint: The remedy; may be empty.
        place: The file; may be empty.
        rendered: The whole printed text, if another module has rendered it; else empty.
        details: The same as plain data, one for each mistake, for `--json`.
    """

    def __init__(
        self,
        message: str,
        hint: str = "",
        place: str = "",
        rendered: str = "",
        details: tuple[dict[str, object], ...] = (),
    ) -> None:
        super().__init__(message)
        self.message = message
        self.hint = hint
        self.place = place
        self.rendered = rendered
        self.details = details or ({"message": message, "hint": hint},)

    def __str__(self) -> str:
        if self.rendered:
            return self.rendered
        text = f"{self.place}: {self.message}" if self.place else self.message
        return f"{text}\n  hint: {self.hint}" if self.hint else text


def suggestion(word: str, among: Iterable[str]) -> str:
    """Return `did you mean ...?`, or an empty string. The search is loaded at the first mistake."""
    from bigraphs.notation.spelling import did_you_mean  # noqa: PLC0415 - no correct command needs it

    return did_you_mean(word, among)


def near_or_known(word: str, known: Iterable[str], many: str) -> str:
    """Return `did you mean ...?`, or the known names as a list with the plural of their noun."""
    from bigraphs.notation.spelling import listed  # noqa: PLC0415 - no correct command needs it

    names = tuple(known)
    return suggestion(word, names) or listed(names, many)


def unreadable(path: str, error: OSError) -> Mistake:
    """Return the mistake for a file or folder that the system refuses."""
    return Mistake(error.strerror or str(error), place=path)


def describe_bug(error: BaseException) -> str:
    """Return the printed report of an unexpected exception."""
    lines = "".join(traceback.format_exception(error))
    return (
        f"{lines}bigactors: internal error: this is a bug of bigactors, not of your mission; "
        "nothing is decided by this run\nplease report it with the text above and the mission"
    )
