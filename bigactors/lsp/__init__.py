"""The language server: what an editor asks of a mission while it is written.

`reading` is what is known of a text, and `occurrences` which of its names mean the same. The modules named after
requests answer them, as pure functions of a `Reading` and an offset that know nothing of the protocol. `server` alone
imports pygls and lsprotocol; `worker` runs in a process of its own, where a mission is checked.
"""
