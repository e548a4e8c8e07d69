"""Strings of a definition stay strings in rosidl's generated files, and are never run as code."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

from autograder.building.interfaces import Cache
from autograder.building.interfaces.prefix import build
from autograder.ros.environment import site_packages
from tests.e2e.trigraph import trigraph_text

# Creates `file` if the text of a constant runs as C or C++.
PAYLOAD = '__attribute__((constructor)) static void f(void) {{ FILE * f = fopen("{file}", "w"); fclose(f); }}'
TEXTS = {
    "QUOTE": '"; {payload} //',
    "PYTHON": "'; open('{file}', 'w'); '",
    "COMMENT": "*/ {payload} /*",
    "FORMAT": "%s %n {0} ${x} @(open('{file}', 'w')) @[end if]@ @{x}",
    "PLAIN": "".join(chr(code) for code in range(33, 127) if chr(code) not in "#\\'"),
}
READ = """
import json
from texts_msgs import texts_msgs_s__rosidl_typesupport_c
from texts_msgs.msg import A as message
constants = {name: getattr(message, name) for name in dir(message) if name.isupper() and name != "SLOT_TYPES"}
print(json.dumps([constants, message().say, list(message().words)]))
"""


def test_a_string_stays_a_string_in_c_cpp_and_python(tmp_path: Path) -> None:
    file = tmp_path / "ran"
    payload = PAYLOAD.format(file=file)
    texts = {name: text.replace("{payload}", payload).replace("{file}", str(file)) for name, text in TEXTS.items()}
    texts["TRIGRAPH"] = trigraph_text(file)
    quotes = {name: "'" if '"' in text else '"' for name, text in texts.items()}
    lines = [f"string {name}={quotes[name]}{text}{quotes[name]}" for name, text in texts.items()]
    trigraph, default, default_words = texts["TRIGRAPH"], '??/"; @(x) %s //', ['??/"a', "b'"]
    lines += [f"wstring WIDE='{trigraph}'", f"string say '{default}'", "string[] words ['??/\"a', \"b'\"]"]
    prefix = build("texts_msgs", {"msg/A.msg": "\n".join(lines) + "\n"}, cache=Cache(tmp_path / "cache"))
    environment = {**os.environ, "PYTHONPATH": str(site_packages(prefix))}
    command = [sys.executable, "-c", READ]
    process = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    assert json.loads(process.stdout) == [
        {**texts, "WIDE": trigraph, "SAY__DEFAULT": default, "WORDS__DEFAULT": default_words},
        default,
        default_words,
    ]
    assert not file.exists()
    sources = [path.read_text() for path in prefix.rglob("*") if path.suffix in (".h", ".py")]
    assert sources
    assert not [
        text for text in sources if any(word in text for word in ("((constructor", "open(", "??/", "%s %n", "struct Z"))
    ]
