"""A self-contained page with a schedule: the timeline of all flights as a picture, and its times as a table."""

from typing import Final

from bigactors.pages.markup import element, text
from bigactors.pictures.timeline import draw_timeline
from checker.properties.schedule import Schedule
from checker.reports.times import times_rows

STYLE: Final = (
    "body{font:14px/1.5 'DejaVu Sans',Verdana,sans-serif;margin:2em auto;max-width:70em;padding:0 1em;color:#1f2933;"
    "background:#fff}.picture{overflow-x:auto}svg{max-width:100%;min-width:40em;height:auto}"
    "table{border-collapse:collapse;margin-top:1.5em}th,td{text-align:left;padding:.25em 1.5em .25em 0;"
    "border-bottom:1px solid #d8dee4;vertical-align:top}"
)


def timeline_page(schedule: Schedule, title: str) -> str:
    """Return the page of a schedule."""
    head = element(
        "head",
        '<meta charset="utf-8">',
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'\">",
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        element("title", text(title)),
        element("style", STYLE),
    )
    picture = draw_timeline(schedule, title=title).svg
    first, *rows = times_rows(schedule)
    table = element("table", _row("th", first), *(_row("td", row) for row in rows))
    body = element("body", element("div", picture, class_="picture"), table)
    return f"<!DOCTYPE html>\n{element('html', head, body, lang='en')}\n"


def _row(tag: str, cells: tuple[str, ...]) -> str:
    return element("tr", *(element(tag, text(cell)) for cell in cells))
