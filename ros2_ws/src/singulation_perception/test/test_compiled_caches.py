import os

import pytest

from singulation_perception.compiled_caches import drop_stale_caches


@pytest.mark.parametrize(
    ("text", "age", "removed"),
    [
        ("@compiled\ndef f(): ...", -10, 1),
        ("done = njit(fastmath=True)(f)", -10, 1),
        ("@compiled\ndef f(): ...", 10, 0),
        ("x = 1", -10, 0),
    ],
    ids=["newer kernel", "newer way to compile", "older kernel", "newer, nothing compiled"],
)
def test_only_caches_older_than_a_compiled_source_go(tmp_path, text, age, removed):
    source, cache = tmp_path / "source.py", tmp_path / "source.f-1.nbi"
    source.write_text(text)
    cache.write_bytes(b"code")
    os.utime(cache, (source.stat().st_mtime + age,) * 2)
    assert drop_stale_caches([tmp_path], tmp_path) == removed
    assert cache.exists() == (removed == 0)
