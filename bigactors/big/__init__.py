"""Verdicts, computations and output files of `bigactors big` on systems of bigraphs."""
