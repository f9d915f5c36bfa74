"""The errors of the pipeline: each says what is wrong, where, and what would put it right."""

from __future__ import annotations

from collections.abc import Mapping


class PipelineError(Exception):
    """Base of every error that the pipeline raises on purpose."""


class RawFileError(PipelineError):
    """A raw file that cannot be read for certain; nothing of it may reach a card.

    Parameters
    ----------
    path : file, as the user knows it (relative to `raw/`)
    reason : what is wrong
    line, column : where, counted from 1; `column` counts fields, not characters
    value : the text found there
    hint : what would make the file acceptable
    """

    def __init__(
        self,
        path: str,
        reason: str,
        line: int | None = None,
        column: int | None = None,
        value: str | None = None,
        hint: str = "",
    ) -> None:
        super().__init__(path, reason, line, column, value, hint)
        self.path = path
        self.reason = reason
        self.line = line
        self.column = column
        self.value = value
        self.hint = hint

    @property
    def place(self) -> str:
        """`path, line 3, column 2`, as far as it is known."""
        where = self.path
        if self.line is not None:
            where += f", line {self.line}"
        if self.column is not None:
            where += f", column {self.column}"
        return where

    def __str__(self) -> str:
        found = "" if self.value is None else f" (found {self.value!r})"
        hint = f"; {self.hint}" if self.hint else ""
        return f"{self.place}: {self.reason}{found}{hint}"


class ConfigError(PipelineError):
    """A configuration file or a command line that does not say what it must."""


class CardError(PipelineError):
    """A card that does not hold together, or a file that is not a card."""


class FitRefused(PipelineError):
    """An estimator declines to answer because its answer would not be trustworthy.

    Parameters
    ----------
    reason : why, with the numbers found and the numbers needed
    diagnostics : what was measured on the way
    selective : it was refused for its size, so that the mean of those that were not is biased
    """

    def __init__(
        self,
        reason: str,
        diagnostics: Mapping[str, float | int | str] | None = None,
        *,
        selective: bool = False,
    ) -> None:
        super().__init__(reason, diagnostics)
        self.reason = reason
        self.selective = selective
        self.diagnostics = dict(diagnostics or {})

    def __str__(self) -> str:
        return self.reason


class MissingProperty(PipelineError, KeyError):
    """A card has no such property, or several that the question does not tell apart.

    Parameters
    ----------
    reason : what is missing, and why
    hint : what there is instead
    """

    def __init__(self, reason: str, hint: str = "") -> None:
        super().__init__(reason, hint)
        self.reason = reason
        self.hint = hint

    def __str__(self) -> str:
        return f"{self.reason}; {self.hint}" if self.hint else self.reason


class OutOfRange(PipelineError, ValueError):
    """A question outside the range in which the answer is known to hold."""
