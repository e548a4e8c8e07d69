# Copyright 2026 The ROS 2 Python Course Authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""The licence header that each source file of a ROS 2 package carries."""

from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1]


@pytest.mark.linter
def test_copyright():
    """Ament's own linter finds a known licence in each source file."""
    linter = pytest.importorskip('ament_copyright.main')  # part of ROS 2, but not of its wheels
    assert linter.main(argv=[str(PACKAGE)]) == 0


@pytest.mark.linter
def test_each_source_file_starts_with_its_licence():
    """Every Python file but setup.py starts with whose it is and under which licence."""
    sources = sorted(set(PACKAGE.rglob('*.py')) - {PACKAGE / 'setup.py'})
    assert sources
    for source in sources:
        first, _, third = source.read_text().splitlines()[:3]
        assert first.startswith('# Copyright 2'), source
        assert 'Apache License, Version 2.0' in third, source
