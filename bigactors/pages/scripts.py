"""The script of a page: the modules of the shared pages as one text, and whether npm has made what they load."""

import re
from functools import cache
from importlib.resources import files
from typing import Final

from adapters import console
from bigactors import studio

MODULES: Final = (
    (console, "page/parts/preact.js"),
    (console, "page/natural.js"),
    (console, "page/ui.js"),
    (console, "page/store.js"),
    (console, "page/bigraph.js"),
    (console, "page/map/words.js"),
    (studio, "page/explorer.js"),
    (studio, "page/trace.js"),
)
"""The modules of a trace's page, each after those that it imports."""

STYLES: Final = (
    (console, "page/style.css"),
    (studio, "page/explorer.css"),
    (studio, "page/trace.css"),
)
LICENSES: Final = (console, "page/parts/LICENSES.txt")
LICENSED: Final = ("htm", "preact")

_IMPORT: Final = re.compile(r'^import \{([^}]*)\} from "[^"]*?([\w-]+)\.js";$', re.MULTILINE)
_LIST: Final = re.compile(r"export ?\{([^}]*)\};?")
_DECLARED: Final = re.compile(r"^export (?=(?:async )?(?:function|const|class) (\w+))", re.MULTILINE)


@cache
def script() -> str:
    """Return the script of a trace's page; empty in a clone without the parts that npm makes."""
    if not all((files(package) / path).is_file() for package, path in MODULES):
        return ""
    modules = (_module(path, (files(package) / path).read_text("utf-8")) for package, path in MODULES)
    return f'"use strict";\n/*!\n{_licenses()}\n*/\nconst modules = {{}};\n{"".join(modules)}'


@cache
def style() -> str:
    """Return the style of a trace's page."""
    return "\n".join((files(package) / path).read_text("utf-8") for package, path in STYLES)


def _module(path: str, text: str) -> str:
    r"""Return a module as a function that puts what it exports into a table.

    >>> print(_module("a/b.js", 'import { x as y } from "./c.js";\nexport const z = y;'))
    modules["b"] = (() => {
    const { x: y } = modules["c"];
    const z = y;
    return { z };
    })();
    <BLANKLINE>
    """
    name = path.rpartition("/")[2].removesuffix(".js")
    listed = [each for found in _LIST.findall(text) for each in found.split(",")]
    exported = [": ".join(reversed(each.split(" as "))).strip() for each in map(str.strip, listed)]
    exported += _DECLARED.findall(text)
    body = _DECLARED.sub("", _LIST.sub("", _IMPORT.sub(_taken, text)))
    return f'modules["{name}"] = (() => {{\n{body}\nreturn {{ {", ".join(exported)} }};\n}})();\n'


def _taken(found: re.Match[str]) -> str:
    names = found[1].replace(" as ", ": ")
    return f'const {{{names}}} = modules["{found[2]}"];'


def _licenses() -> str:
    """Return the licenses of the code of others in the script."""
    text = (files(LICENSES[0]) / LICENSES[1]).read_text("utf-8")
    parts = re.split(r"^(?=\S+ [\d.]+: .*\n\n=+$)", text, flags=re.MULTILINE)
    return "\n".join(part.replace("*/", "* /") for part in parts if part.partition(" ")[0] in LICENSED)
