"""Stations: several runs of one mission that share what they see, and carry messages and bigActors between them.

The paper's communication service. `entries` are what a station says, `merge` makes one world of what all say (pure),
`journal` keeps a station's own entries on disk, `peers` reads who the others are, `skew` measures their clocks, `bus`
is Zenoh (the only file that imports it), and `sharing` joins them: a plugin of the live loop.
"""
