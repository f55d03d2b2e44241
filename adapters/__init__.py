"""Live vehicles and feeds: plugins that publish physical properties and subscribe mobility commands (paper §3.2.1).

`plugin` is their interface. `mavlink` and `ros` drive vehicles; `ais`, `static_places`, `detections`, `location` and
`camera` are feeds; `simulated` has vehicles for tests and demonstrations. `naming` maps identities to names. `live` is
the loop that runs a mission with plugins, `stations` joins several runs, `recording` and `console` show a run. Plugins
know nothing of agents or missions.
"""
