"""Stations: several runs of one mission that share observations, and exchange messages and bigActors.

The paper's communication service. `entries` are the contents of a station's log, `merge` makes one world of all logs
(pure), `authority` merges what several links show of a vehicle's authority, `journal` keeps the log on disk,
`outgoing` turns a turn of the run into entries, `messages` carry entries, `peers` reads the peers file,
`remote_station` and `skew` hold what is known of the others, `bus` is Zenoh, and `sharing` joins them: a plugin of the
live loop, whose own plugins are `shared`.
"""
