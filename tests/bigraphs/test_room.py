import subprocess
import sys

import bigraphs
import bigraphs.notation


def test_importing_the_room_loads_no_heavy_library():
    code = (
        "import sys, bigraphs; print(sorted({'lark', 'matplotlib', 'networkx', 'numpy'} & set(sys.modules)))"
    )
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "[]"


def test_public_names_are_sorted_and_there():
    for room in (bigraphs, bigraphs.notation):
        assert room.__all__ == sorted(room.__all__)
        assert all(hasattr(room, name) for name in room.__all__)
