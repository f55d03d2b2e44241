"""Pages: self-contained HTML for readers without bigactors.

All text except our own markup is escaped, nothing is loaded, and a Content-Security-Policy enforces that in the
browser. Without scripts a page shows everything at once.
"""

from bigactors.pages.story import MOST_PICTURES, Story, Telling, telling
from bigactors.pages.trace_page import page_of, trace_page

__all__ = ["MOST_PICTURES", "Story", "Telling", "page_of", "telling", "trace_page"]
