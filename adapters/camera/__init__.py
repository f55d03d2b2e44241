"""The camera plugin (paper §3.2.1): frames in, polygons of slicks on the sea out.

`view` maps a pixel to its position on the sea, `slick` finds slicks in a frame, and `votes` merges frames. `poses` and
`frames` read folders, videos and satellite pictures, and `sightings` puts these together. `sources` and `feed` do the
same in flight.
"""
