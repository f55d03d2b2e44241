"""The studio's secret link on its way to the browser: no process has it as an argument, and only its user reads it."""

import re
import stat
import subprocess
import sys
import time
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest
from browsers import chromium

from bigactors.browser_launch import opened_in_browser
from bigactors.studio.studio_server import lacks_parts

BROWSER = """\
#!/bin/sh
echo "$@" > "$0.arguments.new"
mv "$0.arguments.new" "$0.arguments"
"""
WAIT = 60.0


def noted(path):
    end = time.monotonic() + WAIT
    while not path.exists():
        assert time.monotonic() < end
        time.sleep(0.05)
    return path.read_text(encoding="utf-8").strip()


def page_at(uri):
    assert uri.startswith("file://")
    return Path(unquote(urlsplit(uri).path))


def test_the_studio_opens_its_link_without_the_token_in_an_argument(tmp_path, monkeypatch):
    if lacks_parts():
        pytest.skip("the studio's page has no parts: npm makes them")
    browser = tmp_path / "browser"
    browser.write_text(BROWSER, encoding="ascii")
    browser.chmod(0o700)
    monkeypatch.setenv("BROWSER", str(browser))
    command = [sys.executable, "-m", "bigactors", "studio", str(tmp_path / "patrol.mission"), "--port", "0"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        link = re.fullmatch(r"studio: (http://\S+#token=\S+)\n", process.stdout.readline())[1]
        arguments = noted(tmp_path / "browser.arguments")
        page = page_at(arguments)
        assert link.partition("=")[2] not in arguments
        assert link in page.read_text(encoding="utf-8")
        assert stat.S_IMODE(page.stat().st_mode) == 0o600
        assert stat.S_IMODE(page.parent.stat().st_mode) == 0o700
        process.send_signal(2)
        process.wait(WAIT)
    assert not page.parent.exists()


def test_chromium_follows_the_page_to_the_link_with_its_token(tmp_path, monkeypatch):
    opened = []
    monkeypatch.setattr("webbrowser.open", opened.append)
    target = tmp_path / "target.html"
    target.write_text("<title>there</title>", encoding="utf-8")
    link = f"{target.as_uri()}#token=a-b_c"
    with opened_in_browser(link), chromium() as found:
        page = found.new_page()
        page.goto(opened[0])
        page.wait_for_url(link)
        assert page.title() == "there"
