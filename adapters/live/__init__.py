"""The live loop: one configuration, moved by the rules that were checked, as telemetry and feeds let it.

`advance` is the pure core: a state, what came in, and a time give the next state, the steps taken, and what vehicles
are to be told. `run_live` is the loop around it. Neither knows MAVLink, AIS or a file format.
"""
