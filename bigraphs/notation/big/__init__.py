"""BigraphER's language with extensions: text → syntax → systems, and back.

`parser` makes syntax of a text and `name_check` checks all its names. Then `values` evaluates numbers and strings,
`expressions` bigraphs, `rules` rules, and `systems` a whole `System`. `writer` is the inverse.
"""
