"""`python -m bigactors`: the command where it isn't on the path."""

import sys

from bigactors.cli import script

if __name__ == "__main__":
    sys.exit(script())
