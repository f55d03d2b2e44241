"""The symbolic engine: all that is reachable as decision diagrams, by the trees that the fast explorer learns.

It needs the extra `symbolic`. It decides what is said of single configurations; of runs it knows nothing.
"""
