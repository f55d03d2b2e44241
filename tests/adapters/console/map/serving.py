"""Serve the chart alone on loopback, as the console would: the same addresses, the same policy."""

import json
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from threading import Thread
from urllib.parse import parse_qsl, urlsplit

from physical.land import land_within

HERE = Path(__file__).parent
PAGE = Path(__file__).parents[4] / "adapters" / "console" / "page"
POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; connect-src 'self'"
)


class Handler(SimpleHTTPRequestHandler):
    """`/parts/` is the console's page, `/land` its coasts, `/tiles` a file, all else the folder of this test."""

    def __init__(self, *arguments, tiles, asked, **options):
        self.tiles, self.asked = tiles, asked
        super().__init__(*arguments, directory=str(HERE), **options)

    def do_GET(self):
        self.asked.append(self.path)
        path = urlsplit(self.path).path
        if path == "/land":
            self.answer("application/geo+json", land(dict(parse_qsl(urlsplit(self.path).query))))
        elif path == "/tiles" and self.tiles and self.headers["Authorization"] == "Bearer open":
            self.part(self.tiles)
        elif path == "/tiles":
            self.send_error(404)
        elif path == "/chart.html":
            self.answer("text/html", chart().encode())
        else:
            super().do_GET()

    def translate_path(self, path):
        parts = urlsplit(path).path.removeprefix("/parts/")
        return str(PAGE / parts) if path.startswith("/parts/") else super().translate_path(path)

    def answer(self, kind, body, status=200, **headers):
        self.send_response(status)
        for name, value in {"Content-Type": kind, "Content-Length": len(body), **headers}.items():
            self.send_header(name, str(value))
        self.end_headers()
        self.wfile.write(body)

    def part(self, content):
        first, last = self.headers["Range"].removeprefix("bytes=").split("-")
        end = min(int(last), len(content) - 1)
        body = content[int(first) : end + 1]
        self.answer(
            "application/octet-stream", body, 206, **{"Content-Range": f"bytes {first}-{end}/{len(content)}"}
        )

    def end_headers(self):
        self.send_header("Content-Security-Policy", POLICY)
        self.send_header("Cache-Control", "no-store")
        super().end_headers()

    def log_message(self, *_):
        pass


def land(window):
    """Return the land in a window as GeoJSON, as the console's server does."""
    south, west, north, east = (float(window[side]) for side in ("south", "west", "north", "east"))
    polygons = land_within((south, west), (north, east))
    coordinates = [[[[x, y] for y, x in ring] for ring in polygon] for polygon in polygons]
    return json.dumps({"type": "MultiPolygon", "coordinates": coordinates}).encode()


def chart():
    """Return the console's page with the chart alone in it: what it loads for the chart is the same."""
    head = (PAGE / "index.html").read_text(encoding="utf-8").partition("<body>")[0]
    own = '<link rel="stylesheet" href="/chart.css">\n  <script type="module" src="/chart.js"></script>'
    head = head.replace('<script type="module" src="/parts/app.js"></script>', own)
    head = head.replace('  <link rel="stylesheet" href="/parts/style.css">\n', "")
    head = head.replace("<title>bigactors console", "<title>The chart alone")
    body = '<button id="before">before</button><div id="map"></div><button id="after">after</button>'
    return f"{head}<body>{body}</body>\n</html>\n"


@contextmanager
def serving(tiles: bytes = b"") -> Iterator[tuple[str, list[str]]]:
    """Serve, and give the address and what is asked for."""
    asked: list[str] = []
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(Handler, tiles=tiles, asked=asked))
    Thread(target=server.serve_forever, daemon=True).start()
    try:
        yield f"http://127.0.0.1:{server.server_port}", asked
    finally:
        server.shutdown()
        server.server_close()
