"""Tables of texts: a row is a line, `what is written  # what is said of it`, and goes on in indented lines."""

import re


def rows(text):
    r"""Yield what is written and what is said of it; `\n` and `\0` stand for a line feed and a zero."""
    for row in re.split(r"\n(?=\S)", text.strip()):
        line = re.sub(r"\n {4}(?=# )", "  ", row).replace("\n   ", "")
        written, said = line.split("  # ")
        yield tuple(each.replace(r"\n", "\n").replace(r"\0", "\0") for each in (written, said))
