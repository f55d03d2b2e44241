"""One self-contained page that steps through a trace: its lanes, and beside them the bigraph and the map."""

import base64
import hashlib
from collections.abc import Iterator, Sequence
from importlib.resources import files as resources
from typing import Final

from bigactors.pages.markup import element, text
from bigactors.pages.story import Frame, Story, frames_of, latest
from bigactors.pictures import Look, Picture, channels_of, look_of, shown_names
from bigraphs import draw_text
from bigraphs.drawing import HIGHLIGHT
from checker.reports.lanes import Lanes, LaneStep, lanes_of_trace
from physical.map_style import MARK
from physical.messages import counted
from semantics.state.printing import print_agent

LARGEST: Final = 1.35
"""Pixels for a point of a picture, at the most."""

SMALLEST: Final = {"L": 0.65, "P": 0.9}
"""Pixels for a point of a picture on a phone, where it can be moved sideways."""

NARROWEST: Final = 7
"""How wide a lane is at the least, in ems; its boxes may reach over the next."""


UNSCRIPTED: Final = (
    "[hidden], .unscripted { display: revert !important; } "
    ".controls, .hint, #missing { display: none !important; }"
)
"""What a page without scripts looks like: everything is there at once."""


def trace_page(story: Story) -> str:
    """Return the page."""
    story = latest(story)
    frames, lanes = frames_of(story), lanes_of_trace(story.trace)
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
        element("title", text(story.title)),
        element("style", style),
        element("noscript", element("style", UNSCRIPTED)),
    )
    main = element("main", _stage(frames, story.first), _run(lanes, story.first))
    start = {"data_start": story.start, "data_first": story.first, "data_loop": story.trace.loop}
    body = element("body", _header(story), main, element("script", script), **start)
    return f"<!DOCTYPE html>\n{element('html', head, body, lang='en')}\n"


def _resource(name: str) -> str:
    return (resources("bigactors.pages") / name).read_text(encoding="utf-8")


def _header(story: Story) -> str:
    steps = len(story.trace) + story.first
    return element(
        "header",
        element("h1", text(story.title)),
        element("p", text(story.about), class_="violated" if story.violated else None) if story.about else "",
        *(element("p", text(line)) for line in story.details),
        element("p", text(f"{counted(steps, 'step')}. {story.note}"), class_="quiet"),
    )


# --- lanes ----------------------------------------------------------------------------------------------------


def _run(lanes: Lanes, first: int) -> str:
    heads = (element("th", text(name), scope="col") for name in lanes.names)
    head = element("thead", element("tr", element("th", text("c"), scope="col"), *heads))
    start = _row(first, [element("td")] * len(lanes.names))
    steps = (_row(first + step.number, list(_cells(step, lanes))) for step in lanes.steps)
    body = element("tbody", start, *steps)
    foot = element("tfoot", element("tr", _end(lanes))) if lanes.end else ""
    return element(
        "section",
        element("table", head, body, foot, style=f"min-width: {4 + NARROWEST * len(lanes.names)}em"),
        class_="run",
        aria_label="The run, a lane for each agent",
    )


def _end(lanes: Lanes) -> str:
    link = element("a", text(lanes.end), href=f"#c{lanes.loop}")
    return element("td", link, colspan=len(lanes.names) + 1)


def _row(number: int, cells: Sequence[str]) -> str:
    link = element("a", text(f"c{number}"), href=f"#c{number}")
    return element("tr", element("th", link, scope="row"), *cells, data_row=number)


def _cells(step: LaneStep, lanes: Lanes) -> Iterator[str]:
    for lane in range(len(lanes.names)):
        if lane == step.lane:
            yield element("td", _step(step), class_=_side(lane, len(lanes.names)))
        else:
            yield element("td")


def _side(lane: int, count: int) -> str | None:
    """Return where a box may reach over its lane: to the right from the first, to the left from the last, else both."""
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
        element("div", text(step.about), class_="about") if step.about else "",
        element("ul", *changes) if step.changes else "",
        class_=f"step {sort}".strip(),
    )


# --- the stage ------------------------------------------------------------------------------------------------


def _stage(frames: Sequence[Frame], first: int) -> str:
    pictures = {
        picture.key: picture
        for frame in frames
        for picture in (frame.logical, frame.physical)
        if picture is not None
    }
    models = element(
        "div",
        _model("L", "the logical model: what is believed", [p for p in pictures.values() if p.key[0] == "L"]),
        _model("P", "the physical model: what is", [p for p in pictures.values() if p.key[0] == "P"]),
        class_="models",
    )
    hint = "This configuration is not drawn: bigactors show --trace draws it."
    return element(
        "section",
        _controls(len(frames) - 1),
        element("p", "", class_="caption", id="caption", aria_live="polite"),
        element("p", "", id="names", role="status", hidden=True),
        models,
        element("p", text(hint), class_="quiet", id="missing", hidden=True),
        *(_frame(number, frame) for number, frame in enumerate(frames, first)),
        _legend(frames),
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


def _model(name: str, gloss: str, pictures: Sequence[Picture]) -> str:
    width = max((picture.width for picture in pictures), default=1.0)
    height = max((picture.height for picture in pictures), default=1.0)
    sheet = element(
        "div",
        *(_svg(picture, name, width, height) for picture in pictures),
        class_="sheet logical" if name == "L" else "sheet",
    )
    head = element("h2", text(name), " ", element("small", text(gloss)))
    return element("figure", head, sheet if pictures else "")


def _svg(picture: Picture, name: str, width: float, height: float) -> str:
    """Return a picture in the middle of a sheet as large as the largest, so that nothing jumps between two steps."""
    left, top = (picture.width - width) / 2, (picture.height - height) / 2
    return element(
        "svg",
        picture.shapes,
        viewBox=f"{left:g} {top:g} {width:g} {height:g}",
        role="img",
        aria_label=f"{'the bigraph of L' if name == 'L' else 'the map of P'}; in words below",
        style=f"max-width: {width * LARGEST:.0f}px; --least: {width * SMALLEST[name]:.0f}px",
        data_picture=picture.key,
        hidden=True,
    )


def _frame(number: int, frame: Frame) -> str:
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
    words = element("pre", text(draw_text(frame.c.structure.logical.bigraph())), tabindex="0")
    return element(
        "div",
        element("h2", text(f"c{number}: {frame.label}"), class_="unscripted"),
        lists,
        element("details", element("summary", text("L in words")), words),
        data_frame=number,
        data_label=frame.label,
        data_l="" if frame.logical is None else frame.logical.key,
        data_p="" if frame.physical is None else frame.physical.key,
        hidden=True,
    )


def _list(name: str, gloss: str, lines: Sequence[str], known: set[str]) -> str:
    items = (element("li", text(line), class_=None if line in known else "new") for line in lines)
    return element(
        "div", element("h2", text(name), " ", element("small", text(gloss))), element("ul", *items)
    )


# --- the legend -----------------------------------------------------------------------------------------------


def _legend(frames: Sequence[Frame]) -> str:
    looks = [look_of(frame.c, frame.before) for frame in frames]
    kinds = sorted({frame.c.setting.kind(name) for frame in frames for name in shown_names(frame.c)})
    channels = sorted({channel for frame in frames for channel in channels_of(frame.c)})
    entries = [
        *(_entry(kind, "rect", looks[0].palette.kinds[kind]) for kind in kinds),
        *(_entry(channel, "line", _channel_colour(channel, looks)) for channel in channels),
        _entry("changed in this step", "glow", HIGHLIGHT),
        _entry("L and P differ", "mark", MARK),
    ]
    keys = "keys: ← → one step, Home End first and last, space plays, / finds"
    hint = element("li", text(keys), class_="hint")
    return element("ul", *entries, hint, class_="legend")


def _channel_colour(channel: str, looks: Sequence[Look]) -> str:
    return next(look.palette.channels[channel] for look in looks if channel in look.palette.channels)


def _entry(words: str, look: str, colour: str) -> str:
    shapes = {
        "rect": f'<rect x="2" y="1" width="11" height="10" rx="2" fill="{colour}"/>',
        "line": f'<path d="M0 6H16" stroke="{colour}" stroke-width="2.5"/>',
        "glow": f'<circle cx="8" cy="6" r="5.5" fill="{colour}" fill-opacity=".35"/>',
        "mark": f'<rect x="2" y="1.5" width="12" height="9" rx="2" fill="none" stroke="{colour}" '
        'stroke-width="1.5" stroke-dasharray="3 2"/>',
    }
    return element("li", f'<svg viewBox="0 0 16 12" aria-hidden="true">{shapes[look]}</svg>', text(words))
