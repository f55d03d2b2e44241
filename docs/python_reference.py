"""The public names as sphinx's autodoc shows them: by their installed names, with the members of enums and unions.

The `__all__` of a module has the names of its `__init__.pyi`, so no page lists them.
"""

import re
from collections.abc import Iterable, Iterator
from enum import EnumType
from importlib import import_module
from types import UnionType
from typing import Any, Final, get_args

from docutils.nodes import Element
from sphinx.application import Sphinx
from sphinx.domains.python import ObjectEntry, PythonDomain
from sphinx.environment import BuildEnvironment
from sphinx.ext.napoleon import Config
from sphinx.ext.napoleon.docstring import GoogleDocstring

from bigactors.checkout import PREFIX, ROOMS

SECTIONS: Final = Config(napoleon_custom_sections=[("Attributes", "params_style")])
NAME: Final = re.compile(rf"(>>> from |`)(?=(?:{'|'.join(ROOMS)})(?: import |\.[a-z]))")
"""The place in a docstring where a module has the name of a checkout, in code or in an import."""

MODULE: Final = re.compile(r"^\.\. automodule:: (\S+)$", re.MULTILINE)
WORD: Final = re.compile(r"(?<!`)`(\w+)`(?!`)")


class PublicNames(PythonDomain):
    """Python's names. A class may have two: links in signatures lead to the first."""

    def note_object(
        self, name: str, objtype: str, node_id: str, aliased: bool = False, location: Element | None = None
    ) -> None:
        """Note a name, but not the same class by its home again."""
        if not (aliased and name in self.objects):
            super().note_object(name, objtype, node_id, aliased, location)

    def find_obj(
        self,
        env: BuildEnvironment,
        modname: str,
        classname: str,
        name: str,
        type: str | None,  # noqa: A002 - sphinx's name
        searchmode: int = 0,  # noqa: ARG002 - whether to search in other modules
    ) -> list[tuple[str, ObjectEntry]]:
        """Find a name exactly: another module may have the same word for another thing."""
        return super().find_obj(env, modname, classname, name, type)


def list_unions(_app: Sphinx, _page: str, source: list[str]) -> None:
    """Add the unions to a page: autodoc misses one from another module, and prints it with the names of a checkout."""
    for found in MODULE.finditer(source[0]):
        module = import_module(found[1])
        unions = [name for name in module.__all__ if isinstance(getattr(module, name), UnionType)]
        source[0] += "".join(f"\n.. autodata:: {name}\n   :no-value:\n" for name in unions)


def write_docstring(
    _app: Sphinx, _what: str, _name: str, value: Any, _options: Any, lines: list[str]
) -> None:
    """Rewrite a docstring: sections of Google's style, modules by their installed names, the values of a type."""
    own = getattr(value, "__annotations__", {})
    text = [NAME.sub(rf"\1{PREFIX}", keep_own(line, own)) for line in lines]
    lines[:] = [*GoogleDocstring(text, SECTIONS).lines(), "", *alternatives(value)]


def keep_own(line: str, own: Iterable[str]) -> str:
    """Mark fields of a class and arguments of a function as code: a public name may be the same word."""
    return WORD.sub(lambda found: f"`{found[0]}`" if found[1] in own else found[0], line)


def alternatives(value: Any) -> Iterator[str]:
    """Yield the members of an enumeration, or of a union."""
    if isinstance(value, EnumType):
        yield f"One of {', '.join(f'``{member}``' for member in value.__members__)}."
    elif isinstance(value, UnionType):
        yield f"One of {', '.join(f'`~{each.__module__}.{each.__qualname__}`' for each in get_args(value))}."


def is_skipped(_app: Sphinx, _what: str, _name: str, value: Any, _skip: bool, _options: Any) -> bool | None:
    """Skip the unions, which are added below, and the fields of a named tuple, which its docstring describes."""
    return True if isinstance(value, UnionType) or type(value).__name__ == "_tuplegetter" else None


def find_source(_app: Sphinx, module: str, name: str) -> str | None:
    """Return the installed name of the module in which a public name is defined."""
    value: Any = import_module(module)
    for part in name.split("."):
        value = getattr(value, part, None)
    home = getattr(value, "__module__", None)
    return f"{PREFIX}{home}" if home and home.split(".")[0] in ROOMS else None


def setup(app: Sphinx) -> None:
    """Connect these functions to sphinx."""
    app.add_domain(PublicNames, override=True)
    app.connect("source-read", list_unions)
    app.connect("autodoc-process-docstring", write_docstring)
    app.connect("autodoc-skip-member", is_skipped)
    app.connect("viewcode-follow-imported", find_source)
