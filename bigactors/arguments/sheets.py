"""Arguments of commands as text: a sheet has a paragraph for each group, and an entry for each argument.

    report
      --json FILE  write the report as JSON; - for standard output, alone
      --violations N = 5  print at most N violations of each property.

The argument, with its value and its default, ends at two spaces; its help may go on in lines that are indented further.
Arguments without a group stand in a paragraph without a title.
"""

import argparse
import re
from typing import Any, Final

from bigactors.arguments import values

EXCLUSIVE: Final = {"exactly one of": True, "at most one of": False}
"""The titles of paragraphs of arguments that exclude each other: whether one is required. The help lacks them."""

ARGUMENT: Final = re.compile(
    r"(?P<required>required )?(?P<names>--[\w-]+(?:, --[\w-]+)*|\w+)(?: (?P<value>(?!as |= )\S+(?: [A-Z]+)?))?"
    r"(?: as (?P<kind>\w+))?(?: = (?P<default>\S+))?(?: in (?P<dest>\w+))?"
)
"""Such as `--json FILE`, `file [FILE]`, `--out FILE = demo`, `--state N as at_least_zero = 0`."""


def add_arguments(parser: argparse.ArgumentParser, sheet: str) -> None:
    """Add the arguments of a sheet to a parser."""
    for paragraph in re.split(r"\n\s*\n", sheet.strip("\n")):
        title, *entries = re.split(r"(?:^|\n)  (?=\S)", paragraph)
        for group in [_group(parser, title)] if entries else ():
            for entry in entries:
                argument, _, text = entry.partition("  ")
                _add(group, argument, " ".join(text.split()))


def _group(parser: argparse.ArgumentParser, title: str) -> argparse._ActionsContainer:
    if title in EXCLUSIVE:
        return parser.add_mutually_exclusive_group(required=EXCLUSIVE[title])
    return parser.add_argument_group(title) if title else parser


def _add(group: argparse._ActionsContainer, argument: str, text: str) -> None:
    found = ARGUMENT.fullmatch(argument)
    assert found is not None, argument
    names, default = found["names"].split(", "), found["default"]
    settings: dict[str, Any] = {"help": text or argparse.SUPPRESS}
    settings |= {"required": True} if found["required"] else {}
    settings |= {"dest": found["dest"]} if found["dest"] else {}
    if found["value"] is None:
        group.add_argument(*names, action="store_true", **settings)
        return
    settings |= _value(found["value"], is_option=argument.startswith(("-", "required")))
    if found["kind"]:
        settings["type"] = getattr(values, found["kind"])
    if text.endswith("may be repeated"):
        settings |= {"action": "append", "default": []}
    if default is not None:
        settings["default"] = settings.get("type", str)(default)
        settings["help"] += "" if "(default" in text else f" (default: {default})"
    group.add_argument(*names, **settings)


def _value(value: str, *, is_option: bool) -> dict[str, Any]:
    """Return the settings for a value: `FILE`, `[FILE]`, `FILE...`, `CERT KEY` or `{a,b}`."""
    if value.startswith("{"):
        return {"choices": value[1:-1].split(",")}
    optional = value.startswith("[") and value.endswith("]")
    metavar = value[1:-1] if optional else value
    if not is_option:
        nargs = ("*" if optional else "+") if metavar.endswith("...") else "?" if optional else None
        return {"metavar": metavar.removesuffix("..."), "nargs": nargs}
    parts = tuple(metavar.split())
    settings: dict[str, Any] = {"metavar": metavar, "type": values.VALUES.get(parts[0], str)}
    if len(parts) > 1:
        settings |= {"metavar": parts, "nargs": len(parts)}
    return settings | ({"nargs": "?", "const": True} if optional else {})
