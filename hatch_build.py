"""Build a wheel that puts one name into site-packages: `bigactors`.

In the repository a room is a folder at the top, and modules say `from semantics.rules import env`. Installed, that name
would be taken from everybody else (PyPI has another `adapters`). So the wheel has `bigactors.semantics`: the modules of
the repository, with every import of a room rewritten on the line where it stands.

`python hatch_build.py FROM TO` writes a folder so: the tests that run against the wheel. `python hatch_build.py parts`
has npm fetch what the pages are made of, and copies the files that they load to where a page finds them; both
sdist and wheel contain them, so a wheel is made from the sdist without npm.
"""

import ast
import json
import re
import subprocess
import sys
from pathlib import Path
from shutil import copyfile, copytree, ignore_patterns, rmtree, which
from tempfile import TemporaryDirectory
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

PACKAGE = "bigactors"
ROOT = Path(__file__).parent
ROOMS = sorted({path.parent.name for path in ROOT.glob("*/__init__.py")} - {PACKAGE})

IMPORT = re.compile(rf"^( *(?:>>> )?from )(?=(?:{'|'.join(ROOMS)})\b[\w.]* import )", re.MULTILINE)
"""Where an import of a room names it, in a doctest too."""

COMMAND = re.compile(rf"(python -m )(?=(?:{'|'.join(ROOMS)})\b)")
"""Where a text tells how to run a module of a room."""


PAGE = ROOT / "adapters" / "console" / "page"
PARTS = {
    "leaflet.css": "leaflet/dist/leaflet.css",
    "leaflet.js": "leaflet/dist/leaflet.js",
    "pmtiles.js": "pmtiles/dist/pmtiles.js",
    "preact.js": "htm/preact/standalone.module.js",
    "protomaps-leaflet.js": "protomaps-leaflet/dist/protomaps-leaflet.js",
}
"""The files that the pages load, by the packages that npm puts into `node_modules`."""

EDITOR = (
    *(f"@codemirror/{name}" for name in ("autocomplete", "commands", "language", "lint", "lsp-client")),
    *("@codemirror/search", "@codemirror/state", "@codemirror/view", "@lezer/highlight"),
)
"""The packages that esbuild makes one module of, for the studio: `codemirror.js`."""

NO_NPM = "there is no npm: all works but `bigactors console` and `bigactors studio`, whose pages need it"


class CustomBuildHook(BuildHookInterface[Any]):
    """What hatchling calls before and after a build; an editable install has the repository as it is."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Have the page's parts there, lay out the package, and give it to the wheel."""
        if version == "editable":
            return
        if not (PAGE / "parts").exists():
            gather_parts()
        if self.target_name != "wheel":
            return
        self.folder = TemporaryDirectory()
        package = Path(self.folder.name) / PACKAGE
        write_package(package)
        write_tables(package)
        build_data["force_include"][str(package)] = PACKAGE

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:  # noqa: ARG002 - hatchling's
        """Delete what was laid out."""
        if version != "editable" and self.target_name == "wheel":
            self.folder.cleanup()


def write_package(folder: Path) -> None:
    """Write the package as it is installed, with the rooms in it."""
    write_installed(ROOT / PACKAGE, folder)
    for room in ROOMS:
        if (folder / room).exists() or (folder / f"{room}.py").exists():
            raise ValueError(f"{PACKAGE}/{room} has the name of a room: call it something else")
        write_installed(ROOT / room, folder / room)
    for path in sorted(folder.rglob("*.py*")):
        refuse_imports_of_rooms(path, folder)


def write_tables(package: Path) -> None:
    """Let the package write the tables of its parsers, which are made at each start where they are missing."""
    for module, parser in (
        ("specs.grammar", "grammar"),
        ("bigraphs.notation.big.parser", "tables"),
        ("bigraphs.notation.bgm.parser", "tables"),
    ):
        program = f"from {PACKAGE}.{module} import TABLES, {parser}; {parser}(); TABLES.stat()"
        subprocess.run([sys.executable, "-B", "-c", program], cwd=package.parent, check=True)


def write_installed(source: Path, target: Path) -> None:
    """Copy a folder, with its modules as they are installed."""
    unwanted = ignore_patterns("__pycache__", "node_modules", "package*.json")
    copytree(source, target, ignore=unwanted, dirs_exist_ok=True)
    for path in target.rglob("*.py*"):
        path.write_text(installed(path.read_text(encoding="utf-8")), encoding="utf-8")


def installed(text: str) -> str:
    """Return a module's text with `bigactors.` before the rooms that it imports from."""
    return COMMAND.sub(rf"\1{PACKAGE}.", IMPORT.sub(rf"\1{PACKAGE}.", text))


def refuse_imports_of_rooms(path: Path, folder: Path) -> None:
    """Raise ValueError where a module still imports a room by the name that it has in the repository."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        match node:
            case ast.Import(names):
                modules = [alias.name for alias in names]
            case ast.ImportFrom(str(module), _, 0):
                modules = [module]
            case _:
                continue
        for module in modules:
            if module.split(".")[0] in ROOMS:
                place = f"{path.relative_to(folder)}:{node.lineno}"
                raise ValueError(f"{place} imports {module}: write 'from {module} import ...'")


def gather_parts() -> None:
    """Fetch what the console's page is made of, and put what it loads into `parts`, with the licenses."""
    npm = which("npm")
    if npm is None:
        print(NO_NPM, file=sys.stderr)  # noqa: T201
        return
    subprocess.run(
        [npm, "ci", "--ignore-scripts", "--no-audit", "--no-fund", "--silent"], cwd=PAGE, check=True
    )
    rmtree(PAGE / "parts", ignore_errors=True)
    (PAGE / "parts").mkdir()
    for part, source in PARTS.items():
        copyfile(PAGE / "node_modules" / source, PAGE / "parts" / part)
    bundle = [
        npm,
        "exec",
        "--offline",
        "--",
        "esbuild",
        "--bundle",
        "--format=esm",
        "--minify",
        "--log-level=warning",
    ]
    exports = "".join(f'export * from "{name}";\n' for name in EDITOR)
    with (PAGE / "parts" / "codemirror.js").open("wb") as file:
        subprocess.run(bundle, cwd=PAGE, input=exports.encode(), stdout=file, check=True)
    tools = tools_of(json.loads((PAGE / "package-lock.json").read_text(encoding="utf-8")))
    packages = sorted((PAGE / "node_modules").rglob("package.json"))
    parts = [path.parent for path in packages if is_package(path) and path.parent not in tools]
    texts = [license_of(path) for path in parts]
    (PAGE / "parts" / "LICENSES.txt").write_text("\n".join(texts), encoding="utf-8")


def tools_of(lock: dict[str, Any]) -> set[Path]:
    """Return the folders of the packages that only make parts: no part contains their code."""
    return {PAGE / folder for folder, about in lock["packages"].items() if about.get("dev")}


def is_package(path: Path) -> bool:
    """Tell whether a `package.json` describes a package whose code a part may contain."""
    folder = path.parent.parent
    return folder.name == "node_modules" or (folder.name.startswith("@") and folder.name != "@types")


def license_of(package: Path) -> str:
    """Return a package's name, version and license; some have no text of it."""
    about = json.loads((package / "package.json").read_text(encoding="utf-8"))
    title = f"{about['name']} {about['version']}: {about['license']}"
    texts = [path.read_text(encoding="utf-8").strip() for path in sorted(package.glob("LICEN[CS]E*"))]
    return "\n\n".join([title, "=" * len(title), *texts]) + "\n"


if __name__ == "__main__":
    if sys.argv[1:] == ["parts"]:
        gather_parts()
    else:
        write_installed(Path(sys.argv[1]), Path(sys.argv[2]))
