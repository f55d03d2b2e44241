"""Stations: several runs of one mission that share observations, and exchange messages and bigActors.

The paper's communication service. `entries` are what a station says, `merge` makes one world of what all say (pure),
`authority` tells whom vehicles obey by several links, `journal` keeps a station's own entries on disk, `outgoing`
says what a turn of the run is to others, `messages` carry entries, `peers` reads who the others are, `remote_station`
and `skew` are what is known of them, `bus` is Zenoh (the only file that imports it), and `sharing` joins them: a
plugin of the live loop, whose own plugins are `shared`.
"""
