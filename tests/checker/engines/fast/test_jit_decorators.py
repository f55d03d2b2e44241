"""A loop is compiled once, and an inner loop is called by loops alone."""

import ast
from pathlib import Path

import numpy as np
import pytest
from numba import types

from checker.engines.fast.compiled.jit_decorators import njit

ROOT = Path(__file__).parents[4]
READ = [
    path for room in ("benchmarks", "bigactors", "checker", "tests") for path in (ROOT / room).rglob("*.py")
]


def module_of(path):
    return ".".join(path.relative_to(ROOT).with_suffix("").parts)


def decorators(node):
    """Return the names of what decorates a definition."""
    return {
        each.func.id
        for each in node.decorator_list
        if isinstance(each, ast.Call) and hasattr(each.func, "id")
    }


def functions(tree):
    return [node for node in tree.body if isinstance(node, ast.FunctionDef)]


def is_loop(node):
    return isinstance(node, ast.FunctionDef) and bool(decorators(node) & {"inner", "njit"})


def inner_loops(trees):
    """Return the loops that only loops may call, each as its module and name."""
    return {
        (module, node.name)
        for module, tree in trees.items()
        for node in functions(tree)
        if "inner" in decorators(node)
    }


def mentioned(module, tree):
    """Yield what a module mentions outside its loops, as a module and a name."""
    imported = {
        alias.asname or alias.name: (node.module, alias.name)
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom) and node.module
        for alias in node.names
    }
    outside = [node for node in tree.body if not is_loop(node)]
    for node in (part for each in outside for part in ast.walk(each)):
        match node:
            case ast.Name(name):
                yield imported.get(name, (module, name))
            case ast.Attribute(ast.Name(name), attribute) if name in imported:
                yield f"{imported[name][0]}.{imported[name][1]}", attribute


@pytest.fixture(scope="module")
def trees():
    """Return the syntax of all modules that could import a loop: their texts name the folder that has all loops."""
    texts = {path: path.read_text(encoding="utf-8") for path in READ}
    return {module_of(path): ast.parse(text) for path, text in texts.items() if "engines" in text}


def test_inner_loops_are_called_by_loops_alone(trees):
    inner = inner_loops(trees)
    assert len(inner) > 50
    assert all(module.startswith("checker.engines.") for module, _ in inner)
    told = {each for module, tree in trees.items() for each in mentioned(module, tree)}
    assert inner & told == set()


@pytest.mark.parametrize(
    "call",
    ["from a.b import loop\nloop()", "from a import b\nb.loop()", "from a.b import loop as l\ndef f(): l()"],
)
def test_a_call_from_elsewhere_is_seen(call):
    trees = {"a.b": ast.parse("@inner(cache=True)\ndef loop(): pass"), "c": ast.parse(call)}
    assert inner_loops(trees) <= set(mentioned("c", trees["c"]))


def test_a_loop_is_compiled_once_for_integers_of_any_kind():
    @njit()
    def double(number):
        return 2 * number

    @njit()
    def sums(numbers, number):
        return double(1) + double(number) + double(numbers[0])

    assert sums(np.array([3], np.int32), 2) == 12
    assert double.signatures == [(types.int64,)]
