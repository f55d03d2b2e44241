"""BigraphER's language with extensions: text → syntax → systems, and back.

`parser` makes syntax of a text, `survey` looks at all names in it, the rest elaborates it: `values` numbers and
strings, `expressions` bigraphs, `rules` rules and `systems` a whole `System`. `writer` goes the other way.
"""
