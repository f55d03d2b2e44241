"""The language server over pygls: it translates requests, calls pure functions, and translates their answers back."""

from __future__ import annotations

import asyncio
import contextlib
import difflib
import hashlib
import json
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final
from urllib.parse import unquote

from lsprotocol import types as t
from pygls.exceptions import JsonRpcException
from pygls.lsp.server import LanguageServer
from pygls.uris import from_fs_path, to_fs_path

from bigactors import __version__
from bigactors.lsp import renaming
from bigactors.lsp.completion import complete
from bigactors.lsp.edited_mission import Reading, reading_of
from bigactors.lsp.fixes import fixes
from bigactors.lsp.hover import hover
from bigactors.lsp.outline import Part, outline, title_of
from bigactors.lsp.positions import LineStarts
from bigactors.lsp.textmate import MODIFIERS, TYPES, tokens
from specs import MissionError, format_mission
from specs import syntax as s

CHECK, CANCEL, SHOW_TRACE = "bigactors.check", "bigactors.cancel", "bigactors.showTrace"
PAUSE: Final = 0.1
"""Seconds without a change before a text is analysed."""
MOST_CONFIGURATIONS: Final = 2_000_000
MOST_SECONDS: Final = 600.0
MARKS: Final = {"holds": "✓", "violated": "✗", "incomplete": "?"}

COMPLETIONS: Final = {
    "entity": t.CompletionItemKind.Value,
    "agent": t.CompletionItemKind.Class,
    "kind": t.CompletionItemKind.Interface,
    "channel": t.CompletionItemKind.Event,
    "rule": t.CompletionItemKind.Method,
    "behaviour": t.CompletionItemKind.Function,
    "variable": t.CompletionItemKind.Variable,
    "function": t.CompletionItemKind.Function,
    "command": t.CompletionItemKind.Operator,
    "word": t.CompletionItemKind.Keyword,
}
SYMBOLS: Final = {
    "section": t.SymbolKind.Namespace,
    "kind": t.SymbolKind.Interface,
    "entity": t.SymbolKind.Object,
    "channel": t.SymbolKind.Event,
    "file": t.SymbolKind.File,
    "property": t.SymbolKind.Boolean,
    "rule": t.SymbolKind.Method,
    "behaviour": t.SymbolKind.Function,
    "agent": t.SymbolKind.Class,
    "clause": t.SymbolKind.Field,
    "setting": t.SymbolKind.Constant,
}


@dataclass
class Document:
    """A text that is open in the editor."""

    reading: Reading
    lines: LineStarts
    verdicts: dict[str, dict[str, Any]] = field(default_factory=dict)
    checked: str = ""
    running: asyncio.subprocess.Process | None = None

    def range(self, span: s.Span) -> t.Range:
        """Return the editor's range of a span."""
        start, end = (self.lines.position(offset) for offset in (span.start, span.end))
        return t.Range(t.Position(*start), t.Position(*end))

    def offset(self, position: t.Position) -> int:
        """Return the offset of an editor's position."""
        return self.lines.offset(position.line, position.character)


class Server(LanguageServer):
    """The server, with its state for each open text."""

    def __init__(self) -> None:
        super().__init__("bigactors", __version__, text_document_sync_kind=t.TextDocumentSyncKind.Full)
        self.documents: dict[str, Document] = {}
        self.pages = tempfile.TemporaryDirectory(prefix="bigactors-")
        self.pending: dict[str, asyncio.Task[None]] = {}

    def document(self, uri: str) -> Document:
        """Return the state of a text as it is now; a text that the editor has not opened is empty."""
        opened = self.workspace.text_documents.get(unquote(uri))  # its path may be /dev/zero
        text = "" if opened is None else opened.source
        known = self.documents.get(uri)
        if known is not None and known.lines.text is text:
            return known
        path = Path(to_fs_path(uri) or "mission")
        encoding = t.PositionEncodingKind(self.server_capabilities.position_encoding or "utf-16")
        lines = LineStarts(text, encoding.value)
        reading = reading_of(path.name, text, path.parent)
        if opened is None:
            return Document(reading, lines)
        if known is None:
            known = self.documents[uri] = Document(reading, lines)
        known.reading, known.lines = reading, lines
        return known

    def close(self) -> None:
        """End the running checks, and delete the pages of traces."""
        for document in self.documents.values():
            end(document)
        self.pages.cleanup()

    # --- diagnostics

    def look_soon(self, uri: str) -> None:
        """Publish the mistakes of a text once it has not changed for a moment."""
        waiting = self.pending.pop(uri, None)
        if waiting is not None:
            waiting.cancel()
        self.pending[uri] = asyncio.get_running_loop().create_task(self._look(uri))

    async def _look(self, uri: str) -> None:
        await asyncio.sleep(PAUSE)
        self.publish(uri)

    def publish(self, uri: str) -> None:
        """Publish the mistakes and warnings of a text."""
        document = self.document(uri)
        opened = self.workspace.text_documents.get(unquote(uri))
        version = None if opened is None else opened.version
        found = [*_diagnostics(document)]
        self.text_document_publish_diagnostics(t.PublishDiagnosticsParams(uri, found, version))

    # --- checking

    async def check(self, uri: str) -> None:
        """Check a text in another process, with progress and cancellation; store the verdicts."""
        document = self.document(uri)
        if document.running is not None:
            return
        document.running = await asyncio.create_subprocess_exec(
            sys.executable,
            "-P",  # a module in the user's folder must not replace one of ours
            "-m",
            f"{__package__}.worker",
            stdin=asyncio.subprocess.PIPE,
            stdout=asyncio.subprocess.PIPE,
            stderr=asyncio.subprocess.PIPE,
        )
        self._refresh()
        text = document.lines.text
        try:
            async with self._progress(document):
                out, errors = await document.running.communicate(self._asked(uri, document))
            ended = document.running.returncode
        finally:
            document.running = None
        self._keep(document, text, ended, out, errors.decode(errors="replace"))
        self._refresh()

    def _asked(self, uri: str, document: Document) -> bytes:
        folder = Path(self.pages.name) / hashlib.sha256(uri.encode()).hexdigest()[:16]
        reading = document.reading
        return json.dumps(
            {
                "name": reading.source.name,
                "text": reading.text,
                "directory": str(reading.directory),
                "folder": str(folder),
                "configurations": MOST_CONFIGURATIONS,
                "seconds": MOST_SECONDS,
            }
        ).encode()

    def _keep(self, document: Document, text: str, ended: int | None, out: bytes, errors: str) -> None:
        if ended:
            if ended > 0:
                self._tell(f"the check failed: {errors.strip()[-2000:]}", t.MessageType.Error)
            return
        found = json.loads(out)
        if "refused" in found:
            self._tell(f"there is nothing to check yet:\n{found['refused']}", t.MessageType.Warning)
            return
        document.checked, document.verdicts = text, found["verdicts"]

    @contextlib.asynccontextmanager
    async def _progress(self, document: Document) -> Any:
        """Show that a mission is being checked, if the editor can; the user can cancel it there."""
        token = f"check-{id(document)}-{id(document.running)}"
        capable = self.client_capabilities.window
        if capable is None or not capable.work_done_progress:
            yield
            return
        await self.work_done_progress.create_async(token)
        title = f"checking {document.reading.source.name}"
        self.work_done_progress.begin(token, t.WorkDoneProgressBegin(title, cancellable=True))
        cancelled = self.work_done_progress.tokens[token]
        cancelled.add_done_callback(lambda _: end(document))
        try:
            yield
        finally:
            self.work_done_progress.end(token, t.WorkDoneProgressEnd())

    def _refresh(self) -> None:
        capable = self.client_capabilities.workspace
        if capable is not None and capable.code_lens is not None and capable.code_lens.refresh_support:
            self.workspace_code_lens_refresh(None)

    def _tell(self, text: str, sort: t.MessageType) -> None:
        self.window_show_message(t.ShowMessageParams(sort, text))


def end(document: Document) -> None:
    """End the check of a text, if one runs."""
    if document.running is not None:
        with contextlib.suppress(ProcessLookupError):
            document.running.kill()


def make_server() -> Server:
    """Return a server with all its handlers."""
    server = Server()
    for method, answer, options in (
        (t.TEXT_DOCUMENT_DID_OPEN, _opened, None),
        (t.TEXT_DOCUMENT_DID_CHANGE, _changed, None),
        (t.TEXT_DOCUMENT_DID_SAVE, _changed, None),
        (t.TEXT_DOCUMENT_DID_CLOSE, _closed, None),
        (t.TEXT_DOCUMENT_HOVER, _hover, None),
        (t.TEXT_DOCUMENT_COMPLETION, _completion, t.CompletionOptions(trigger_characters=["."])),
        (t.TEXT_DOCUMENT_DEFINITION, _definition, None),
        (t.TEXT_DOCUMENT_REFERENCES, _references, None),
        (t.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT, _highlights, None),
        (t.TEXT_DOCUMENT_PREPARE_RENAME, _prepare_rename, None),
        (t.TEXT_DOCUMENT_RENAME, _rename, t.RenameOptions(prepare_provider=True)),
        (t.TEXT_DOCUMENT_FORMATTING, _formatting, None),
        (t.TEXT_DOCUMENT_DOCUMENT_SYMBOL, _symbols, None),
        (t.TEXT_DOCUMENT_CODE_ACTION, _actions, t.CodeActionOptions([t.CodeActionKind.QuickFix])),
        (t.TEXT_DOCUMENT_CODE_LENS, _lenses, None),
        (
            t.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL,
            _tokens,
            t.SemanticTokensLegend(token_types=[*TYPES], token_modifiers=[*MODIFIERS]),
        ),
    ):
        server.feature(method, options)(answer)
    for name, command in ((CHECK, _check), (CANCEL, _cancel), (SHOW_TRACE, _show_trace)):
        server.command(name)(command)
    return server


# --- texts


def _opened(server: Server, params: t.DidOpenTextDocumentParams) -> None:
    server.publish(params.text_document.uri)


def _changed(server: Server, params: t.DidChangeTextDocumentParams | t.DidSaveTextDocumentParams) -> None:
    server.look_soon(params.text_document.uri)


def _closed(server: Server, params: t.DidCloseTextDocumentParams) -> None:
    uri = params.text_document.uri
    document = server.documents.pop(uri, None)
    if document is not None:
        end(document)
    waiting = server.pending.pop(uri, None)
    if waiting is not None:
        waiting.cancel()
    server.text_document_publish_diagnostics(t.PublishDiagnosticsParams(uri, []))


def _diagnostics(document: Document) -> Iterator[t.Diagnostic]:
    diagnosis = document.reading.diagnosis
    levels = (
        (diagnosis.mistakes, t.DiagnosticSeverity.Error),
        (diagnosis.warnings, t.DiagnosticSeverity.Warning),
    )
    for found, severity in levels:
        for each in found:
            hint = f"\nhint: {each.hint}" if each.hint else ""
            yield t.Diagnostic(
                document.range(each.span), each.message + hint, severity, each.code.number, source="bigactors"
            )


# --- names


def _hover(server: Server, params: t.HoverParams) -> t.Hover | None:
    document = server.document(params.text_document.uri)
    found = hover(document.reading, document.offset(params.position))
    if found is None:
        return None
    return t.Hover(t.MarkupContent(t.MarkupKind.Markdown, found.text), document.range(found.span))


def _completion(server: Server, params: t.CompletionParams) -> list[t.CompletionItem]:
    document = server.document(params.text_document.uri)
    found = complete(document.reading, document.offset(params.position))
    where = document.range(found.span)
    return [
        t.CompletionItem(
            each.text,
            kind=COMPLETIONS[each.sort],
            detail=each.sort,
            sort_text=f"{list(COMPLETIONS).index(each.sort)}{each.text}",
            text_edit=t.TextEdit(where, each.text),
        )
        for each in found.all
    ]


def _definition(server: Server, params: t.DefinitionParams) -> t.Location | None:
    document = server.document(params.text_document.uri)
    occurrences = document.reading.occurrences
    found = occurrences.at(document.offset(params.position))
    span = occurrences.declared.get(found.symbol) if found is not None else None
    return None if span is None else t.Location(params.text_document.uri, document.range(span))


def _references(server: Server, params: t.ReferenceParams) -> list[t.Location]:
    document = server.document(params.text_document.uri)
    declaring = params.context.include_declaration
    spans = _same(document, params.position, declaring=declaring)
    return [t.Location(params.text_document.uri, document.range(span)) for span in spans]


def _highlights(server: Server, params: t.DocumentHighlightParams) -> list[t.DocumentHighlight]:
    document = server.document(params.text_document.uri)
    return [t.DocumentHighlight(document.range(span)) for span in _same(document, params.position)]


def _same(document: Document, position: t.Position, *, declaring: bool = True) -> list[s.Span]:
    occurrences = document.reading.occurrences
    found = occurrences.at(document.offset(position))
    if found is None:
        return []
    declared = occurrences.declared.get(found.symbol)
    return [each.span for each in occurrences.of(found.symbol) if declaring or each.span != declared]


def _prepare_rename(server: Server, params: t.PrepareRenameParams) -> t.Range:
    document = server.document(params.text_document.uri)
    try:
        return document.range(renaming.renamable(document.reading, document.offset(params.position)))
    except renaming.RenameRefused as refused:
        raise _request_failed(refused) from refused


def _rename(server: Server, params: t.RenameParams) -> t.WorkspaceEdit:
    document = server.document(params.text_document.uri)
    try:
        spans = renaming.rename(document.reading, document.offset(params.position), params.new_name)
    except renaming.RenameRefused as refused:
        raise _request_failed(refused) from refused
    edits = [t.TextEdit(document.range(span), params.new_name) for span in spans]
    return t.WorkspaceEdit({params.text_document.uri: edits})


def _request_failed(refused: renaming.RenameRefused) -> JsonRpcException:
    return JsonRpcException(str(refused), int(t.LSPErrorCodes.RequestFailed))


# --- the text as a whole


def _formatting(server: Server, params: t.DocumentFormattingParams) -> list[t.TextEdit]:
    document = server.document(params.text_document.uri)
    before = document.lines.text
    try:
        after = format_mission(before, document.reading.source.name)
    except MissionError:  # the editor already shows its mistakes
        return []
    if "\r\n" in before:
        after = after.replace("\n", "\r\n")
    return [t.TextEdit(document.range(span), text) for span, text in changes(before, after)]


def changes(before: str, after: str) -> Iterator[tuple[s.Span, str]]:
    """Yield the changed lines only, so that an editor's cursor stays in unchanged ones."""
    old, new = before.splitlines(keepends=True), after.splitlines(keepends=True)
    starts = [0]
    for line in old:
        starts.append(starts[-1] + len(line))
    for tag, first, last, begin, stop in difflib.SequenceMatcher(
        None, old, new, autojunk=False
    ).get_opcodes():
        if tag != "equal":
            yield s.Span(starts[first], starts[last]), "".join(new[begin:stop])


def _symbols(server: Server, params: t.DocumentSymbolParams) -> list[t.DocumentSymbol]:
    document = server.document(params.text_document.uri)
    return [_symbol(document, part) for part in outline(document.reading)]


def _symbol(document: Document, part: Part) -> t.DocumentSymbol:
    children = [_symbol(document, each) for each in part.parts]
    where, name = document.range(part.span), document.range(part.name)
    return t.DocumentSymbol(
        part.title or "-", SYMBOLS[part.sort], where, name, part.detail, children=children
    )


def _tokens(server: Server, params: t.SemanticTokensParams) -> t.SemanticTokens:
    document = server.document(params.text_document.uri)
    data: list[int] = []
    line = start = 0
    for each in tokens(document.reading):
        (at, first), (_, last) = (
            document.lines.position(offset) for offset in (each.span.start, each.span.end)
        )
        data += [at - line, first - start if at == line else first, last - first, each.type, each.modifiers]
        line, start = at, first
    return t.SemanticTokens(data)


def _actions(server: Server, params: t.CodeActionParams) -> list[t.CodeAction]:
    uri = params.text_document.uri
    document = server.document(uri)
    first, last = document.offset(params.range.start), document.offset(params.range.end)
    found: list[t.CodeAction] = []
    for each in document.reading.diagnosis.mistakes:
        if each.span.start <= last and first <= each.span.end:
            for fix in fixes(each, document.reading.text):
                edit = t.WorkspaceEdit({uri: [t.TextEdit(document.range(fix.span), fix.text)]})
                found.append(t.CodeAction(fix.title, t.CodeActionKind.QuickFix, edit=edit))
    return found


# --- checking


def _lenses(server: Server, params: t.CodeLensParams) -> list[t.CodeLens]:
    uri = params.text_document.uri
    document = server.document(uri)
    checks = document.reading.mission.each(s.Check)
    found: list[t.CodeLens] = []
    for node in checks:
        found += _lens(document, s.Span(node.span.start, node.span.start + 5), _running(document, uri))
        for each in node.properties:
            found += _lens(document, each.span, _verdict(document, title_of(each), uri))
    declared = document.reading.mission.declarations
    if not checks and any(isinstance(each, s.BigActor | s.Family) for each in declared):
        found += _lens(document, s.Span(0, 0), _running(document, uri))
        for name in document.verdicts:
            found += _lens(document, s.Span(0, 0), _verdict(document, name, uri, named=True))
    return found


def _lens(document: Document, span: s.Span, commands: Iterator[t.Command]) -> Iterator[t.CodeLens]:
    return (t.CodeLens(document.range(span), command) for command in commands)


def _running(document: Document, uri: str) -> Iterator[t.Command]:
    if document.running is not None:
        yield t.Command("checking ... (cancel)", CANCEL, arguments=[uri])
    else:
        yield t.Command("▶ check all", CHECK, arguments=[uri])


def _verdict(document: Document, name: str, uri: str, *, named: bool = False) -> Iterator[t.Command]:
    verdict = document.verdicts.get(name)
    if document.running is not None:
        yield t.Command("checking ... (cancel)", CANCEL, arguments=[uri])
        return
    if verdict is None:
        yield t.Command("▶ check", CHECK, arguments=[uri])
        return
    outcome = verdict["outcome"]
    said = f"{MARKS[outcome]} {f'{name} ' if named else ''}{outcome}"
    if document.checked != document.lines.text:
        said = f"▶ check again (before the last changes: {said})"
    yield t.Command(said, CHECK, arguments=[uri])
    if verdict["trace"]:
        shown = "show a run to it" if outcome == "holds" else "show the trace"
        yield t.Command(shown, SHOW_TRACE, arguments=[uri, name])


async def _check(server: Server, uri: str, *_: object) -> None:
    await server.check(uri)


def _cancel(server: Server, uri: str, *_: object) -> None:
    end(server.document(uri))


async def _show_trace(server: Server, uri: str, name: str, *_: object) -> str | None:
    page = server.document(uri).verdicts.get(name, {}).get("trace", "")
    if not page:
        return None
    address = from_fs_path(page) or ""
    capable = server.client_capabilities.window
    if capable is not None and capable.show_document is not None and capable.show_document.support:
        await server.window_show_document_async(t.ShowDocumentParams(address, external=True))
    else:
        server.window_show_message(t.ShowMessageParams(t.MessageType.Info, f"the trace is in {page}"))
    return address
