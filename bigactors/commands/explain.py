"""`bigactors explain`: what a diagnostic code means."""

from argparse import Namespace

from bigactors.exits import Exit
from bigactors.mistakes import Mistake
from bigactors.terminal import say
from specs import Code, explain, find_code


def run(options: Namespace) -> Exit:
    """Print the explanation of a code, or the list of all."""
    if options.code is None:
        for code in sorted(Code, key=lambda code: code.number):
            say(f"{code.number}  {code.title}")
        say("\nbigactors explain CODE says more of each")
        return Exit.HOLDS
    found = find_code(options.code)
    if found is None:
        raise Mistake(f"there is no code '{options.code:.40}'", "bigactors explain lists them all")
    say(explain(found).rstrip())
    return Exit.HOLDS
