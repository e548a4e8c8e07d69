"""Generated data for the readers: valid data with a few changes, so that they pass the first checks."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

from hypothesis import strategies as st

# Tokens that made parsers fail: endless numbers, words of several formats, brackets, line ends, bytes.
TOKENS = (
    *(b"", b"0", b"-1", b"1e400", b"-1e-400", b"nan", b".inf", b"9" * 400, b"9" * 4301, b"0x1f", b"1_0", b"1" * 70),
    *(b"null", b"true", b"~", b"!!bool foo", b"!!int ''", b"!!timestamp foo", b"!!python/object:os.system x", b"*a"),
    *(b"&a ", b"<<: ", b"- ", b"? ", b"{", b"}", b"[" * 50, b"]", b"[" * 3000, b"<", b">", b"</", b"<![CDATA[", b"&x;"),
    *(b"<!DOCTYPE a [<!ENTITY x 'y'>]>", b"<a>" * 400, b"\\", b'"', b"'", b"#", b"%", b"=", b":", b": ", b";", b"@"),
    *(b"\0", b"\t", b"\r", b"\n", b"\n" * 40, b" " * 60, b"\xff", b"\xed\xa0\x80", b"\xef\xbb\xbf", b"\x1b[31m"),
    *(
        "é".encode(),
        "\u202e".encode(),
        "\u2028".encode(),
        "٣".encode(),
        "²".encode(),
        b"---\n",
        b"import ",
        b"..",
        b"/",
    ),
    *(b"encoding='foo'", b'encoding="utf-16"', b'encoding="idna"', b"\\ud800", b"$(", b"(" * 300, b"{" * 300),
)
NUMBERS = (0, -1, True, 0.5, 1e308, float("nan"), float("inf"), 2**31, 2**63, 2**64, 10**30, 10**400, -(10**4299))
SCALARS: st.SearchStrategy[Any] = st.one_of(
    st.none(),
    st.sampled_from(NUMBERS),
    st.integers(-3, 300),
    st.text(st.sampled_from("ab/_ \n\0\x1b\ud800\udc00é9"), max_size=8),
    st.sampled_from(("x" * 5000, "idle", "/cmd_vel T", "1", "NotImplementedError")),
)
JSON: st.SearchStrategy[Any] = st.recursive(
    SCALARS,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.sampled_from(("a", "data", "")), inner, max_size=2),
    max_leaves=5,
) | st.integers(1, 400).map(lambda depth: _nested(depth))


def _nested(depth: int) -> Any:
    value: Any = []
    for _ in range(depth):
        value = [value]
    return value


@st.composite
def altered(draw: st.DrawFn, *samples: bytes) -> bytes:
    """Draw one of the samples with up to four changes: a part is removed, repeated or replaced by a token."""
    data = draw(st.sampled_from(samples))
    for _ in range(draw(st.integers(0, 4))):
        start = draw(st.integers(0, len(data)))
        end = min(len(data), start + draw(st.sampled_from((0, 1, 3, 10, 40, 400))))
        replacement = draw(st.one_of(st.sampled_from(TOKENS), st.just(data[start:end] * 2), st.binary(max_size=6)))
        data = data[:start] + replacement + data[end:]
    return data


def texts(*samples: str) -> st.SearchStrategy[str]:
    """Return altered samples as text that a program has printed: invalid UTF-8 is replaced."""
    return altered(*(sample.encode() for sample in samples)).map(lambda data: data.decode(errors="replace"))


@st.composite
def altered_json(draw: st.DrawFn, *samples: Any) -> Any:
    """Draw one of the samples, JSON values, with up to three values changed or removed."""
    value = json.loads(json.dumps(draw(st.sampled_from(samples))))
    for _ in range(draw(st.integers(0, 3))):
        value = _changed(draw, value)
    return value


def _changed(draw: st.DrawFn, value: Any) -> Any:
    keys: Sequence[Any] = (
        list(value) if isinstance(value, dict) else range(len(value)) if isinstance(value, list) else ()
    )
    if not keys or draw(st.integers(0, 4)) == 0:
        return draw(JSON)
    key = draw(st.sampled_from(keys))
    if draw(st.integers(0, 5)) == 0:
        del value[key]
    else:
        value[key] = _changed(draw, value[key])
    return value
