"""Draws the README's picture of the console: `python tests/console_picture.py RECORDING PICTURE`, with chromium.

A copy of the recording grows up to the middle of the flight and on, as it would during the flight, so that the picture
shows a run that goes on.
"""

import shutil
import subprocess
import sys
import threading
from pathlib import Path
from tempfile import TemporaryDirectory

from playwright.sync_api import sync_playwright

MIDDLE = 0.6
"""How much of the recording is there when the console begins."""

SIZE = (1440, 900)
PIECE = 4096
SETTLES = 2_000
"""Milliseconds in which the map and the bigraph come to rest."""


def main() -> None:
    """Draw the picture."""
    recording, picture = map(Path, sys.argv[1:])
    with TemporaryDirectory() as folder:
        growing = Path(folder) / "run.mcap"
        whole = recording.read_bytes()
        begun = int(len(whole) * MIDDLE)
        growing.write_bytes(whole[:begun])
        console = subprocess.Popen(
            [sys.executable, "-m", "bigactors", "console", str(growing), "--follow", "--listen", "0"],
            stdout=subprocess.PIPE,
            text=True,
        )
        done = threading.Event()
        threading.Thread(target=_grow, args=(growing, whole[begun:], done), daemon=True).start()
        try:
            assert console.stdout is not None
            _shoot(console.stdout.readline().split()[-1], picture)
        finally:
            done.set()
            console.terminate()
            console.wait()


def _grow(growing: Path, rest: bytes, done: threading.Event) -> None:
    """Append the rest piece by piece."""
    with growing.open("ab", buffering=0) as file:
        for at in range(0, len(rest), PIECE):
            if done.wait(0.1):
                return
            file.write(rest[at : at + PIECE])


def _shoot(link: str, picture: Path) -> None:
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        width, height = SIZE
        page = browser.new_page(viewport={"width": width, "height": height})
        page.goto(link)
        page.locator(".card .name").first.click()
        page.locator("#tab-bigraph").click()
        page.locator("#panel svg").first.wait_for()
        page.wait_for_timeout(SETTLES)
        page.screenshot(path=picture)
        browser.close()


if __name__ == "__main__":
    main()
