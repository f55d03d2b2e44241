"""`bigactors explain`: the meaning of a diagnostic code or of a word of a report."""

from argparse import Namespace
from typing import Final

from bigactors.exits import Exit
from bigactors.mistakes import Mistake
from bigactors.terminal import say

DESCRIPTION: Final = """\
Print the meaning of a diagnostic code or of a word of a report, and the remedy."""

EXAMPLES: Final = (
    "bigactors explain LS201",
    "bigactors explain LS704 LS709",
    "bigactors explain stale-observation race",
    "bigactors explain",
)

ARGUMENTS: Final = """\
  code [CODE...]  codes such as LS201, or a word of a report such as stale-observation (default: list all)"""


def run(options: Namespace) -> Exit:
    """Print the explanation of a code or a word, or the list of all."""
    from bigraphs.notation.spelling import did_you_mean
    from checker.reports.glossary import ALL, find_word
    from specs import Code, explain, find_code

    if not options.code:
        for code in sorted(Code, key=lambda code: code.number):
            say(f"{code.number}  {code.title}")
        say(f"\nwords of reports: {', '.join(ALL)}")
        say("\nbigactors explain CODE, or a word, explains each")
        return Exit.HOLDS
    together = " ".join(options.code)
    asked = options.code if all(map(find_code, options.code)) else [together]
    for each in asked:
        found, word = find_code(each), find_word(each)
        if found is not None:
            say(explain(found).rstrip() + ("\n" if each is not asked[-1] else ""))
        elif word is not None:
            say(f"{word[0]}\n\n{word[1]}")
        else:
            hint = did_you_mean(each, ALL) or " or ".join(
                f"bigactors explain {word}" for word in ALL if each.casefold() in word.split()
            )
            raise Mistake(
                f"there is no code and no word '{each:.40}'", hint or "bigactors explain lists them all"
            )
    return Exit.HOLDS
