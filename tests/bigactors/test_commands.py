"""A command is one module, or one folder, with its help, its arguments and its work."""

from pkgutil import iter_modules

from bigactors import commands
from bigactors.arguments.parser import Command, command_of
from bigactors.commands import NAMES


def test_each_module_of_commands_is_a_command_of_the_table():
    assert {each.name for each in iter_modules(commands.__path__)} == {
        name.replace("-", "_") for name in NAMES
    }


def test_each_command_has_its_help_its_arguments_and_its_work():
    assert [name for name in NAMES if not isinstance(command_of(name), Command)] == []
