"""The TextMate grammar and the extension that has it: what the language has, they have."""

import json
import re
from pathlib import Path

import pytest

from bigactors import __version__
from bigactors.lsp.textmate import textmate_grammar
from specs.grammar import RESERVED, keywords

EXTENSION = Path(__file__).parents[3] / "editors/vscode"
RULES = json.loads(textmate_grammar())["patterns"]


def scopes(line):
    """Return the words of a line with their scopes, as an editor finds them: the first rule that begins first."""
    found, at = {}, 0
    while at < len(line):
        hits = [
            (hit.start(), number, hit) for number, rule in enumerate(RULES) if (hit := match(rule, line, at))
        ]
        if not hits:
            break
        _, number, hit = min(hits, key=lambda each: each[:2])
        found |= coloured(RULES[number], hit)
        at = max(hit.end(), at + 1)
    return {word: name.removesuffix(".mission") for word, name in found.items()}


def match(rule, line, at):
    return re.compile(rule["match"]).search(line, at)


def coloured(rule, hit):
    if "name" in rule:
        return {hit[0].strip(): rule["name"]}
    return {hit[int(group)]: each["name"] for group, each in rule["captures"].items()}


def test_every_word_of_the_language_has_a_colour():
    words = sorted((RESERVED | keywords()) - {"region"})
    colours = {word: scopes(f" {word} ").get(word, "").split(".")[0] for word in words}
    assert set(colours.values()) <= {"keyword", "storage", "support", "constant"}, colours


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("BigActor a hosted_at uav0", {"BigActor": "storage.type", "a": "entity.name.class"}),
        ("uav0: UAV = point (37, -8.5)", {"UAV": "entity.name.type", "8.5": "constant.numeric"}),
        ("linked control:gcs0, wifi", {"linked": "keyword.other", "control:gcs0": "variable.other.channel"}),
        (
            "control(MOVE_HOST_TO a) // go",
            {"MOVE_HOST_TO": "support.function.command", "// go": "comment.line"},
        ),
        ('says "loop" to a', {'"loop"': "string.quoted.double"}),
        ("observe(CHILDREN(HOST))", {"CHILDREN": "support.function.query", "HOST": "constant.language"}),
    ],
)
def test_words_are_coloured_by_what_they_are(line, expected):
    found = scopes(line)
    assert {word: found.get(word) for word in expected} == expected


def test_the_extension_has_what_it_names_and_no_packages():
    package = json.loads((EXTENSION / "package.json").read_text(encoding="utf-8"))
    contributed = package["contributes"]
    files = [
        contributed["grammars"][0]["path"],
        contributed["languages"][0]["configuration"],
        package["main"],
    ]
    assert [name for name in files if not (EXTENSION / name).is_file()] == []
    assert contributed["grammars"][0]["scopeName"] == json.loads(textmate_grammar())["scopeName"]
    assert package["version"] == __version__
    assert not (EXTENSION / "package-lock.json").exists()
