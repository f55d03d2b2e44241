"""The arguments of `bigactors completion`."""

from bigactors.arguments.parser import Command, Parser

SHELLS = ("bash", "zsh", "fish")


def fill(parser: Parser) -> None:
    """Add the arguments of `bigactors completion`."""
    parser.add_argument("shell", choices=SHELLS, help="the shell that reads it")


COMMAND = Command(
    "completion",
    "print what completes command lines in bash, zsh or fish",
    "Print a script that completes commands, options, missions that ship and names in missions. A shell reads it at\n"
    "its start: the examples are lines for ~/.config/fish/config.fish, ~/.bashrc and ~/.zshrc (after compinit).",
    (
        "bigactors completion fish | source",
        'eval "$(bigactors completion bash)"',
        'eval "$(bigactors completion zsh)"',
    ),
    fill,
)
