"""The page of a run: complete without a network, and readable on a phone."""

import json
import re

import numpy as np
import pytest
from PIL import Image
from ros2_ws.src.singulation_bringup.test.headless_browser import HeadlessBrowser

from singulation_bringup.demo.summary import Summary, object_entry, push_entry
from singulation_bringup.run_page import write_page
from singulation_core import Arrangement, ContactMode, PlanarObject, Push, ResultCode, SingulationError

SQUARE = np.array(((0.0, 0.0), (0.04, 0.0), (0.04, 0.04), (0.0, 0.04)))
HOSTILE = "a <b>message</b> & a/very/long/path/that/has/no/blank/" + "x" * 200


def row(gap):
    return Arrangement([PlanarObject(i, SQUARE + (i * (0.04 + gap), 0.0)) for i in range(3)])


def pushes():
    for number, mode in enumerate(ContactMode):
        push = Push((-0.02, 0.02), (0.02, 0.02), mode, 0.02 * (mode != 0), target_id=0, policy="cluster_push")
        code = ResultCode.OK if number else ResultCode.COLLISION_STOP
        outcome = {"code": int(code), "code_name": code.name, "message": "" if number else HOSTILE}
        before, after = object_entry(row(0.002 * number)), object_entry(row(0.002 + 0.002 * number))
        yield {**push_entry(push), **outcome, "before": before, "after": after}


def full_summary():
    frame = {"source": "recording.mcap", "code": 0, "code_name": "OK", "message": ""}
    summary = Summary(loop_code=ResultCode.OK, loop_message="3 objects separated", min_gap=0.005)
    summary.frames.append({**frame, "objects": object_entry(row(0.01)), "push": next(pushes())})
    summary.pushes += pushes()
    summary.singulation_distance += [0.5, 0.6, float("nan"), 0.8]
    summary.smallest_gap += [0.0, 0.002, 0.004, 0.006]
    summary.stages |= {"look": {"count": 4, "seconds": 1.0}, "plan": {"count": 0, "seconds": 0.0}}
    summary.seconds |= {"cell loop": 20.0, "total": 30.0}
    return summary


def page_of(folder, summary):
    picture = Image.fromarray(np.full((200, 1300, 3), 128, np.uint8))
    for name in ("run.gif", "cloud_01.png"):
        picture.save(folder / name)
        summary.files.append(name)
    summary.write(folder)
    return write_page(folder)


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    return page_of(tmp_path_factory.mktemp("run"), full_summary())


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    with HeadlessBrowser(tmp_path_factory.mktemp("profile")) as started:
        yield started


@pytest.mark.parametrize(("width", "mobile"), [(320, True), (390, True), (1280, False)])
def test_it_fits_its_window_and_shows_every_picture(page, browser, width, mobile):
    browser.open(page.as_uri(), width, mobile=mobile)
    assert browser.value("document.documentElement.scrollWidth") <= width
    assert browser.value("window.innerWidth") == width  # a phone shows it at its own width, not shrunk
    browser.value("Promise.all([...document.images].map(i => { i.loading = 'eager'; return i.decode(); }))")
    assert browser.value("[...document.images].every(i => i.naturalWidth > 0)")
    assert browser.value("document.images.length") == 2
    assert browser.value("document.querySelectorAll('svg').length") == 2 + 2 * 3
    smallest = "Math.min(...[...document.querySelectorAll('p, td, th, dd, dt, figcaption')].map(e => "
    assert browser.value(smallest + "parseFloat(getComputedStyle(e).fontSize)))") >= 13


def test_it_asks_nobody_for_anything(page, browser):
    browser.open(page.as_uri(), 1280)
    asked = [event["params"]["request"]["url"] for event in browser.events if "request" in event.get("params", {})]
    assert {url for url in asked if not url.startswith("data:")} <= {page.as_uri()}
    assert not [event for event in browser.events if event["method"] in ("Log.entryAdded", "Runtime.exceptionThrown")]
    assert not re.search(r"(src|href)=\"(?!data:)", page.read_text())


def test_every_outcome_is_told_and_text_stays_text(page, browser):
    browser.open(page.as_uri(), 390, mobile=True)
    text = browser.value("document.body.innerText")
    assert text.count("COLLISION_STOP (") == 1
    assert HOSTILE in text
    for number in (1, 2, 3):
        assert f"Push {number} " in text
    assert "look: trigger, cloud, segmentation" in text
    assert "NaN" not in text


@pytest.mark.parametrize("change", [{"pushes": []}, {"frames": []}, {"code": ResultCode.CANCELLED}])
def test_a_run_that_ended_early_has_a_page_too(tmp_path, change):
    summary = Summary(**change)
    assert "<main>" in page_of(tmp_path, summary).read_text()


def test_an_older_summary_without_stages_still_has_a_page(tmp_path):
    page_of(tmp_path, full_summary())
    content = json.loads((tmp_path / "summary.json").read_text())
    del content["stages"]
    (tmp_path / "summary.json").write_text(json.dumps(content))
    assert "<main>" in write_page(tmp_path).read_text()


@pytest.mark.parametrize("text", ["", "[]", '{"frames": []}', "{"])
def test_a_folder_that_is_none_of_ours_is_refused(tmp_path, text):
    (tmp_path / "summary.json").write_text(text)
    with pytest.raises(SingulationError) as caught:
        write_page(tmp_path)
    assert caught.value.code is ResultCode.BAD_FILE
    assert "summary.json" in str(caught.value)
