"""Makes the certificate by which scheduler, workers and client of one cluster know each other."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

from autograder.exceptions import UsageError

CERTIFICATE, KEY = "cluster.pem", "cluster.key"
DAYS = 400


def make(folder: Path) -> tuple[Path, Path]:
    """Make a private key and a certificate that it signs, good for `DAYS` days; return the paths of both.

    All machines of a cluster get both files. Who has them can read and grade submissions. The folder is created for its
    owner alone.

    Raises:
        UsageError: one of the files exists, or `openssl` is not installed or fails.
    """
    certificate, key = folder / CERTIFICATE, folder / KEY
    for path in (certificate, key):
        if path.exists():
            raise UsageError(f"{path} exists: a cluster that uses it would not know the new one; remove it first")
    if shutil.which("openssl") is None:
        raise UsageError("openssl is not installed: sudo apt-get install openssl")
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    command = ["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes"]
    command += ["-subj", "/CN=autograder cluster", "-days", str(DAYS), "-keyout", str(key), "-out", str(certificate)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False, umask=0o077)
    if done.returncode != 0:
        raise UsageError(f"openssl could not make the certificate: {done.stderr.strip()}")
    return certificate, key
