"""The console's chart in a browser, alone with a store that the tests fill."""

import io
import re
from contextlib import contextmanager
from itertools import combinations
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from browsers import Watch, says, until
from console_clients import console
from page_harness import PAGE
from PIL import Image
from pyproj import Geod
from threaded import beside

from adapters.console.console_server import HEADERS

HERE = Path(__file__).parent
NOW = 1_800_000_000.0
SEARCH = [[36.94, -8.79], [36.94, -8.59], [37.04, -8.59], [37.04, -8.79]]
SIZE = {"width": 800, "height": 600}


def page_of_chart():
    """Return the console's page with the chart alone in it: what it loads for the chart is the same."""
    head = (PAGE / "index.html").read_text(encoding="utf-8").partition("<body>")[0]
    own = '<link rel="stylesheet" href="/chart.css">\n  <script type="module" src="/chart.js"></script>'
    head = head.replace('<script type="module" src="/parts/app.js"></script>', own)
    head = head.replace('  <link rel="stylesheet" href="/parts/style.css">\n', "")
    head = head.replace("<title>bigactors console", "<title>The chart alone")
    body = '<button id="before">before</button><div id="map"></div><button id="after">after</button>'
    return f"{head}<body>{body}</body>\n</html>\n"


def answer(route):
    """Answer what is the test's own; the console answers all else."""
    name = urlsplit(route.request.url).path[1:]
    text = page_of_chart() if name == "chart.html" else (HERE / name).read_text(encoding="utf-8")
    kind = {"html": "text/html", "js": "text/javascript", "css": "text/css"}[name.rpartition(".")[2]]
    route.fulfill(body=text, headers=HEADERS, content_type=kind)


@contextmanager
def chart_in(browser, recording, asked="", **more):
    """Open the chart alone, as a console serves its parts, its coasts and its tiles."""
    watch = Watch()
    with beside(console(recording, **more)) as base:
        page = watch.over(browser.new_page(viewport=SIZE), base)
        page.route("**/chart.*", answer)
        page.goto(f"{base}/chart.html{asked}")
        page.wait_for_selector("[data-ready]")
        yield page
        page.close()
    watch.saw_nothing()


@pytest.fixture(scope="module")
def chart(browser, recording):
    with chart_in(browser, recording) as page:
        yield page


def entity(at, **values):
    known = {"kind": "UAV", "course": 45.0, "speed": 20.0, "seen": NOW, "believed": None, "actual": None}
    return known | {"at": at, "differs": False, "named": True, "vehicle": True, "source": "sim"} | values


PLACE = {"kind": "Location", "ring": SEARCH, "parent": None, "altitude": None, "differs": False}


def state(entities, **sections):
    return {"places": {"search": PLACE}, "entities": entities, "clock": {"now": NOW}} | sections


def show(page, shown):
    page.evaluate(
        "s => { map.follow(null); map.choose(null); store.apply({type: 'snapshot', state: s}); map.fit(); }",
        shown,
    )


def change(chart, sections, then="null"):
    """Take in changes, draw at once, and return the value of a script."""
    frame = {"type": "changes", "set": sections}
    return chart.evaluate(f"c => {{ store.apply(c); map.drawn(); return {then}; }}", frame)


def at_screen(chart, x, y):
    return x, y + chart.evaluate("document.querySelector('.map-leaflet').getBoundingClientRect().top")


def at_uav0(chart):
    return chart.evaluate("map.pointOf('uav0')")


def test_a_vehicle_is_hit_and_clicked_where_it_is_drawn_and_stays_in_the_middle_when_followed(chart):
    show(chart, state({"uav0": entity([37.0, -8.7])}))
    is_hit_with_its_place_around_it(chart)
    is_chosen_by_a_click_and_nothing_by_a_click_beside(chart)
    is_followed(chart)


def is_hit_with_its_place_around_it(chart):
    x, y = at_uav0(chart)
    hit = [chart.evaluate("at => map.hit(...at)", at) for at in ([x, y], [x + 60, y])]
    assert hit == [{"name": "uav0", "section": "entities"}, {"name": "search", "section": "places"}]


def is_chosen_by_a_click_and_nothing_by_a_click_beside(chart):
    show(chart, state({"uav0": entity([37.0, -8.7])}, places={}))
    x, y = at_screen(chart, *at_uav0(chart))
    chart.evaluate("heard.selected.length = 0")
    chart.mouse.click(x, y)
    chart.mouse.click(x + 200, y)
    until(chart, "heard.selected.length === 2")
    assert chart.evaluate("heard.selected") == ["uav0", None]


def is_followed(chart):
    chart.evaluate("map.follow('uav0')")
    x, y = change(chart, {"entities": {"uav0": entity([37.03, -8.61])}}, "map.pointOf('uav0')")
    assert (x, y) == (pytest.approx(400, abs=1.5), pytest.approx(300, abs=1.5))


def test_places_around_the_antimeridian_are_drawn_whole(chart):
    ring = [[-17.0, 179.8], [-17.0, -179.8], [-16.8, -179.8], [-16.8, 179.8]]
    show(chart, state({"uav0": entity([-16.9, -179.9])}, places={"strait": PLACE | {"ring": ring}}))
    _, west, _, east = chart.evaluate("map.drawn().window")
    assert east - west < 2
    assert chart.evaluate("map.hit(400, 300)")["name"] == "strait"


def test_a_hostile_name_is_never_markup(chart):
    name = "<img src=x onerror=\"document.title='owned'\">\u202e"
    show(chart, state({name: entity([37.0, -8.7])}))
    chart.mouse.move(*at_screen(chart, *chart.evaluate("name => map.pointOf(name)", name)))
    chart.locator(".map-tip div:first-child", has_text="<img src=x").wait_for()
    assert (chart.query_selector("#map img"), chart.title()) == (None, "The chart alone")


def test_a_measured_distance_is_that_of_the_ellipsoid(chart):
    for ends in [
        ((37.0, -8.7), (37.1, -8.5)),
        ((0.0, 0.0), (0.0, 1.0)),
        ((80.0, 10.0), (89.0, 10.0)),
        ((-17.0, 179.9), (-16.0, -179.5)),
        ((60.0, -5.0), (-30.0, 120.0)),
    ]:
        (north, east), (north2, east2) = ends
        forward, _, metres = Geod(ellps="WGS84").inv(east, north, east2, north2)
        script = "([a, b]) => [geodesy.distance(a, b), geodesy.bearing(a, b)]"
        measured, degrees = chart.evaluate(script, ends)
        assert measured == pytest.approx(metres, rel=0.005)
        assert abs((degrees - forward + 180) % 360 - 180) < 0.5


def test_a_measured_way_snaps_to_things_and_a_followed_one_is_not_counted_twice(chart):
    show(chart, state({"uav0": entity([37.0, -8.7])}))
    (x, y), (west, north) = chart.evaluate("[map.pointOf('uav0'), map.pixelOf([37.04, -8.79])]")
    chart.evaluate("map.measure(true)")
    chart.mouse.click(*at_screen(chart, x + 5, y - 4))
    chart.mouse.click(*at_screen(chart, west + 4, north + 3))
    forward, _, metres = Geod(ellps="WGS84").inv(-8.7, 37.0, -8.79, 37.04)
    says(chart, ".map-measured", f"{metres / 1852:.2f} nm {forward % 360:.0f}°")
    chart.evaluate("map.follow('uav0')")
    change(chart, {"entities": {"uav0": entity([37.03, -8.61])}})
    says(chart, ".map-measured", re.compile(r"^[\d.]+ nm \d+°, in all [\d.]+ nm$"))
    band = chart.inner_text(".map-measured")
    chart.mouse.click(*at_screen(chart, west + 4, north + 3))
    clicked = chart.inner_text(".map-measured")
    chart.evaluate("map.measure(false); map.follow(null)")
    assert clicked == band


BOXES = "map.drawn().labels.map(({corner: [x, y], size: [w, h]}) => [x, y, x + w, y + h])"


def overlap(one, other, by=0.5):
    (left, top, right, bottom), (west, north, east, south) = one, other
    return left < east - by and west < right - by and top < south - by and north < bottom - by


def test_labels_lie_neither_over_one_another_nor_under_what_covers_the_chart(chart):
    show(chart, state(crowd(0)))
    boxes = chart.evaluate(BOXES)
    assert len(boxes) > 20
    assert [(one, other) for one, other in combinations(boxes, 2) if overlap(one, other)] == []
    show(chart, state({f"uav{n}": entity([36.95 + n % 5 / 60, -8.77 + n // 5 / 25]) for n in range(20)}))
    chart.evaluate("map.toggleLegend()")
    legend = chart.locator(".map-legend").bounding_box()
    boxes = change(chart, {"clock": {"now": NOW + 5}}, BOXES)
    says(chart, ".map-legend li:first-child", "a vehicle, its nose where it heads")
    chart.evaluate("map.toggleLegend()")
    left, upper = legend["x"], legend["y"] - at_screen(chart, 0, 0)[1]
    covered = (left, upper, left + legend["width"], upper + legend["height"])
    assert len(boxes) > 3
    assert [box for box in boxes if overlap(box, covered, by=0)] == []


def crowd(moment, count=1_100, vehicles=100):
    """Return many that move, the first of them vehicles."""
    return {
        f"{'v' if n < vehicles else 'ship'}{n:04}": entity(
            [36.7 + (n % 33) / 50 + moment / 5_000, -9.0 + (n // 33) / 50],
            vehicle=n < vehicles,
            kind="UAV" if n < vehicles else "Ship",
            course=(7.0 * n + moment) % 360,
            source="sim" if n < vehicles else "ais",
        )
        for n in range(count)
    }


INK = """([x, y, size]) => map.drawn() && [...document.querySelectorAll('.map-canvas')].reduce((ink, canvas) => {
  const pixels = canvas.getContext('2d').getImageData(x, y, size, size).data;
  for (let at = 3; at < pixels.length; at += 4) ink += pixels[at] > 60;
  return ink;
}, 0)"""


def test_a_track_is_drawn_and_what_differs_is_dashed(chart):
    show(chart, state({"uav0": entity([37.0, -8.7])}, places={}))
    way = [[37.0, -8.72], [37.0, -8.71], [37.0, -8.7]]
    x, y = (round(each) for each in chart.evaluate("map.pointOf('uav0')"))
    beside = [x - 60, y - 3, 6]
    assert chart.evaluate(INK, beside) == 0
    change(chart, {"tracks": {"uav0#0": way}})
    assert chart.evaluate(INK, beside) > 0
    show(chart, state({}))
    whole = chart.evaluate(INK, [0, 0, 800])
    show(chart, state({}, places={"search": PLACE | {"differs": True}}))
    dashed = chart.evaluate(INK, [0, 0, 800])
    assert dashed != whole


RESTS = """async () => {
  const before = map.drawn().frames;
  for (let n = 0; n < 20; n++) await new Promise(requestAnimationFrame);
  return map.drawn().frames - before;
}"""


def test_a_thousand_targets_move_and_where_nothing_moves_nothing_is_drawn(chart):
    show(chart, state(crowd(0)))
    moments = [{"entities": crowd(100 * n)} for n in range(3)]
    heights = [change(chart, each, "map.pointOf('v0001')")[1] for each in moments]
    assert heights == sorted(set(heights), reverse=True)
    assert chart.evaluate(RESTS) <= 1  # this look draws what is left


def one_tile(path):
    """Write an archive with one tile, all of the Earth in red."""
    pmtiles = pytest.importorskip("pmtiles.writer", reason="pmtiles is not installed")
    tile = pytest.importorskip("pmtiles.tile")
    image = io.BytesIO()
    Image.new("RGB", (256, 256), (255, 0, 0)).save(image, "PNG")
    bounds = {"min_lon_e7": -1_800_000_000, "max_lon_e7": 1_800_000_000}
    bounds |= {"min_lat_e7": -850_000_000, "max_lat_e7": 850_000_000, "center_zoom": 0}
    bounds |= {"center_lon_e7": 0, "center_lat_e7": 0, "min_zoom": 0, "max_zoom": 0}
    kind = {"tile_type": tile.TileType.PNG, "tile_compression": tile.Compression.NONE}
    with pmtiles.write(str(path)) as archive:
        archive.write_tile(0, image.getvalue())
        archive.finalize(kind | bounds, {"attribution": "<b>the red office</b>"})
    return path


def test_tiles_are_drawn_under_the_chart_and_their_makers_named(browser, recording, tmp_path):
    with chart_in(browser, recording, "?tiles", tiles=one_tile(tmp_path / "red.pmtiles")) as page:
        page.wait_for_selector(".leaflet-tile-loaded")
        page.evaluate("map.look([0, 0], 1)")
        page.locator(".map-credit", has_text="Tiles: the red office").wait_for()
        while not is_red(page):  # it fades in
            page.wait_for_timeout(50)


def is_red(page):
    red, green, blue = Image.open(io.BytesIO(page.screenshot())).getpixel((300, 200))[:3]
    return red > 200 and green < 80 and blue < 80
