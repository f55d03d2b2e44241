"""The reference pages of the public Python names: examples, then each name with its signature and docstring."""

import inspect
import re
from collections.abc import Iterable, Iterator
from enum import EnumType
from importlib import import_module
from pathlib import Path
from types import UnionType
from typing import Any, Final

from adapters.plugin import __name__ as plugin
from bigraphs import __name__ as bigraphs
from physical import __name__ as physical

FOLDER: Final = Path(__file__).parent.parent / "docs" / "reference" / "python"
"""The folder of the examples, one text file a page."""

PAGES: Final = {
    "bigactors": ("bigactors", "Load, check, explore, print and draw missions."),
    "bigraphs": (
        bigraphs,
        "Milner's bigraphs as immutable values. It needs no other package of the project.",
    ),
    "physical": (physical, "Geometry on the earth, GeoJSON, AIS and waypoint files."),
    "plugin": (plugin, "What a vehicle, a feed or a service implements, and what it is told."),
    "strategies": (
        "bigactors.strategies",
        "Generated worlds, programs, configurations and missions, for Hypothesis.",
    ),
}
"""The module and the purpose of each page."""

SECTION: Final = re.compile(r"^(Args|Attributes|Raises|Returns):$\n", re.MULTILINE)
ENTRY: Final = re.compile(r"^    (\S[^:\n]*): ", re.MULTILINE)
UNREADABLE: Final = (
    (re.compile(r"<(?:function|object|factory)[^=]*>"), "..."),
    (re.compile(r"ForwardRef\('([^']*)'\)"), r"\1"),
    (re.compile(r"((?:: |-> ))'([^']*)'"), r"\1\2"),  # an annotation that is a string
    (re.compile(r"\b(?:[a-z_]\w*\.)+(?=[A-Za-z])"), ""),
)


def api_pages() -> dict[str, str]:
    """Return the pages by name, without the header of generated pages."""
    return {name: "".join(_page(name, *each)) for name, each in PAGES.items()}


def public_names(module: str) -> list[str]:
    """Return the public names of a module: its `__all__`, or the names it defines without a leading underscore."""
    loaded = import_module(module)
    listed = getattr(loaded, "__all__", None)
    if listed is None:
        listed = [name for name, value in vars(loaded).items() if getattr(value, "__module__", "") == module]
    return sorted(name for name in listed if not name.startswith("_"))


def _page(name: str, module: str, purpose: str) -> Iterator[str]:
    yield f"# Python: `{_installed(module)}`\n\n{purpose}\n\n## Examples\n\n"
    yield _examples((FOLDER / f"{name}.txt").read_text(encoding="utf-8"))
    yield "\n## Names\n"
    loaded = import_module(module)
    for each in public_names(module):
        yield f"\n### {each}\n\n{_signature(each, getattr(loaded, each))}{_documentation(getattr(loaded, each))}"


def _installed(module: str) -> str:
    return module if module.startswith("bigactors") else f"bigactors.{module}"


def _examples(text: str) -> str:
    """Return paragraphs of prose and of a Python session as Markdown."""
    parts = (
        f"```pycon\n{each.strip()}\n```" if each.startswith(">>>") else each for each in text.split("\n\n")
    )
    return "\n\n".join(part.strip() for part in parts) + "\n"


def _signature(name: str, value: Any) -> str:
    """Return the signature of a callable, the members of an enum, or the alternatives of a union."""
    if isinstance(value, EnumType):
        return f"One of {', '.join(f'`{name}.{member.name}`' for member in value)}.\n"  # type: ignore[var-annotated]
    if isinstance(value, UnionType):
        return f"`{_readable(f'{name} = {value}')}`\n"
    try:
        return f"`{_readable(f'{name}{inspect.signature(value)}')}`\n"
    except (TypeError, ValueError):
        return ""


def _readable(signature: str) -> str:
    for pattern, replacement in UNREADABLE:
        signature = pattern.sub(replacement, signature)
    return signature


def _documentation(value: Any) -> str:
    """Return a docstring as Markdown: its sections become lists, its doctests are left out."""
    if isinstance(value, UnionType) or not (text := inspect.getdoc(value)):
        return ""
    head, *sections = SECTION.split(text)
    return "\n".join(["", *_prose(head), *_lists(zip(sections[::2], sections[1::2], strict=True))])


def _prose(text: str) -> Iterator[str]:
    for paragraph in re.split(r"\n\s*\n", text.strip()):
        if ">>>" not in paragraph:  # the page has its own examples
            yield f"{paragraph}\n"


def _lists(sections: Iterable[tuple[str, str]]) -> Iterator[str]:
    for heading, body in sections:
        entries, _, rest = body.partition("\n\n")
        yield f"*{heading}*\n"
        yield ENTRY.sub(r"- `\1`: ", entries.rstrip()).replace("\n        ", "\n  ") + "\n"
        if rest.strip():
            yield from _prose(inspect.cleandoc(rest))
