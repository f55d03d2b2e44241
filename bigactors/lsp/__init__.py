"""The language server: answers to an editor's requests about a mission.

`reading` analyses a text, and `occurrences` resolves its names. The modules named after requests answer them by pure
functions of a `Reading` and an offset, and know nothing of the protocol. Only `server` imports pygls and lsprotocol.
`worker` checks a mission in a separate process.
"""
