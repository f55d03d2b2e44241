"""A command is one module, or one folder, with its help, its arguments and its work."""

from pkgutil import iter_modules

from bigactors import commands
from bigactors.commands import NAMES


def test_each_module_of_commands_is_a_command_of_the_table():
    assert {each.name for each in iter_modules(commands.__path__)} == {
        name.replace("-", "_") for name in NAMES
    }
