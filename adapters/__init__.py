"""Live vehicles and feeds: plugins that publish physical properties and subscribe mobility commands.

Nothing is here yet. What it will stand on is: `semantics` for the rules that run, `physical.ais` for the decoding, and
`semantics.mobility` for what a vehicle is told.
"""
