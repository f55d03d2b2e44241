import socket
import sys

from bigactors import live_demo


def demonstrate(monkeypatch, folder):
    monkeypatch.setattr(sys, "argv", ["live_demo", str(folder)])
    return live_demo.main()


def test_a_folder_into_which_another_demonstration_flies_is_left_alone(tmp_path, monkeypatch, capsys):
    (tmp_path / "run.mcap").write_bytes(b"the flight of now")
    with socket.socket(socket.AF_UNIX) as run:
        run.bind(str(tmp_path / live_demo.SOCKET))
        run.listen()
        assert demonstrate(monkeypatch, tmp_path) == 2
    assert "a demonstration flies into this folder" in capsys.readouterr().err
    assert (tmp_path / "run.mcap").read_bytes() == b"the flight of now"


def test_a_folder_that_cannot_be_is_a_mistake_and_no_bug(tmp_path, monkeypatch, capsys):
    (tmp_path / "file").touch()
    assert demonstrate(monkeypatch, tmp_path / "file" / "in it") == 2
    assert capsys.readouterr().err == f"{tmp_path / 'file' / 'in it' / 'camera'}: Not a directory\n"
