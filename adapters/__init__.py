"""Live vehicles and feeds: plugins that publish physical properties and subscribe mobility commands (paper §3.2.1).

`plugin` is their interface, `mavlink` the autopilots, `ais`, `places`, `detections` and `location` the feeds, `naming`
who is called what; `simulated` are vehicles for tests and demonstrations. Plugins know nothing of agents or missions.
"""
