"""Signed verdicts: a run that trusts a key flies by a verdict that is signed with it, and by no other."""

import json
import re
import shutil
import stat
import subprocess
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator

from bigactors.cli import main
from bigactors.verdict_files import _seal

SCHEMA = Path(__file__).parents[2] / "docs" / "reference" / "verdict.schema.json"
CHECK = ("check", "--no-traces", "--control", "timed", "--verdict", "v.json", "oil_spill")
RUN = [
    *[
        "run",
        "oil_spill",
        "--verdict",
        "v.json",
        "--vehicle=uav0=udp:127.0.0.1:0",
        "--wait",
        "0.1",
        "--socket",
        "s",
    ]
]
TRUSTING = (*RUN, "--trust", "own.key.pub")

MALFORMED = """\
v.json: the verdict's signature is malformed: \
it should be an object with 'key' and 'ed25519', which is 64 bytes in base64
  hint: the owner of the trusted key signs it: bigactors check --verdict FILE --sign KEY
"""


@pytest.fixture(scope="module")
def signed(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path_factory.mktemp("signed"))
        assert main(["keygen", "own.key"]) == main([*CHECK, "--sign", "own.key"]) == 0
        return Path.cwd()


@pytest.fixture
def there(signed, tmp_path, monkeypatch):
    """Work where there is a key pair, and a verdict that is signed with it."""
    shutil.copytree(signed, tmp_path / "there")
    monkeypatch.chdir(tmp_path / "there")
    return tmp_path / "there"


def changed(path, **members):
    data = json.loads(path.read_text(encoding="utf-8")) | members
    path.write_text(json.dumps(data | {"seal": _seal(data)}), encoding="utf-8")


def made(there, script):
    subprocess.run(["sh", "-c", f"umask 077; {script}"], check=True, cwd=there, capture_output=True)


def test_a_key_is_for_its_owner_alone_and_never_written_over(there, refused):
    assert stat.S_IMODE((there / "own.key").stat().st_mode) == 0o600
    before = (there / "own.key").read_bytes()
    said = "own.key: it is there already\n  hint: give another name, or move it away\n"
    assert refused("keygen", "own.key") == said
    assert (there / "own.key").read_bytes() == before
    (there / "own.key").unlink()
    assert refused("keygen", "own.key").startswith("own.key.pub: it is there already")
    assert not (there / "own.key").exists()


def test_a_signed_verdict_is_as_its_schema_says(there):
    data = json.loads((there / "v.json").read_text(encoding="utf-8"))
    Draft202012Validator(json.loads(SCHEMA.read_text(encoding="utf-8"))).validate(data)
    assert sorted(data["signature"]) == ["ed25519", "key"]


@pytest.mark.usefixtures("there")
def test_who_trusts_the_key_flies_and_so_does_who_asks_for_no_signature(bigactors):
    for line in (TRUSTING, RUN):
        assert bigactors(*line) == (
            2,
            "",
            "bigactors: nothing was heard of uav0\n  hint: is the address right, and the vehicle switched on?\n",
        )


def test_a_verdict_that_was_changed_and_sealed_again_does_not_fly(there, refused):
    changed(there / "v.json", engine="reference")
    assert "nothing was heard of uav0" in refused(*RUN)  # a seal alone doesn't show it
    said = (
        "v.json: the verdict was changed after it was signed\n  hint: the owner of the trusted key signs it"
    )
    assert refused(*TRUSTING).startswith(said)
    changed(there / "v.json", signature=None)
    assert "the verdict bears no signature" in refused(*TRUSTING)


@pytest.mark.parametrize("signature", ["x", 7, {}, {"key": 1, "ed25519": "x"}])
def test_a_malformed_signature_does_not_fly(there, refused, signature):
    changed(there / "v.json", signature=signature)
    assert refused(*TRUSTING) == MALFORMED


@pytest.mark.parametrize(
    ("value", "said"),
    [
        *((value, MALFORMED) for value in ("", "!", "QUJD", "A" * 88, "ſ" * 86 + "==")),
        ("A" * 86 + "==", "the verdict was changed after it was signed"),
    ],
)
def test_a_signature_of_something_else_does_not_fly(there, refused, value, said):
    data = json.loads((there / "v.json").read_text(encoding="utf-8"))
    changed(there / "v.json", signature=data["signature"] | {"ed25519": value})
    assert said in refused(*TRUSTING)


@pytest.mark.usefixtures("there")
def test_the_signature_of_another_key_does_not_fly(done, refused):
    done("keygen", "other.key")
    assert "the verdict is signed by another key: sha256:" in refused(*RUN, "--trust", "other.key.pub")


KEYS = """
--sign none: this is no key to sign with: it is not in PEM, or is damaged: give FILE of the pair
--sign rsa.key: this is no key to sign with: it is of another kind than Ed25519: give FILE of the pair
--sign own.key.pub: this is a public key, and the secret one signs: give FILE of the pair
--sign wide.key: its mode is 0640: chmod 600 wide.key; if others did,
--sign locked.key: this is no key to sign with: it needs a passphrase: give FILE of the pair
--trust none: this is no public key: it is not in PEM, or is damaged: give the FILE.pub of the signer
--trust rsa.key.pub: this is no public key: it is of another kind than Ed25519: give the FILE.pub of the signer
--trust own.key: this is a secret key, and the public one is trusted: give the FILE.pub of the signer
"""


def test_what_is_no_key_is_told_before_anything_is_explored(there, refused):
    made(there, "echo no key > none; cp own.key wide.key; chmod 640 wide.key")
    made(
        there,
        "openssl genpkey -algorithm RSA -out rsa.key && openssl pkey -in rsa.key -pubout -out rsa.key.pub",
    )
    made(there, "openssl genpkey -algorithm ed25519 -aes256 -pass pass:x -out locked.key")
    for option, path, cause, remedy in re.findall(r"^(\S+) (\S+): (.*):(.*)$", KEYS, re.MULTILINE):
        told = refused(*CHECK if option == "--sign" else RUN, option, path)
        assert told.startswith(f"{path}: ")
        assert f"{cause}\n  hint:{remedy}" in told
    assert "No such file" in refused(*CHECK, "--sign", "nowhere")


def test_a_key_of_openssl_serves_as_well(there, bigactors, refused):
    made(
        there,
        "openssl genpkey -algorithm ed25519 -out o.key && openssl pkey -in o.key -pubout -out o.key.pub",
    )
    assert bigactors(*CHECK, "--sign", "o.key")[0] == 0
    assert "nothing was heard of uav0" in refused(*RUN, "--trust", "o.key.pub")
