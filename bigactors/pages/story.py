"""A self-contained page that steps through a trace: the explorer of the studio, with the run inside the file."""

from __future__ import annotations

import base64
import hashlib
import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import chain, islice
from typing import Any, Final

from bigactors.pages.markup import element, text
from bigactors.pages.scripts import script, style
from bigactors.pictures import Panels, RegionMarks, draw_overview, legend_picture
from bigactors.studio.run_views import parts_json, places_text, run_json, text_of
from bigactors.studio.values_here import Visit, values_here
from checker import Trace
from checker.reports.causes import Cause
from checker.reports.lanes import lanes_of_trace
from checker.reports.results import clean
from physical.wordings import counted
from semantics.properties.property import Property
from semantics.successors import Expansion

MOST_PICTURES: Final = 100
"""The most pictures of each model in a page."""

MOST_FRAMES: Final = 2_000
"""The most different configurations in a page."""

MOST_UNSCRIPTED: Final = 200
"""The longest trace whose lanes are drawn for readers without scripts."""


@dataclass(frozen=True, slots=True)
class Story:
    """The input of a trace's page.

    Attributes:
        title: The title.
        headline: What the trace shows, in a few plain words; may be empty.
        violated: Whether that is a violation.
        trace: The trace.
        start: The number of the configuration shown first.
        causes: The causes of what the trace ends in.
        drawn: The most pictures of each model. They show the configurations nearest to the start; if it is 0, the last
            ones.
        notes: The lines of the foot: the claim in the notation of reports, and the origin with its digest.
        times: The time of each step in seconds; empty if unknown.
        unfolded: Whether repeated steps have a row each.
        marks: The regions that the maps show.
        properties: The properties whose value is shown in each configuration.
    """

    title: str
    headline: str
    violated: bool
    trace: Trace
    start: int = 0
    causes: tuple[Cause, ...] = ()
    drawn: int = MOST_PICTURES
    notes: tuple[str, ...] = ()
    times: tuple[float, ...] = ()
    unfolded: bool = False
    marks: RegionMarks | None = None
    properties: tuple[Property, ...] = ()


@dataclass(frozen=True, slots=True)
class PageContent:
    """The content of a page: its story, the data of its script, and the lines on what it leaves out."""

    story: Story
    data: dict[str, Any]
    left_out: tuple[str, ...]


def trace_page(story: Story) -> str:
    """Return the page of a story."""
    return page_of(telling(story))


def telling(story: Story) -> PageContent:
    """Return the content of a story's page; of a long story, the ends and the part around the start."""
    trace = story.trace
    first = _first_alike(trace)
    held = sorted(islice(dict.fromkeys(first[n] for n in _by_weight(len(first), story.start)), MOST_FRAMES))
    places = {number: place for place, number in enumerate(held)}
    order = [places.get(number) for number in first]
    pictures, looks = _looks(story, held)
    data = _compact(run_json(trace, story.causes), story.unfolded) | {
        "start": story.start,
        "order": order,
        "looks": looks,
        "pictures": pictures,
        "dates": [trace.date(n) for n in range(len(trace))] if trace.dates else [],
        "moments": list(trace.moments)
        or [round(1000 * max(0.0, each - story.times[0])) for each in story.times],
        "roles": {} if trace.race is None else trace.race.roles,
    }
    return PageContent(story, data, tuple(_left_out(order, looks)))


def _first_alike(trace: Trace) -> tuple[int, ...]:
    """Return for each configuration the first identical one: it follows the same configuration by the same step."""
    configurations, labels = trace.configurations, ("", *(str(step.label) for step in trace.steps))
    first: dict[object, int] = {}
    looks = zip((None, *configurations), configurations, labels, strict=False)
    return tuple(first.setdefault(look, number) for number, look in enumerate(looks))


def _by_weight(count: int, start: int) -> Iterable[int]:
    """Return the numbers of configurations: both ends and the start, then those nearest to them."""
    ends = {0, count - 1, start}
    return chain(sorted(ends), sorted(range(count), key=lambda n: min(abs(n - end) for end in ends)))


def _looks(story: Story, held: Sequence[int]) -> tuple[list[str], list[dict[str, Any]]]:
    """Return the pictures, and for each configuration its parts, with the numbers of its pictures."""
    configurations = story.trace.configurations
    panels = Panels.of(configurations, min(story.drawn, MOST_PICTURES), story.marks)
    asked = [each for each in story.properties if each.kind.has_proposition]
    pictures: dict[str, int] = {}
    found = {}
    for number in sorted(held, key=lambda number: abs(number - (story.start or len(configurations)))):
        c, before = configurations[number], configurations[number - 1] if number else None
        drawn = (panels.logical(c, before), panels.physical(c, before))
        legend = None if None in drawn else legend_picture(c, before, story.marks)
        found[number] = {
            "parts": parts_json(c, before),
            "values": values_here(asked, Visit(c, Expansion((), ()), (), raced=False)),
            "pictures": [
                None if svg is None else pictures.setdefault(svg, len(pictures))
                for svg in (*(None if each is None else each.svg for each in drawn), legend)
            ],
            "text": text_of(c),
            "places": places_text(c),
        }
    return list(pictures), [found[number] for number in held]


def _compact(run: dict[str, Any], unfolded: bool) -> dict[str, Any]:
    """Return a run in which equal steps are stored once."""
    deeds: dict[str, int] = {}
    for step in run["steps"]:
        deed = json.dumps(
            {key: value for key, value in step.items() if key not in ("date", "at", "role", "cause")}
        )
        step["deed"] = deeds.setdefault(deed, len(deeds))
    steps = [step["deed"] for step in run["steps"]]
    folds = [] if unfolded else run["folds"]
    return run | {"steps": steps, "deeds": list(map(json.loads, deeds)), "folds": folds}


def _left_out(order: Sequence[int | None], looks: Sequence[dict[str, Any]]) -> Iterable[str]:
    missing = [number for number, frame in enumerate(order) if frame is None]
    undrawn = sum(frame is not None and None in looks[frame]["pictures"] for frame in order)
    of = f"of {counted(len(order), 'configuration')}"
    remedy = "a page made by `show` with --step K has those around c_K"
    if missing:
        yield f"left out: {len(missing):,} {of}, between c{missing[0]} and c{missing[-1]}: {remedy}"
    if undrawn:
        yield f"not drawn: {undrawn:,} {of}: {remedy}"


# --- markup ---------------------------------------------------------------------------------------------------


def page_of(told: PageContent) -> str:
    """Return the page of its content; without scripts it has the story, the lanes and the last pictures."""
    story, code = told.story, script()
    allowed = base64.b64encode(hashlib.sha256(code.encode()).digest()).decode()
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
        element("style", style()),
    )
    notes = (counted(len(story.trace), "step"), *story.notes, *told.left_out)
    body = element(
        "body",
        element("header", element("h1", text(story.title)), _headline(story)),
        element("main", _unscripted(told)),
        element("footer", *(element("p", text(line)) for line in notes)),
        element("script", _data(told.data), type="application/json", id="run"),
        element("script", code) if code else "",
    )
    return f"<!DOCTYPE html>\n{element('html', head, body, lang='en')}\n"


def _headline(story: Story) -> str:
    return (
        element("p", text(story.headline), class_="violated" if story.violated else None)
        if story.headline
        else ""
    )


def _data(data: dict[str, Any]) -> str:
    """Return data as text inside a script element, which no name can end."""
    return clean(json.dumps(data, ensure_ascii=False, separators=(",", ":"))).replace("<", "\\u003c")


def _unscripted(told: PageContent) -> str:
    """Return what the page shows before its script runs, and without it."""
    story = told.story
    causes = " · ".join(
        f"{text(cause.text)} {'at' if cause.is_step else 'after'} step {cause.number}"
        for cause in story.causes
    )
    here = told.data["order"][story.start]
    numbers = [] if here is None else told.data["looks"][here]["pictures"]
    pictures = [told.data["pictures"][number] for number in numbers if number is not None]
    if len(story.trace) <= MOST_UNSCRIPTED:
        pictures.append(draw_overview(lanes_of_trace(story.trace), unfolded=story.unfolded).svg)
    return element(
        "div", element("p", causes, class_="story") if causes else "", *pictures, class_="unscripted"
    )
