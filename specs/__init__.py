"""The mission language: from a text to a mission, or to the mistakes in it.

It knows nothing of exploring configurations, of vehicles or of the command line. The way of a mission through the
modules: `text` (bounds, comments), `grammar` and the two builders (`build_world`, `build_behaviour`), `syntax` (the
tree), `syntax_errors`, `common_mistakes` and `codes` (what can be wrong), `diagnostics` (how it is printed); and back
to text: `writing`, `layout`, `formatter`.
"""

from specs.codes import Code, code_table, explain, find_code
from specs.diagnostics import Diagnostic, MissionError, Source, render, render_all
from specs.formatter import format_mission, write_mission
from specs.parser import parse, parse_bytes
from specs.preprocessing import decode

__all__ = [
    "Code",
    "Diagnostic",
    "MissionError",
    "Source",
    "code_table",
    "decode",
    "explain",
    "find_code",
    "format_mission",
    "parse",
    "parse_bytes",
    "render",
    "render_all",
    "write_mission",
]
