"""The user's mistakes on the command line and in files, and the message after our own bugs."""

import traceback
from collections.abc import Iterable


class Mistake(Exception):
    """Something the user has to put right: printed without a traceback, exit code 2.

    Attributes:
        message: What was found and what was expected.
        hint: What to do; may be empty.
        place: The file; may be empty.
        rendered: How it is printed, where something else has rendered it.
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
    """Return `did you mean ...?`, or nothing; what finds it is loaded when there is a mistake."""
    from bigraphs.notation.spelling import did_you_mean  # noqa: PLC0415 - no command needs it

    return did_you_mean(word, among)


def unreadable(path: str, error: OSError) -> Mistake:
    """Return what to say of a file or folder that the system refuses."""
    return Mistake(error.strerror or str(error), place=path)


def describe_bug(error: BaseException) -> str:
    """Return what is printed of an exception that should not have been."""
    lines = "".join(traceback.format_exception(error))
    return (
        f"{lines}bigactors: internal error: this is a bug of bigactors, not of your mission; "
        "nothing is decided by this run\nplease report it with the text above and the mission"
    )
