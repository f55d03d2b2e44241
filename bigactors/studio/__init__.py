"""The studio: one page with a mission's text, its verdicts, its map and bigraph, and an explorer of its runs.

`studio_server` serves the page, `session` talks with it. What may take long runs in other processes: the language
server, a check (`bigactors.lsp.worker`), and the exploration (`exploring`).
"""
