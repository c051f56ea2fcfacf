"""Pages of the documentation against the code."""

import re
from pathlib import Path

import pytest

from singulation_core import ResultCode

ROOT = Path(__file__).parents[4]
PAGES = sorted([*(ROOT / "docs").glob("*.md"), ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md"])


def sections():
    text = (ROOT / "docs" / "result_codes.md").read_text()
    parts = re.split(r"^### (\w+) \((\d+)\)$", text, flags=re.MULTILINE)
    return [(name, int(value), body.strip()) for name, value, body in zip(*[iter(parts[1:])] * 3, strict=True)]


def test_every_code_has_its_section_in_order():
    assert [(name, value) for name, value, _ in sections()] == [(code.name, int(code)) for code in ResultCode]


@pytest.mark.parametrize(("name", "value", "body"), sections(), ids=lambda value: str(value)[:24])
def test_a_section_says_something(name, value, body):
    assert len(body) >= 30
    if value not in (0, 200) and value < 200:
        assert "**Do:**" in body


@pytest.mark.parametrize("page", [page for page in PAGES if page.exists()], ids=lambda page: page.name)
def test_links_lead_somewhere(page):
    text = re.sub(r"```.*?```", "", page.read_text(), flags=re.DOTALL)
    for target in re.findall(r"\]\(([^)#]+)[^)]*\)", text):
        if not target.startswith("http"):
            assert (page.parent / target).exists(), target
