"""The camera plugin (paper §3.2.1): frames in, the polygons of what floats on the sea out.

`view` says where on the sea a pixel is, `slick` finds slicks in a frame, `votes` merges frames, `poses` and `frames`
read folders, videos and satellite pictures, `sightings` puts these together.
"""
