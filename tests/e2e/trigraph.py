"""A line of a .msg file that ends its string literal early if a compiler replaces the trigraph `??/` by a backslash."""

from __future__ import annotations

from pathlib import Path


def trigraph_text(file: Path) -> str:
    """Return the text of a string constant which, as C++, creates a file when its library is loaded."""
    path = ", ".join(map(str, [*str(file).encode(), 0]))
    code = f"char p[] = {{{path}}}, m[] = {{119, 0}}; std::fopen(p, m);"
    return f'??/"; namespace {{ struct Z {{ Z() {{ {code} }} }} z; }} //'
