"""Open a secret link in the browser: by a file that only its user reads, since all users see a command's arguments."""

from __future__ import annotations

import webbrowser
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

REDIRECT: Final = """\
<!doctype html>
<meta charset="utf-8">
<meta name="referrer" content="no-referrer">
<meta http-equiv="refresh" content="0; url={link}">
<title>bigactors</title>
<p><a href="{link}">Go on</a></p>
"""


@contextmanager
def opened_in_browser(link: str) -> Iterator[None]:
    """Open a link in the browser; the file that leads to it is deleted at the end."""
    with TemporaryDirectory(prefix="bigactors-") as folder:  # only this user may look into it
        page = Path(folder) / "open.html"
        page.write_text(REDIRECT.format(link=link), encoding="utf-8")
        page.chmod(0o600)
        webbrowser.open(page.as_uri())
        yield
