"""Recordings of live runs: every arrival, request and step in one MCAP file, readable after `kill -9`.

The schemas of its messages are in `schemas`, and documented in docs/recording.md.
"""
