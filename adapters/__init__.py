"""Live vehicles and feeds: plugins that publish physical properties and subscribe mobility commands (paper §3.2.1).

`plugin` is their interface, `mavlink` and `ros` are vehicles, and `ais`, `static_places`, `detections`, `location` and
`camera` are feeds. `naming` maps identities to names; `simulated` has vehicles for tests and demonstrations. Plugins
know nothing of agents or missions.
"""
