"""The server as a process, asked by a client over its standard input and output."""

import asyncio
import itertools
import random
import re
import sys
from pathlib import Path

import pytest
import pytest_lsp
from lsprotocol import types as t
from pygls.exceptions import JsonRpcException
from pytest_lsp import ClientServerConfig, LanguageClient, client_capabilities

from bigactors.lsp.edited_mission import reading_of
from bigactors.lsp.positions import LineStarts

ROOT = Path(__file__).parents[3]
MISSIONS = ROOT / "specs/missions"
SERVER = ClientServerConfig([sys.executable, "-m", "bigactors", "lsp"])


pytestmark = pytest.mark.asyncio(loop_scope="module")


@pytest_lsp.fixture(config=SERVER, scope="module")
async def client(lsp_client: LanguageClient):
    lsp_client.feature(t.WORKSPACE_CODE_LENS_REFRESH)(lambda _: None)
    await lsp_client.initialize_session(
        t.InitializeParams(capabilities=client_capabilities("visual-studio-code"), root_uri=ROOT.as_uri())
    )
    yield
    await lsp_client.shutdown_session()


class Editor:
    """A text that is open: what a user does with it."""

    numbers = itertools.count()

    def __init__(self, client, text):
        path = MISSIONS / f"unsaved{next(self.numbers)}.mission"
        self.client, self.text, self.uri, self.version = client, text, path.as_uri(), 1
        item = t.TextDocumentItem(self.uri, "mission", 1, text)
        client.text_document_did_open(t.DidOpenTextDocumentParams(item))
        self.id = t.TextDocumentIdentifier(self.uri)

    def change(self, text):
        self.text, self.version = text, self.version + 1
        self.client.text_document_did_change(
            t.DidChangeTextDocumentParams(
                t.VersionedTextDocumentIdentifier(uri=self.uri, version=self.version),
                [t.TextDocumentContentChangeWholeDocument(text)],
            )
        )

    def at(self, words, inside=0):
        """Return the position of words, or of a character in them."""
        before = self.text[: self.text.index(words) + inside]
        line = before.count("\n")
        return t.Position(line, len(before.rpartition("\n")[2].encode("utf-16-le")) // 2)

    async def mistakes(self):
        async with asyncio.timeout(30):
            while self.uri not in self.client.diagnostics:
                await asyncio.sleep(0.01)
        return tuple(self.client.diagnostics.pop(self.uri))

    def applied(self, edits):
        """Return the text with edits, all of which are about it as it is."""
        lines = self.text.split("\n")
        for edit in sorted(edits, key=lambda edit: edit.range.start, reverse=True):
            start, end = edit.range.start, edit.range.end
            last = lines[end.line][end.character :] if end.line < len(lines) else ""
            first = lines[start.line][: start.character] if start.line < len(lines) else ""
            lines[start.line : end.line + 1] = (first + edit.new_text + last).split("\n")
        return "\n".join(lines)


def shipped(name):
    return (MISSIONS / f"{name}.mission").read_text(encoding="utf-8")


async def test_mistakes_of_syntax_and_of_meaning_come_with_codes_and_hints_where_the_editor_counts(client):
    text = shipped("oil_spill").replace('"over the spill"', '"🚁 over the spill"')
    for right, wrong in (
        ("UAV driven", "UAV drivn"),
        ("searchArea0)", "serchArea0)"),
        ("oilSpill0\n}", "oilSpil0\n}"),
    ):
        assert right in text
        text = text.replace(right, wrong)
    editor = Editor(client, text)
    found = await editor.mistakes()
    assert [(each.code, each.range.start) for each in found] == [
        ("LS110", editor.at("drivn")),
        ("LS201", editor.at("serchArea0")),
        ("LS201", editor.at("oilSpil0")),
    ]
    assert found[1].message == "unknown name 'serchArea0'\nhint: did you mean 'searchArea0'?"
    editor.change(shipped("oil_spill"))
    assert await editor.mistakes() == ()


async def test_a_mistake_has_its_remedy_as_a_quick_fix(client):
    editor = Editor(client, shipped("oil_spill").replace("searchArea0)", "serchArea0)"))
    (found,) = await editor.mistakes()
    (action,) = await client.text_document_code_action_async(
        t.CodeActionParams(editor.id, found.range, t.CodeActionContext([found]))
    )
    assert action.title == "Write 'searchArea0'"
    assert editor.applied(action.edit.changes[editor.uri]) == shipped("oil_spill")


async def test_what_something_is_and_what_may_stand_there_is_shown(client):
    editor = Editor(client, shipped("oil_spill"))
    for words, said in (("searchArea0: ", "area: 198 km²"), ("observe(", "⟨sense : OBS(a, q)⟩")):
        found = await client.text_document_hover_async(t.HoverParams(editor.id, editor.at(words)))
        assert said in found.contents.value
    place = editor.at("MOVE_HOST_TO searchArea0", len("MOVE_HOST_TO "))
    found = await client.text_document_completion_async(t.CompletionParams(editor.id, place))
    entities = [each.label for each in found if each.detail == "entity"]
    assert entities == ["airfield0", "gcs0", "oilSpill0", "searchArea0", "uav0"]


async def test_names_are_found_and_renamed_everywhere_unless_a_meaning_would_change(client):
    editor = Editor(client, shipped("oil_spill"))
    place = editor.at("oilSpill0 in obs")
    definition = await client.text_document_definition_async(t.DefinitionParams(editor.id, place))
    assert definition.range.start == editor.at("oilSpill0: OilSpill")
    context = t.ReferenceContext(include_declaration=True)
    found = await client.text_document_references_async(t.ReferenceParams(context, editor.id, place))
    assert len(found) == editor.text.count("oilSpill0") == 6
    edit = await client.text_document_rename_async(t.RenameParams(editor.id, place, "slick"))
    assert editor.applied(edit.changes[editor.uri]) == editor.text.replace("oilSpill0", "slick")
    with pytest.raises(JsonRpcException, match="uav0"):
        await client.text_document_rename_async(t.RenameParams(editor.id, place, "uav0"))


async def test_a_text_is_laid_out_listed_and_coloured(client):
    editor = Editor(client, re.sub(r"\n  ", "\n", shipped("oil_spill")))
    options = t.FormattingOptions(tab_size=2, insert_spaces=True)
    edits = await client.text_document_formatting_async(t.DocumentFormattingParams(editor.id, options))
    assert editor.applied(edits) == shipped("oil_spill")
    editor.change(shipped("oil_spill"))
    found = await client.text_document_document_symbol_async(t.DocumentSymbolParams(editor.id))
    assert [each.name for each in found] == ["signature", "world", "a", "environment", "check"]
    entities = ["searchArea0", "airfield0", "oilSpill0", "gcs0", "uav0"]
    assert [each.name for each in found[1].children] == entities
    colours = await client.text_document_semantic_tokens_full_async(t.SemanticTokensParams(editor.id))
    assert len(colours.data) % 5 == 0
    assert tuple(colours.data[:5]) == (4, 7, len("Location"), 0, 1)


async def lenses(client, editor):
    found = await client.text_document_code_lens_async(t.CodeLensParams(editor.id))
    return [each.command for each in found]


async def run(client, command):
    return await client.workspace_execute_command_async(
        t.ExecuteCommandParams(command.command, command.arguments)
    )


async def test_properties_are_checked_and_their_traces_shown(client):
    editor = Editor(client, shipped("broken_control_race"))
    before = await lenses(client, editor)
    assert {each.title for each in before} == {"▶ check all", "▶ check"}
    await run(client, before[0])
    after = await lenses(client, editor)
    titles = [each.title for each in after]
    assert "✗ violated" in titles
    shows = next(each for each in after if each.title == "show the trace")
    address = await run(client, shows)
    page = Path(address.removeprefix("file://")).read_text(encoding="utf-8")
    assert page.startswith("<!DOCTYPE html>")
    editor.change(editor.text + "// later\n")
    later = [each.title for each in await lenses(client, editor)]
    assert any(title.startswith("▶ check again") for title in later)


async def checking(client, editor):
    """Begin a long check, and return it as soon as the editor could cancel it."""
    begun = asyncio.ensure_future(run(client, (await lenses(client, editor))[0]))
    while (await lenses(client, editor))[0].command != "bigactors.cancel":
        await asyncio.sleep(0.01)
    return begun


async def test_a_check_is_cancelled_and_never_blocks(client):
    editor = Editor(client, shipped("surveillance"))
    begun = await checking(client, editor)
    found = await client.text_document_hover_async(t.HoverParams(editor.id, t.Position(0, 0)))
    assert found is None or found.contents
    await run(client, (await lenses(client, editor))[0])
    await begun
    assert (await lenses(client, editor))[0].title == "▶ check all"


async def test_an_editor_that_leaves_ends_the_check_that_runs(client):
    editor = Editor(client, shipped("surveillance"))
    begun = await checking(client, editor)
    client.text_document_did_close(t.DidCloseTextDocumentParams(editor.id))
    async with asyncio.timeout(30):
        await begun


async def test_a_file_that_is_too_large_is_refused_and_the_server_lives_on(client):
    editor = Editor(client, "// " + "x" * 10_000_000)
    (found,) = await editor.mistakes()
    assert (found.code, found.range.start) == ("LS001", t.Position(0, 0))
    editor.change(shipped("oil_spill"))
    assert await editor.mistakes() == ()


async def test_after_any_changes_the_server_has_the_text_that_the_editor_has(client):
    chance = random.Random(7)
    editor = Editor(client, shipped("takeover"))
    await editor.mistakes()
    for _ in range(12):
        lines = editor.text.splitlines(keepends=True)
        at = chance.randrange(len(lines))
        typed = ["🚁 loop {\r\n", "observe(ALL)\n", "é\u2028\x85}\r", lines[at]]
        lines[at : at + chance.randrange(3)] = [chance.choice(typed)]
        editor.change("".join(lines))
        expected = reading_of("m", editor.text, MISSIONS).diagnosis
        found = [*expected.mistakes, *expected.warnings]
        places = [LineStarts(editor.text, "utf-16").position(each.span.start) for each in found]
        told = await editor.mistakes()
        assert [(each.range.start.line, each.range.start.character) for each in told] == places


@pytest.mark.parametrize("path", ["/dev/zero", "/dev/stdin", str(MISSIONS / "oil_spill.mission")])
async def test_a_file_that_the_editor_has_not_opened_is_not_read(client, path):
    asked = t.TextDocumentIdentifier(Path(path).as_uri())
    async with asyncio.timeout(30):
        found = await client.text_document_document_symbol_async(t.DocumentSymbolParams(asked))
        hover = await client.text_document_hover_async(t.HoverParams(asked, t.Position(0, 0)))
    assert not found
    assert hover is None
