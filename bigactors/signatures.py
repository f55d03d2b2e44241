"""Signatures of verdicts (Ed25519), which show the author and detect changes; key pairs as PEM files.

Only this module uses the library `cryptography`.
"""

from __future__ import annotations

import base64
import hashlib
import re
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, Final

from adapters.private_files import open_private, others_may_read
from bigactors.files import read_bytes
from bigactors.mistakes import Mistake, unreadable
from physical.wordings import install_extra

if TYPE_CHECKING:
    from cryptography.hazmat.primitives.asymmetric import ed25519

    SigningKey = ed25519.Ed25519PrivateKey
    TrustedKey = ed25519.Ed25519PublicKey

DOMAIN: Final = b"bigactors.verdict/1\0"
"""The prefix of each signed text: no signature of another text is one of a verdict."""

_ED25519: Final = re.compile(r"[A-Za-z0-9+/]{86}==")

MOST_BYTES: Final = 10_000
"""The most bytes read of a key file."""

PUBLIC: Final = ".pub"
_PUBLIC_PEM, _SECRET_PEM = b"PUBLIC KEY-----", b"PRIVATE KEY-----"
_GIVE_SECRET: Final = f"give FILE of the pair FILE and FILE{PUBLIC}, which bigactors keygen FILE makes"
_GIVE_PUBLIC: Final = f"give the FILE{PUBLIC} of the signer, which bigactors keygen FILE makes"


def new_pair(path: Path) -> Path:
    """Write a new key, and beside it its public key as `.pub`; return that path. Raises Mistake if either exists."""
    public = path.with_name(path.name + PUBLIC)
    key = _crypto().ed25519.Ed25519PrivateKey.generate()
    for target in (path, public):
        if target.exists():
            raise Mistake("it is there already", "give another name, or move it away", str(target))
    try:
        with open_private(path, "xb") as file:
            file.write(_private_pem(key))
        public.write_bytes(_public_pem(key.public_key()))
    except OSError as error:
        raise unreadable(str(path), error) from error
    return public


def load_key(path: str) -> SigningKey:
    """Return the signing key of a file; raises Mistake for an invalid key, or one that others may read."""
    crypto, data = _crypto(), read_bytes(path, MOST_BYTES)
    if _PUBLIC_PEM in data:
        raise Mistake("this is a public key, and the secret one signs", _GIVE_SECRET, path)
    if mode := others_may_read(Path(path)):
        hint = f"chmod 600 {path}; if others did, make another: bigactors keygen FILE"
        raise Mistake(f"others may read the key: its mode is {mode}", hint, path)
    try:
        key = crypto.serialization.load_pem_private_key(data, password=None)
    except (ValueError, TypeError, crypto.exceptions.UnsupportedAlgorithm) as error:
        raise Mistake(f"this is no key to sign with: {_reason(error)}", _GIVE_SECRET, path) from error
    if not isinstance(key, crypto.ed25519.Ed25519PrivateKey):
        raise Mistake("this is no key to sign with: it is of another kind than Ed25519", _GIVE_SECRET, path)
    found: SigningKey = key
    return found


def load_trusted(path: str) -> TrustedKey:
    """Return the trusted public key of a file; raises Mistake for an invalid key."""
    crypto, data = _crypto(), read_bytes(path, MOST_BYTES)
    if _SECRET_PEM in data:
        raise Mistake("this is a secret key, and the public one is trusted", _GIVE_PUBLIC, path)
    try:
        key = crypto.serialization.load_pem_public_key(data)
    except (ValueError, TypeError, crypto.exceptions.UnsupportedAlgorithm) as error:
        raise Mistake(f"this is no public key: {_reason(error)}", _GIVE_PUBLIC, path) from error
    if not isinstance(key, crypto.ed25519.Ed25519PublicKey):
        raise Mistake("this is no public key: it is of another kind than Ed25519", _GIVE_PUBLIC, path)
    found: TrustedKey = key
    return found


def signature_json(key: SigningKey, text: bytes) -> dict[str, str]:
    """Return the signature of a text as plain data: the key's fingerprint and the value."""
    value = base64.b64encode(key.sign(DOMAIN + text)).decode("ascii")
    return {"key": fingerprint(key.public_key()), "ed25519": value}


def check_signature(signature: Any, text: bytes, trusted: TrustedKey, path: str) -> None:
    """Raise Mistake unless the signature is the trusted key's, with the reason."""
    hint = "the owner of the trusted key signs it: bigactors check --verdict FILE --sign KEY"
    match signature:
        case {"key": str(whose), "ed25519": str(value)} if _ED25519.fullmatch(value):
            pass
        case None:
            raise Mistake("the verdict bears no signature", hint, path)
        case _:
            form = "an object with 'key' and 'ed25519', which is 64 bytes in base64"
            raise Mistake(f"the verdict's signature is malformed: it should be {form}", hint, path)
    if whose != fingerprint(trusted):
        said = f"the verdict is signed by another key: {whose:.80}, and {fingerprint(trusted)} is trusted"
        raise Mistake(said, hint, path)
    try:
        trusted.verify(base64.b64decode(value), DOMAIN + text)
    except _crypto().exceptions.InvalidSignature as error:
        raise Mistake("the verdict was changed after it was signed", hint, path) from error


def fingerprint(key: TrustedKey) -> str:
    """Return a digest that identifies a key."""
    return "sha256:" + hashlib.sha256(key.public_bytes_raw()).hexdigest()


def _private_pem(key: SigningKey) -> bytes:
    form = _crypto().serialization
    return key.private_bytes(form.Encoding.PEM, form.PrivateFormat.PKCS8, form.NoEncryption())


def _public_pem(key: TrustedKey) -> bytes:
    form = _crypto().serialization
    return key.public_bytes(form.Encoding.PEM, form.PublicFormat.SubjectPublicKeyInfo)


def _reason(error: Exception) -> str:
    return "it needs a passphrase" if isinstance(error, TypeError) else "it is not in PEM, or is damaged"


def _crypto() -> Any:
    """Return the used parts of the library, which is an extra and slow to load."""
    try:
        from cryptography import exceptions  # noqa: PLC0415
        from cryptography.hazmat.primitives import serialization  # noqa: PLC0415
        from cryptography.hazmat.primitives.asymmetric import ed25519  # noqa: PLC0415
    except ImportError as error:
        raise Mistake("signatures need cryptography", install_extra("live")) from error
    return SimpleNamespace(exceptions=exceptions, serialization=serialization, ed25519=ed25519)
