"""The studio's server: its page over HTTP, and a session for each page over a websocket."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

from adapters.console.access import Access, Role
from adapters.console.console_server import PAGE, PageService, Site
from bigactors.studio.child_process import FlightProcess
from bigactors.studio.page_requests import MOST_BYTES, PROTOCOL
from bigactors.studio.session import Desk, Session

STUDIO_PAGE: Final = Path(__file__).with_name("page")
NEEDED: Final = "parts/codemirror.js"
"""A part that npm makes; without it the page stays empty."""

MOST_PAGES: Final = 4
"""The most pages at once; each has processes of its own."""


def lacks_parts() -> bool:
    """Return whether the page is incomplete, as in a clone before npm has made its parts."""
    return not (PAGE / NEEDED).is_file()


class StudioService(PageService):
    """Answers requests of the studio's pages about the mission in one file."""

    protocol = PROTOCOL

    def __init__(self, access: Access, site: Site, file: Path, run: Path | None = None) -> None:
        super().__init__(access, site, {"studio": STUDIO_PAGE, "parts": PAGE}, MOST_BYTES)
        self._desk = Desk(file, FlightProcess(), run)
        self._pages = 0

    async def talk(self, socket: Any, role: Role, name: str) -> None:
        """Talk with a page until either side ends it."""
        del name
        if role is not Role.ACT or self._pages >= MOST_PAGES:
            await socket.close(code=4403, message=b"the studio is open in too many pages: close one")
            return
        self._pages += 1
        try:
            await Session(socket, self._desk).run()
        finally:
            self._pages -= 1

    async def close(self) -> None:
        """Close all pages, and end the flight."""
        await super().close()
        await self._desk.flight.end()
