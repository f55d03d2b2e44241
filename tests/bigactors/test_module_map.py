"""The map of a folder."""

from bigactors.module_map import ROOT, main, module_map


def test_a_map_has_each_module_with_a_sentence():
    found = dict(module_map(ROOT / "semantics"))
    assert {"rules", "state/cell_values", "."} <= set(found)
    assert all(sentence.endswith((".", ":")) for sentence in found.values())


def test_the_map_of_a_folder_is_printed(capsys):
    assert main(["checker/engines/fast"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert any(line.startswith("store/kernel ") for line in lines)
    assert main(["nowhere"]) == 2
    assert main([]) == 2
