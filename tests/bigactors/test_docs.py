from shutil import copy

from bigactors import docs
from bigactors.commands import NAMES
from semantics.bigactor_rules import EXTENSION
from semantics.rules import RULES, TIMED_RULES


def test_the_generated_pages_are_as_they_would_be_written():
    assert docs.stale(docs.FOLDER) == [], "run python -m bigactors.docs"


def test_a_stale_page_is_told(tmp_path, monkeypatch, capsys):
    own = tmp_path / "explanation"
    own.mkdir()
    copy(docs.FOLDER / "explanation" / "reduction.md", own)  # only a part of it is generated
    monkeypatch.setattr(docs, "FOLDER", tmp_path)
    assert docs.main([]) == 0
    assert docs.main(["--check"]) == 0
    (tmp_path / "reference" / "rules.md").write_text("older", encoding="utf-8")
    assert docs.main(["--check"]) == 1
    assert capsys.readouterr().out == "docs/reference/rules.md is stale: run python -m bigactors.docs\n"


def test_the_generated_part_of_a_page_leaves_the_rest(tmp_path, monkeypatch):
    monkeypatch.setattr(docs, "FOLDER", tmp_path)
    (tmp_path / "page.md").write_text(
        "a\n<!-- generated: one -->\nold\n<!-- end generated -->\nb\n", encoding="utf-8"
    )
    page = docs.with_part("page.md", "one", "new\n")
    assert page == "a\n<!-- generated: one -->\n\nnew\n\n<!-- end generated -->\nb\n"


def test_every_rule_is_printed_with_its_bar():
    page = docs.pages()["reference/rules.md"]
    for rule in (*RULES, *TIMED_RULES, *EXTENSION):
        section = page.split(f"\n### {rule.__name__}\n")[1].split("\n### ")[0]
        assert "───" in section
        assert "→" in section


def test_every_command_is_on_the_page_whatever_the_terminal(monkeypatch):
    wide = docs.pages()["reference/cli.md"]
    monkeypatch.setenv("COLUMNS", "40")
    assert docs.pages()["reference/cli.md"] == wide
    for command in NAMES:
        assert f"\n## bigactors {command}\n" in wide
