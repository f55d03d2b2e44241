"""Print which features of an exploration work together: a mark from a real run in each cell, or why not.

Each pair explores a mission made for it, and is held to the reference engine; a disagreement exits 1.
"""

import sys
from contextlib import redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path

sys.path.extend(map(str, (Path(__file__).parent.parent / "tests" / "checker").glob("**")))

from option_pairs import FEATURES, WRONG, Feature, folded, marked, of_system

COLUMNS = [each for each in FEATURES if each not in (Feature.REFERENCE, Feature.FAST)]
if __name__ == "__main__":
    with redirect_stdout(StringIO()), redirect_stderr(StringIO()):
        rows = {one.value: [marked(one, other) for other in COLUMNS] for one in FEATURES}
        rows |= {"folded rows": [*map(folded, COLUMNS)], ".big systems": [*map(of_system, COLUMNS)]}
    notes = [
        mark for mark in dict.fromkeys(mark for marks in rows.values() for mark in marks) if len(mark) > 1
    ]
    lines = [["", *(each.value for each in COLUMNS)], ["---"] * (len(COLUMNS) + 1)]
    for name, marks in rows.items():
        signs = [mark[0] if mark[0] in "✓✗–" else "no" for mark in marks]
        numbers = [f" ({notes.index(mark) + 1})" if mark in notes else "" for mark in marks]
        lines.append([name, *map("".join, zip(signs, numbers, strict=True))])
    sys.stdout.writelines(f"| {' | '.join(line)} |\n" for line in lines)
    sys.stdout.writelines(f"\n({number}) {note}" for number, note in enumerate(notes, 1))
    sys.exit(any(note.startswith(WRONG) for note in notes))
