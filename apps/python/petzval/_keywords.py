# SPDX-License-Identifier: Apache-2.0
"""Values of Python as the texts that the table of fields reads."""
from __future__ import annotations

import operator
import os
import shutil
import tempfile
import weakref
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Union

import numpy as np
from numpy.typing import NDArray

from . import _core  # type: ignore[attr-defined]
from ._errors import Error, FieldError

if np.lib.NumpyVersion(np.__version__) >= "2.0.0" and not _core.knows_numpy_2:
    raise ImportError(f"this build of Petzval knows numpy 1, and not {np.__version__}; use Debian's python3-numpy")

Number = Union[float, str]
File = Union[str, "os.PathLike[str]", NDArray[Any], "Spectrum"]
Words = Union[str, int, Sequence[Union[str, int]]]
Value = Union[str, float, "os.PathLike[str]", Sequence[float], NDArray[Any], "Spectrum"]
Texts = dict[str, list[str]]

FIELDS: dict[str, dict[str, str]] = {field["keyword"]: field for field in _core.fields()}


def numbers(name: str, values: Any, shape: tuple[int | None, ...]) -> NDArray[np.float64]:
    """Finite numbers of this shape, where None is any length. Raises FieldError, which names them."""
    try:
        array = np.array(values, dtype=float)
    except (TypeError, ValueError):
        raise FieldError(f"{name}: takes numbers, not {type(values).__name__}", name) from None
    if array.ndim != len(shape) or any(want not in (None, got) for want, got in zip(shape, array.shape)):
        wanted = ", ".join("N" if want is None else str(want) for want in shape)
        raise FieldError(f"{name}: has the shape {array.shape}, not ({wanted})", name)
    if not np.isfinite(array).all():
        raise FieldError(f"{name}: holds a value that is infinite or NaN", name)
    return array


def whole(name: str, value: Any, least: int, most: int) -> int:
    """Whole number in a range. Raises FieldError."""
    try:
        number = operator.index(value)
    except TypeError:
        raise FieldError(f"{name}: takes a whole number, not {value!r}", name) from None
    if not least <= number <= most:
        raise FieldError(f"{name}: {number} is not from {least} to {most}", name)
    return number


def matrix(name: str, values: Any) -> NDArray[np.float64]:
    """Matrix (4, 4) to the world, whose last column is the place. Raises FieldError."""
    pose = numbers(name, values, (4, 4))
    if not np.array_equal(pose[3], [0, 0, 0, 1]):
        raise FieldError(f"{name}: its last row is not 0, 0, 0, 1; the place is the last column", name)
    return pose


def path_text(name: str, path: Any) -> str:
    """Text of a path, which may hold bytes that are no UTF-8 as os.fsdecode() writes them. Raises FieldError."""
    try:
        text = os.fsdecode(path)
    except TypeError:
        raise FieldError(f"{name}: takes a path, not {type(path).__name__}", name) from None
    if "\0" in text:
        raise FieldError(f"{name}: holds a character 0", name)
    return text


class Spectrum:
    """Spectrum at these wavelengths in nm: one column of values, or three for a response.

    values: (N,) or (N, 3). As illuminant, response, or the reflectance of a Material.
    """

    def __init__(self, wavelengths_nm: Any, values: Any) -> None:
        self.wavelengths_nm = numbers("wavelengths_nm", wavelengths_nm, (None,))
        self.values = numbers("values", values, (None,) * max(1, min(2, np.ndim(values))))
        if len(self.values) != len(self.wavelengths_nm) or not len(self.values):
            raise FieldError(f"values: {len(self.values)} for {len(self.wavelengths_nm)} wavelengths; give one for each, "
                             "and at least one", "values")

    def __repr__(self) -> str:
        return f"Spectrum({len(self.wavelengths_nm)} wavelengths, {self.values.shape})"

    def save(self, path: os.PathLike[str]) -> None:
        """Writes a CSV file, as the command line reads it."""
        columns = self.values.reshape(len(self.wavelengths_nm), -1)
        names = ",".join(["wavelength_nm", *(f"value_{i + 1}" for i in range(columns.shape[1]))])
        rows = (",".join(map(repr, row)) for row in np.column_stack([self.wavelengths_nm, columns]).tolist())
        Path(path).write_text("\n".join([names, *rows]) + "\n")


def _remove(folder: str, process: int) -> None:
    if process == os.getpid():  # not in a fork of the owner
        shutil.rmtree(folder, ignore_errors=True)


class Files:
    """Folder for arrays that a render reads as files; it goes with the object that holds it."""

    def __init__(self) -> None:
        self._folder: Path | None = None

    def folder(self) -> Path:
        if self._folder is None:
            self._folder = Path(tempfile.mkdtemp(prefix="petzval-"))
            weakref.finalize(self, _remove, str(self._folder), os.getpid())
        return self._folder


def _number_text(number: float) -> str:
    return str(int(number)) if isinstance(number, float) and number.is_integer() else repr(number)


def _of_numbers(keyword: str, array: NDArray[Any]) -> str:
    if array.dtype.kind not in "iuf":
        raise FieldError(f"{keyword}: takes numbers, not {array.dtype}", keyword)
    if keyword == "pose" and array.shape == (4, 4):
        array = matrix(keyword, array)[:3]
    return FIELDS[keyword]["between"].join(map(_number_text, array.ravel().tolist()))


def _text(keyword: str, value: Any, files: Files) -> str:
    if isinstance(value, (str, bytes, os.PathLike)):
        return path_text(keyword, value)
    if isinstance(value, (int, float, np.integer, np.floating)) and not isinstance(value, bool):
        return _number_text(value.item() if isinstance(value, np.generic) else value)
    if isinstance(value, Spectrum):
        path = files.folder() / f"{keyword}.csv"
        value.save(path)
        return str(path)
    if isinstance(value, range) and value.step == 1:
        value = (value.start, value.stop)
    if isinstance(value, np.ndarray) and FIELDS[keyword]["kind"] == "FILE":
        path = files.folder() / f"{keyword}.exr"
        _write_exr(path, value, keyword)
        return str(path)
    if isinstance(value, (Sequence, np.ndarray)):
        try:
            return _of_numbers(keyword, np.asarray(value))
        except (TypeError, ValueError) as error:
            if isinstance(error, FieldError):
                raise
    raise FieldError(f"{keyword}: takes a text or numbers, not {type(value).__name__}", keyword)


def _texts(keyword: str, value: Any, files: Files) -> list[str]:
    kind = FIELDS[keyword]["kind"]
    if kind == "SWITCH":
        if not isinstance(value, (bool, np.bool_)):
            raise FieldError(f"{keyword}: is True or False, not {value!r}", keyword)
        return ["on"] if value else []
    if kind == "LIST" and isinstance(value, (Iterable, int)) and not isinstance(value, (str, bytes, bool)):
        return [_text(keyword, one, files) for one in ([value] if isinstance(value, int) else value)]
    return [_text(keyword, value, files)]


class Fields:
    """Values of keywords, of those that are not None, and their texts. Raises FieldError."""

    def __init__(self, values: Mapping[str, Any]) -> None:
        self.files = Files()
        self.values = {keyword: values[keyword] for keyword in FIELDS if values.get(keyword) is not None}
        self.texts: Texts = {keyword: _texts(keyword, value, self.files) for keyword, value in self.values.items()}
        _core.check_fields(encoded(self.texts))

    def __str__(self) -> str:
        return ", ".join(f"{keyword}={value!r}" for keyword, value in self.values.items())


def encoded(texts: Texts) -> list[tuple[str, bytes]]:
    """Keywords with one text each, as _core takes them."""
    return [(keyword, os.fsencode(text)) for keyword, several in texts.items() for text in several]


def naming_field(error: Error, texts: Texts) -> Error:
    """The error, with the keyword that it begins with, or whose file it is about, where it names none."""
    said = str(error)
    for keyword in (*FIELDS, "budget", "folder"):
        if error.field is None and said.startswith(keyword + ":"):
            error.field = keyword
    for keyword, several in texts.items():
        if error.field is None and any(text and said.startswith(text + ":") for text in several):
            error.field = keyword
    return error


def _write_exr(path: Path, pixels: NDArray[Any], name: str) -> None:
    with np.errstate(over="ignore"):
        light = numbers(name, pixels, (None, None, 3)).astype(np.float32)
    if not light.size or not ((light >= 0) & (light < np.inf)).all():
        raise FieldError(f"{name}: holds no pixel, or a value that is negative or too large", name)
    _core.write_exr(str(path), light)
