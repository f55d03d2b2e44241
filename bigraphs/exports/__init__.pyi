from .dot import to_dot as to_dot
from .html import to_html as to_html
from .json import to_json as to_json
from .prism import prism_files as prism_files
from .state_graph import graph_svg as graph_svg
from .storm import storm_files as storm_files
