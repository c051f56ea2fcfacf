"""The two lists of result codes are one."""

import re
from pathlib import Path

from singulation_core import InvalidInputError, ResultCode, SingulationError

MESSAGE = Path(__file__).parents[2] / "singulation_msgs" / "msg" / "ResultCode.msg"


def test_enum_and_message_list_the_same_codes():
    constants = re.findall(r"^uint16\s+([A-Z_]+)\s*=\s*(\d+)", MESSAGE.read_text(encoding="utf-8"), re.MULTILINE)
    assert {name: int(value) for name, value in constants} == {code.name: code.value for code in ResultCode}


def test_codes_differ():
    assert len({code.value for code in ResultCode}) == len(list(ResultCode.__members__))


def test_an_error_says_its_code_and_its_text():
    error = SingulationError(ResultCode.NO_PUSH, "nothing is reachable")
    assert (error.code, error.message) == (ResultCode.NO_PUSH, "nothing is reachable")
    assert str(error) == "NO_PUSH (201): nothing is reachable"
    assert InvalidInputError("bad").code is ResultCode.INVALID_INPUT
