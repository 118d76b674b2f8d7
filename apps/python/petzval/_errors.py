# SPDX-License-Identifier: Apache-2.0
"""Exceptions, with the words of the command line."""
from __future__ import annotations


class Error(Exception):
    """An error of Petzval. field: the keyword at fault, where one is."""

    def __init__(self, message: str, field: str | None = None) -> None:
        super().__init__(message)
        self.field = field

    def __reduce__(self) -> tuple[type, tuple[str, str | None]]:
        return type(self), (str(self), self.field)


class FieldError(Error, ValueError):
    """A value that a keyword cannot take, or keywords that do not go together."""


class InputError(Error, ValueError):
    """A fault in a file, or a request that a sound file cannot meet."""


class OutputError(Error, OSError):
    """A file that cannot be written."""

    def __str__(self) -> str:  # OSError would show a tuple
        return str(self.args[0])


class OutOfMemory(Error, MemoryError):
    """More memory is asked for than there is."""
