"""The page about the executor against the code: every fault case, its code and its tests exist."""

import re
from pathlib import Path

import pytest

from singulation_core import ResultCode

ROOT = Path(__file__).parents[4]
SOURCES = ROOT / "ros2_ws" / "src"


@pytest.fixture(scope="module")
def page():
    return (ROOT / "docs" / "executor.md").read_text()


def test_every_case_has_a_row(page):
    found = {int(number) for number in re.findall(r"^\| E(\d+) \|", page, flags=re.MULTILINE)}
    assert found == set(range(1, 22))


def test_every_test_named_exists(page):
    files = [*SOURCES.glob("yumi_push_executor/test/**/test_*.py"), *SOURCES.glob("singulation_sim/test/test_*.py")]
    known = set(re.findall(r"^def (test_\w+)\(", "\n".join(file.read_text() for file in files), flags=re.MULTILINE))
    assert set(re.findall(r"`(test_\w+)`", page)) - known == set()


def test_every_code_of_the_executor_is_on_the_page(page):
    codes = {code.name for code in ResultCode if 300 <= code < 400}
    assert codes - set(re.findall(r"[A-Z_]{4,}", page)) == set()
