"""The console's chart in a browser, alone with a store that the tests fill."""

import importlib.util
import io
import re
from pathlib import Path

import pytest
from browsers import Watch, chromium
from PIL import Image
from pyproj import Geod

HERE = Path(__file__).parent
NOW = 1_800_000_000.0
SEARCH = [[36.94, -8.79], [36.94, -8.59], [37.04, -8.59], [37.04, -8.79]]


def load_serving():
    spec = importlib.util.spec_from_file_location("map_serving", HERE / "serving.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


serving = load_serving()


def entity(at, **values):
    known = {"kind": "UAV", "course": 45.0, "speed": 20.0, "seen": NOW, "believed": None, "actual": None}
    return known | {"at": at, "differs": False, "named": True, "vehicle": True, "source": "sim"} | values


def state(entities, **sections):
    places = {
        "search": {"kind": "Location", "ring": SEARCH, "parent": None, "altitude": None, "differs": False}
    }
    return {"places": places, "entities": entities, "clock": {"now": NOW}} | sections


@pytest.fixture(scope="module")
def browser():
    if not (serving.PAGE / "parts" / "leaflet.js").exists():
        pytest.skip("the page has no parts: `make parts` fetches them")
    with chromium() as found:
        yield found


@pytest.fixture(scope="module")
def chart(browser):
    watch = Watch()
    with serving.serving() as (base, _):
        page = watch.over(browser.new_page(viewport={"width": 800, "height": 600}), base)
        page.goto(f"{base}/chart.html")
        page.wait_for_selector("[data-ready]")
        yield page
        page.close()
    watch.saw_nothing()


def show(page, shown):
    page.evaluate(
        "s => { map.follow(null); map.choose(null); store.apply({type: 'snapshot', state: s}); map.fit(); }",
        shown,
    )


def test_a_vehicle_is_hit_where_it_is_drawn_and_its_place_around_it(chart):
    show(chart, state({"uav0": entity([37.0, -8.7])}))
    assert chart.evaluate("map.hit(...map.pointOf('uav0'))") == {"name": "uav0", "section": "entities"}
    assert chart.evaluate("(([x, y]) => map.hit(x + 60, y))(map.pointOf('uav0'))") == {
        "name": "search",
        "section": "places",
    }


def test_a_followed_vehicle_stays_in_the_middle(chart):
    show(chart, state({"uav0": entity([37.0, -8.7])}))
    chart.evaluate("map.follow('uav0')")
    change = {"type": "changes", "set": {"entities": {"uav0": entity([37.03, -8.61])}}}
    x, y = chart.evaluate("c => { store.apply(c); return map.pointOf('uav0') }", change)
    assert (x, y) == (pytest.approx(400, abs=1.5), pytest.approx(300, abs=1.5))


def test_places_around_the_antimeridian_are_drawn_whole(chart):
    ring = [[-17.0, 179.8], [-17.0, -179.8], [-16.8, -179.8], [-16.8, 179.8]]
    place = {"kind": "Location", "ring": ring, "parent": None, "altitude": None, "differs": False}
    show(chart, state({"uav0": entity([-16.9, -179.9])}, places={"strait": place}))
    _, west, _, east = chart.evaluate("map.drawn().window")
    assert east - west < 2
    assert chart.evaluate("map.hit(400, 300)")["name"] == "strait"


def test_a_hostile_name_is_never_markup(chart):
    name = "<img src=x onerror=\"document.title='owned'\">\u202e"
    show(chart, state({name: entity([37.0, -8.7])}))
    x, y = chart.evaluate("name => map.pointOf(name)", name)
    top = chart.evaluate("document.querySelector('.map-leaflet').getBoundingClientRect().top")
    chart.mouse.move(x, y + top)
    assert chart.inner_text(".map-tip div:first-child").startswith("<img src=x")
    assert (chart.query_selector("#map img"), chart.title()) == (None, "The chart alone")


@pytest.mark.parametrize(
    "ends",
    [
        ((37.0, -8.7), (37.1, -8.5)),
        ((0.0, 0.0), (0.0, 1.0)),
        ((80.0, 10.0), (89.0, 10.0)),
        ((-17.0, 179.9), (-16.0, -179.5)),
        ((60.0, -5.0), (-30.0, 120.0)),
    ],
)
def test_a_measured_distance_is_that_of_the_ellipsoid(chart, ends):
    (north, east), (north2, east2) = ends
    forward, _, metres = Geod(ellps="WGS84").inv(east, north, east2, north2)
    measured, degrees = chart.evaluate("([a, b]) => [geodesy.distance(a, b), geodesy.bearing(a, b)]", ends)
    assert measured == pytest.approx(metres, rel=0.005)
    assert abs((degrees - forward + 180) % 360 - 180) < 0.5


def test_a_click_chooses_what_is_under_it_and_a_click_beside_it_nothing(chart):
    show(chart, state({"uav0": entity([37.0, -8.7])}, places={}))
    x, y = chart.evaluate("map.pointOf('uav0')")
    top = chart.evaluate("document.querySelector('.map-leaflet').getBoundingClientRect().top")
    chart.evaluate("heard.selected.length = 0")
    chart.mouse.click(x, y + top)
    chart.mouse.click(x + 200, y + top)
    chart.wait_for_function("heard.selected.length === 2")
    assert chart.evaluate("heard.selected") == ["uav0", None]


def at_screen(chart, x, y):
    return x, y + chart.evaluate("document.querySelector('.map-leaflet').getBoundingClientRect().top")


def test_a_measured_way_snaps_to_things_and_a_followed_one_is_not_counted_twice(chart):
    show(chart, state({"uav0": entity([37.0, -8.7])}))
    (x, y), (west, north) = chart.evaluate("[map.pointOf('uav0'), map.pixelOf([37.04, -8.79])]")
    chart.evaluate("map.measure(true)")
    chart.mouse.click(*at_screen(chart, x + 5, y - 4))
    chart.mouse.click(*at_screen(chart, west + 4, north + 3))
    forward, _, metres = Geod(ellps="WGS84").inv(-8.7, 37.0, -8.79, 37.04)
    said = chart.inner_text(".map-measured")
    chart.evaluate("map.follow('uav0')")
    moved = {"type": "changes", "set": {"entities": {"uav0": entity([37.03, -8.61])}}}
    chart.evaluate("c => { store.apply(c); map.drawn() }", moved)
    chart.evaluate("() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
    band = chart.inner_text(".map-measured")
    chart.mouse.click(*at_screen(chart, west + 4, north + 3))
    clicked = chart.inner_text(".map-measured")
    chart.evaluate("map.measure(false); map.follow(null)")
    assert said == f"{metres / 1852:.2f} nm {forward % 360:.0f}°"
    assert re.fullmatch(r"[\d.]+ nm \d+°, in all [\d.]+ nm", band)
    assert clicked == band


def test_no_label_lies_under_what_covers_the_chart(chart):
    names = {f"uav{n}": entity([36.95 + n % 5 / 60, -8.77 + n // 5 / 25]) for n in range(20)}
    show(chart, state(names))
    chart.evaluate("map.toggleLegend()")
    legend = chart.locator(".map-legend").bounding_box()
    above = chart.evaluate("document.querySelector('.map-leaflet').getBoundingClientRect().top")
    chart.evaluate("store.apply({type: 'changes', set: {clock: {now: 1800000005}}})")
    boxes = chart.evaluate("map.drawn().labels.map(({corner: [x, y], size: [w, h]}) => [x, y, x + w, y + h])")
    assert chart.inner_text(".map-legend li:first-child") == "a vehicle, its nose where it heads"
    chart.evaluate("map.toggleLegend()")
    left, upper = legend["x"], legend["y"] - above
    right, lower = left + legend["width"], upper + legend["height"]
    assert len(boxes) > 3
    assert [
        box for box in boxes if box[0] < right and left < box[2] and box[1] < lower and upper < box[3]
    ] == []


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


def test_labels_do_not_lie_over_one_another(chart):
    show(chart, state(crowd(0)))
    boxes = chart.evaluate("map.drawn().labels.map(({corner: [x, y], size: [w, h]}) => [x, y, x + w, y + h])")
    assert len(boxes) > 20
    for n, (left, top, right, bottom) in enumerate(boxes):
        for west, north, east, south in boxes[:n]:
            assert not (
                left < east - 0.5 and west < right - 0.5 and top < south - 0.5 and north < bottom - 0.5
            )


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
    change = {"type": "changes", "set": {"tracks": {"uav0#0": way}}}
    chart.evaluate("c => { store.apply(c) }", change)
    assert chart.evaluate(INK, beside) > 0
    place = state({})["places"]["search"]
    show(chart, state({}, places={"search": place}))
    whole = chart.evaluate(INK, [0, 0, 800])
    show(chart, state({}, places={"search": place | {"differs": True}}))
    dashed = chart.evaluate(INK, [0, 0, 800])
    assert dashed != whole


RATE = """async (steps) => {
  const before = map.drawn().frames;
  const began = performance.now();
  for (const entities of steps) {
    store.apply({ type: "changes", set: { entities } });
    await new Promise((done) => setTimeout(done, 100));
  }
  let frames = 0;
  const end = performance.now() + 2000;
  let moment = 0;
  while (performance.now() < end) {
    store.apply({ type: "changes", set: { entities: steps[moment++ % steps.length] } });
    map.drawn();
    await new Promise(requestAnimationFrame);
    frames++;
  }
  return [(map.drawn().frames - before - frames) * 1000 / (end - 2000 - began), frames / 2];
}"""


def test_a_thousand_targets_move_and_where_nothing_moves_nothing_is_drawn(chart):
    """How fast is printed: on a machine that does nothing else 20 frames a second and more."""
    show(chart, state(crowd(0)))
    kept, most = chart.evaluate(RATE, [crowd(moment) for moment in range(20)])
    print(f"1,100 targets: {kept:.1f} frames a second at 10 Hz, at most {most:.1f}")  # noqa: T201
    assert most > 0
    drawn = chart.evaluate("map.drawn().frames")
    chart.wait_for_timeout(300)
    assert chart.evaluate("map.drawn().frames") <= drawn + 1  # this look draws what is left


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
    return path.read_bytes()


def test_tiles_are_drawn_under_the_chart_and_their_makers_named(browser, tmp_path):
    watch = Watch()
    with serving.serving(one_tile(tmp_path / "red.pmtiles")) as (base, _):
        page = watch.over(browser.new_page(viewport={"width": 800, "height": 600}), base)
        page.goto(f"{base}/chart.html?tiles")
        page.wait_for_selector(".leaflet-tile-loaded")
        page.evaluate("map.look([0, 0], 1)")
        page.locator(".map-credit", has_text="Tiles: the red office").wait_for()
        page.wait_for_timeout(800)
        shot = Image.open(io.BytesIO(page.screenshot()))
        red, green, blue = shot.getpixel((300, 200))[:3]
        assert (red > 200, green < 80, blue < 80) == (True, True, True)
        page.close()
    watch.saw_nothing()
