"""HTML markup: elements are written so that no text of a mission can become markup."""

from html import escape

from checker.reports.results import clean


def text(words: object) -> str:
    r"""Return words as text of a page: escaped, with invalid characters replaced.

    >>> text('<b>&"\x00')
    '&lt;b&gt;&amp;&quot;�'
    """
    return escape(clean(str(words)))


def element(tag: str, *inside: str, **attributes: object) -> str:
    """Return an element around markup; attributes are text, and `_` in their names becomes a hyphen.

    >>> element("li", text("a < b"), class_="new", data_row=3)
    '<li class="new" data-row="3">a &lt; b</li>'
    """
    words = "".join(
        f" {name.rstrip('_').replace('_', '-')}" + ("" if value is True else f'="{text(value)}"')
        for name, value in attributes.items()
        if value is not None and value is not False
    )
    return f"<{tag}{words}>{''.join(inside)}</{tag}>"
