"""A self-contained page that steps through a trace: its lanes, beside the bigraph and the map."""

import base64
import hashlib
from collections.abc import Iterator, Mapping, Sequence
from importlib.resources import files as resources
from itertools import pairwise
from typing import Final

from bigactors.pages.markup import element, text
from bigactors.pages.story import PageContent, PageFrame, Story, telling
from bigactors.pictures import Look, Panel, channels_of, look_of, shown_names, way_entries
from bigraphs import Bigraph, draw_text
from bigraphs.drawing import HIGHLIGHT
from checker.properties.race_steps import RaceSteps
from checker.reports.lanes import Lanes, LaneStep, Repetition, Row, lapses, steps_of
from physical.map_style import BROKEN, MARK, QUIET
from physical.wordings import counted
from semantics.state.printing import print_agent
from semantics.timing.dates import lapse_text

LARGEST: Final = 1.35
"""The most pixels for a point of a picture."""

SMALLEST: Final = {"L": 0.65, "P": 0.9}
"""Pixels for a point of a picture on a phone, where it scrolls sideways."""

LEAST_LAPSE, MOST_LAPSE = 18, 150
"""The height in pixels of the shortest and of the longest gap between steps in a trace."""

NARROWEST: Final = 7
"""The least width of a lane in ems; its boxes may reach over the next lane."""


UNSCRIPTED: Final = (
    "[hidden], .unscripted { display: revert !important; } "
    ".controls, .hint, .several button, #missing { display: none !important; }"
)
"""The style of a page without scripts: it shows everything at once."""


def trace_page(story: Story) -> str:
    """Return the page of a story."""
    return page_of(telling(story))


def page_of(told: PageContent) -> str:
    """Return the page of its content."""
    script, style = _resource("trace.js"), _resource("trace.css")
    allowed = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    policy = (
        f"default-src 'none'; style-src 'unsafe-inline'; script-src 'sha256-{allowed}'; "
        "base-uri 'none'; form-action 'none'"
    )
    head = element(
        "head",
        '<meta charset="utf-8">',
        f'<meta http-equiv="Content-Security-Policy" content="{policy}">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        element("title", text(told.story.title)),
        element("style", style),
        element("noscript", element("style", UNSCRIPTED)),
    )
    main = element("main", _stage(told), _run(told), **_steps(told))
    start = {"data_start": told.story.start, "data_loop": told.story.trace.loop}
    body = element("body", _header(told), main, element("script", script), **start)
    return f"<!DOCTYPE html>\n{element('html', head, body, lang='en')}\n"


def _steps(told: PageContent) -> dict[str, str | None]:
    """Return the script's data: the frame of each configuration, and the tenths of a second since the last."""
    order = " ".join("" if frame is None else str(frame) for frame in told.order)
    tenths = [round(10 * second) for second in told.seconds]
    gaps = (str(max(0, after - before)) for before, after in pairwise([0, *tenths]))
    return {"data_order": order, "data_tenths": " ".join(gaps) or None}


def _resource(name: str) -> str:
    return (resources("bigactors.pages") / name).read_text(encoding="utf-8")


def _header(told: PageContent) -> str:
    story = told.story
    return element(
        "header",
        element("h1", text(story.title)),
        element("p", text(story.about), class_="violated" if story.violated else None) if story.about else "",
        *(element("p", text(line)) for line in story.details),
        _race(story.trace.race),
        element("p", text(f"{counted(len(story.trace), 'step')}. {story.note}"), class_="quiet"),
        *(element("p", text(line), class_="violated") for line in told.left_out),
    )


def _race(race: RaceSteps | None) -> str:
    """Return links to the three steps of a stale-observation race."""
    if race is None:
        return ""
    links = (
        f"{element('a', text(role), href=f'#c{number}')} c{number}" for number, role in race.roles.items()
    )
    return element("p", "the race: ", " → ".join(links), class_="race")


# --- lanes ----------------------------------------------------------------------------------------------------


def _run(told: PageContent) -> str:
    lanes = told.lanes
    heads = (element("th", text(name), scope="col") for name in lanes.names)
    head = element("thead", element("tr", element("th", text("c"), scope="col"), *heads))
    body = element("tbody", *_rows(told))
    foot = element("tfoot", element("tr", _end(lanes))) if lanes.end else ""
    return element(
        "section",
        element("table", head, body, foot, style=f"min-width: {4 + NARROWEST * len(lanes.names)}em"),
        element("template", *_others(told), id="others"),
        class_="run",
        aria_label="The run, a lane for each agent",
    )


def _rows(told: PageContent) -> Iterator[str]:
    """Yield the rows: of the first configuration, of single steps, and of folded steps."""
    seconds = told.seconds
    passing = lapses(told.rows)
    longest = max(passing, default=0)
    yield _row(0, told.lanes, None, seconds, data_row=0, data_frame_row=told.order[0])
    for row, lapse in zip(told.rows, passing, strict=True):
        more: dict[str, object] = {"data_row": row.number, "data_frame_row": told.order[row.number]}
        if isinstance(row, Repetition):
            more = {"data_from": row.number, "data_to": row.last}
        if lapse:
            height = max(LEAST_LAPSE, MOST_LAPSE * lapse / longest)
            more |= {"class_": "later", "style": f"--gap: {height:.0f}px; --lapse: '+ {lapse_text(lapse)}'"}
        yield _row(row.number, told.lanes, row, seconds, **more)


def _others(told: PageContent) -> Iterator[str]:
    """Yield a row for each frame outside the table: the script inserts them when it unfolds steps."""
    shown = {told.order[row.number] for row in told.rows if isinstance(row, LaneStep)}
    for place, frame in enumerate(told.frames):
        if place not in shown and frame.step is not None:
            yield _row(frame.number, told.lanes, frame.step, (), data_frame_row=place)


def _end(lanes: Lanes) -> str:
    link = element("a", text(lanes.end), href=f"#c{lanes.loop}")
    return element("td", link, colspan=len(lanes.names) + 1)


def _row(number: int, lanes: Lanes, row: Row | None, seconds: Sequence[float], **data: object) -> str:
    link = element("a", text(f"c{number}"), href=f"#c{number}")
    date = "" if row is None else steps_of(row)[0].date
    said = f"{seconds[number]:.1f} s" if seconds else date
    time = element("small", text(said)) if said else ""
    cells = [element("td")] * len(lanes.names) if row is None else _cells(row, lanes)
    return element("tr", element("th", link, time, scope="row"), *cells, **data)


def _cells(row: Row, lanes: Lanes) -> Iterator[str]:
    for lane in range(len(lanes.names)):
        if lane == row.lane:
            box = _several(row) if isinstance(row, Repetition) else _step(row)
            yield element("td", box, class_=_side(lane, len(lanes.names)))
        else:
            yield element("td")


def _side(lane: int, count: int) -> str | None:
    """Return the side to which a box may overflow its lane: right in the first, left in the last, else both."""
    if lane == 0:
        return None
    return "last" if lane == count - 1 else "inner"


def _step(step: LaneStep) -> str:
    sort = "serves" if step.serves else "environment" if step.label.agent is None else ""
    changes = (
        element("li", element("span", text(change.part), class_="part"), text(change.text))
        for change in step.changes
    )
    return element(
        "div",
        element("b", text(step.label.rule)),
        element("strong", text(step.role), class_="role") if step.role else "",
        element("div", text(step.about), class_="about") if step.about else "",
        element("ul", *changes) if step.changes else "",
        class_=" ".join(filter(None, ["step", sort, step.role and "raced"])),
    )


def _several(row: Repetition) -> str:
    return element(
        "div",
        element("b", text(row.heading)),
        element("div", text(row.about), class_="about"),
        element("div", "", class_="now"),
        element(
            "button", text("unfold"), type="button", aria_expanded="false", hidden=True, data_scripted=True
        ),
        class_="step several",
    )


# --- the stage ------------------------------------------------------------------------------------------------


def _stage(told: PageContent) -> str:
    frames = told.frames
    drawn = (panel for frame in frames for panel in (frame.logical, frame.physical))
    panels = dict(sorted((panel.key, panel) for panel in drawn if panel is not None))
    models = element(
        "div",
        _model("L", "the logical model: beliefs", [p for p in panels.values() if p.key[0] == "L"]),
        _model("P", "the physical model: reality", [p for p in panels.values() if p.key[0] == "P"]),
        class_="models",
    )
    believed = dict.fromkeys(frame.c.structure.logical.bigraph() for frame in frames)
    words = {bigraph: place for place, bigraph in enumerate(believed)}
    return element(
        "section",
        _controls(len(told.order) - 1),
        element("p", "", class_="caption", id="caption", aria_live="polite"),
        element("p", "", id="names", role="status", hidden=True),
        models,
        element("p", "", class_="quiet", id="missing", hidden=True),
        *(_frame(place, frame, words) for place, frame in enumerate(frames)),
        element(
            "details",
            element("summary", text("L in words")),
            *(
                element("pre", text(draw_text(bigraph)), tabindex="0", data_words=place, hidden=True)
                for bigraph, place in words.items()
            ),
            id="words",
        ),
        _legend(told),
        class_="stage",
        aria_label="One configuration",
    )


def _controls(last: int) -> str:
    def button(name: str, sign: str, says: str) -> str:
        return element("button", text(sign), type="button", id=name, title=says, aria_label=says)

    slider = (
        f'<input type="range" id="step" min="0" max="{last}" value="0" step="1" aria-label="configuration">'
    )
    return element(
        "div",
        element("button", text("Play"), type="button", id="play", aria_pressed="false", title="play (space)"),
        button("first", "⇤", "first configuration (Home)"),
        button("back", "←", "one step back (left arrow)"),
        button("next", "→", "one step on (right arrow)"),
        button("last", "⇥", "last configuration (End)"),
        slider,
        element("output", "", id="number", for_="step"),
        '<input type="search" id="find" placeholder="find in the steps" aria-label="find in the steps; Enter goes on">',
        element("output", "", id="found", for_="find", aria_live="polite"),
        class_="controls",
        data_scripted=True,
        hidden=True,
    )


def _model(name: str, gloss: str, panels: Sequence[Panel]) -> str:
    width = max((panel.picture.width for panel in panels), default=1.0)
    height = max((panel.picture.height for panel in panels), default=1.0)
    sheet = element(
        "div",
        *(_svg(panel, name, width, height) for panel in panels),
        class_="sheet logical" if name == "L" else "sheet",
    )
    head = element("h2", text(name), " ", element("small", text(gloss)))
    return element("figure", head, sheet if panels else "")


def _svg(panel: Panel, name: str, width: float, height: float) -> str:
    """Return a picture centred on a sheet of the largest size, so that nothing moves between two steps."""
    left, top = (panel.picture.width - width) / 2, (panel.picture.height - height) / 2
    return element(
        "svg",
        panel.picture.shapes,
        viewBox=f"{left:g} {top:g} {width:g} {height:g}",
        role="img",
        aria_label=f"{'the bigraph of L' if name == 'L' else 'the map of P'}; in words below",
        style=f"max-width: {width * LARGEST:.0f}px; --least: {width * SMALLEST[name]:.0f}px",
        data_picture=panel.key,
        hidden=True,
    )


def _frame(place: int, frame: PageFrame, words: Mapping[Bigraph, int]) -> str:
    agents = [print_agent(frame.c, a) for a in frame.c.alpha.names()]
    requests = [str(each.request) for each in frame.c.eta.all()]
    before = frame.before
    known = set() if before is None else {print_agent(before, a) for a in before.alpha.names()}
    asked = set() if before is None else {str(each.request) for each in before.eta.all()}
    first = before is None
    lists = element(
        "div",
        _list("α", "agents", agents, set(agents) if first else known),
        _list("η", "pending requests", requests or ["∅"], {"∅", *(requests if first else asked)}),
        class_="lists",
    )
    again = f", and {frame.count - 1:,} times more" if frame.count > 1 else ""
    said = f"{frame.label}{f' [{frame.role}]' if frame.role else ''}"
    return element(
        "div",
        element("h2", text(f"c{frame.number}: {said}{again}"), class_="unscripted"),
        lists,
        data_frame=place,
        data_label=said,
        data_l="" if frame.logical is None else frame.logical.key,
        data_p="" if frame.physical is None else frame.physical.key,
        data_in_words=words[frame.c.structure.logical.bigraph()],
        hidden=True,
    )


def _list(name: str, gloss: str, lines: Sequence[str], known: set[str]) -> str:
    items = (element("li", text(line), class_=None if line in known else "new") for line in lines)
    return element(
        "div", element("h2", text(name), " ", element("small", text(gloss))), element("ul", *items)
    )


# --- the legend -----------------------------------------------------------------------------------------------


def _legend(told: PageContent) -> str:
    frames = told.frames
    looks = [look_of(frame.c, frame.before) for frame in frames]
    kinds = sorted({frame.c.setting.kind(name) for frame in frames for name in shown_names(frame.c)})
    channels = sorted({channel for frame in frames for channel in channels_of(frame.c)})
    entries = [
        *(_entry(kind, "rect", looks[0].palette.kinds[kind]) for kind in kinds),
        *(_entry(channel, "line", _channel_colour(channel, looks)) for channel in channels),
        _entry("changed in this step", "glow", HIGHLIGHT),
        _entry("L and P differ", "mark", MARK),
    ]
    keys = "keys: ← → one step, j k one row, Home End first and last, space plays, / finds"
    hint = element("li", text(keys), class_="hint")
    return element("ul", *entries, *_way_entries(told), hint, class_="legend")


def _way_entries(told: PageContent) -> Iterator[str]:
    """Yield the entries for regions that some map shows."""
    marks = told.story.marks
    ways = [] if marks is None else [marks.ways(frame.c) for frame in told.frames]
    for look, words in dict.fromkeys(entry for each in ways for entry in way_entries(each)):
        yield _entry(words, look, {"breach": BROKEN}.get(look, QUIET))


def _channel_colour(channel: str, looks: Sequence[Look]) -> str:
    return next(look.palette.channels[channel] for look in looks if channel in look.palette.channels)


def _entry(words: str, look: str, colour: str) -> str:
    shapes = {
        "rect": f'<rect x="2" y="1" width="11" height="10" rx="2" fill="{colour}"/>',
        "line": f'<path d="M0 6H16" stroke="{colour}" stroke-width="2.5"/>',
        "glow": f'<circle cx="8" cy="6" r="5.5" fill="{colour}" fill-opacity=".35"/>',
        "mark": f'<rect x="2" y="1.5" width="12" height="9" rx="2" fill="none" stroke="{colour}" '
        'stroke-width="1.5" stroke-dasharray="3 2"/>',
        "region": f'<rect x="1" y="1.5" width="14" height="9" rx="2" fill="{colour}" fill-opacity=".2" '
        f'stroke="{colour}" stroke-width="1.2"/>',
        "breach": f'<rect x="1" y="1.5" width="14" height="9" rx="2" fill="{colour}" fill-opacity=".4" '
        f'stroke="{colour}" stroke-width="1.2"/>',
        "limit": f'<rect x="1" y="1.5" width="14" height="9" rx="2" fill="none" stroke="{colour}" '
        'stroke-width="1.2" stroke-dasharray="1.5 2"/>',
    }
    return element("li", f'<svg viewBox="0 0 16 12" aria-hidden="true">{shapes[look]}</svg>', text(words))
