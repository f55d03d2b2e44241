"""Stations: several runs of one mission that share observations, and exchange messages and bigActors.

The paper's communication service. `entries` are the contents of a station's log, and `merge` makes one world of all
logs (pure). `authority` merges the reports of several links on a vehicle's authority, and `journal` keeps the log on
disk. `outgoing` turns a turn of the run into entries, `messages` carry entries, and `peers` reads the peers file.
`remote_station` and `skew` hold the state of the other stations, and `bus` is Zenoh. `sharing` joins them: a plugin of
the live loop, whose own plugins are wrapped by `shared_plugin`.
"""
