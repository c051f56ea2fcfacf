"""The one exception family of the libraries: a result code and a text that helps."""

from singulation_core.result_code import ResultCode


class SingulationError(Exception):
    """Something could not be done; ``code`` says what kind of thing.

    The message says what was wrong, with the value, what would be right, and where.
    """

    def __init__(self, code: ResultCode, message: str) -> None:
        super().__init__(message)
        self.code = code

    @property
    def message(self) -> str:
        """The text without the code."""
        return str(self.args[0])

    def __str__(self) -> str:
        return f"{self.code.name} ({int(self.code)}): {self.message}"


class InvalidInputError(SingulationError):
    """Malformed data, refused at the border (``ResultCode.INVALID_INPUT``)."""

    def __init__(self, message: str) -> None:
        super().__init__(ResultCode.INVALID_INPUT, message)
