"""Exports of transition systems: for model checkers, drawing programs, and browsers."""

from bigraphs.exports.dot import to_dot
from bigraphs.exports.html import to_html
from bigraphs.exports.json import to_json
from bigraphs.exports.prism import prism_files
from bigraphs.exports.storm import storm_files
from bigraphs.exports.svg import bigraph_svg, graph_svg

__all__ = ["bigraph_svg", "graph_svg", "prism_files", "storm_files", "to_dot", "to_html", "to_json"]
