"""Pages: self-contained HTML for readers without bigactors.

All text except our own markup is escaped, nothing is loaded, and a Content-Security-Policy enforces that in the
browser. Without scripts a page shows the story and the lanes.
"""

from bigactors.pages.story import MOST_PICTURES, PageContent, Story, page_of, telling, trace_page

__all__ = ["MOST_PICTURES", "PageContent", "Story", "page_of", "telling", "trace_page"]
