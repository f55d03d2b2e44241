"""Pages: self-contained HTML for readers without bigactors.

Everything that is not markup of ours is escaped, nothing is loaded from anywhere, and a Content-Security-Policy says so
to the browser. Without scripts a page shows everything at once.
"""

from bigactors.pages.story import MOST_PICTURES, Story
from bigactors.pages.trace_page import trace_page

__all__ = ["MOST_PICTURES", "Story", "trace_page"]
