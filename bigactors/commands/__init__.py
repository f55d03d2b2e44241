"""The commands, one module each: `run(options)` does it and returns the exit code.

A command's module is loaded when it is asked for, and not before.
"""
