"""The errors of the pipeline: each says what is wrong, where, and what would put it right."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

_NAMED = 4  # further faults of a file that are said in full


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
    others : what else is wrong with the file, in its order
    """

    def __init__(
        self,
        path: str,
        reason: str,
        line: int | None = None,
        column: int | None = None,
        value: str | None = None,
        hint: str = "",
        others: Sequence[RawFileError] = (),
    ) -> None:
        super().__init__(path, reason, line, column, value, hint, tuple(others))
        self.path = path
        self.reason = reason
        self.line = line
        self.column = column
        self.value = value
        self.hint = hint
        self.others = tuple(others)

    @classmethod
    def together(cls, faults: Sequence[RawFileError]) -> RawFileError:
        """Return the first of the faults of a file, with the others beside it."""
        first, *others = faults
        return cls(
            first.path, first.reason, first.line, first.column, first.value, first.hint, others
        )

    @property
    def within(self) -> str:
        """`line 3, column 2`, as far as it is known."""
        places = (("line", self.line), ("column", self.column))
        return ", ".join(f"{name} {at}" for name, at in places if at is not None)

    @property
    def place(self) -> str:
        """`path, line 3, column 2`, as far as it is known."""
        return f"{self.path}, {self.within}" if self.within else self.path

    @property
    def found(self) -> str:
        """The text found there, in brackets; empty where none is known."""
        return "" if self.value is None else f" (found {self.value!r})"

    @property
    def further(self) -> str:
        """The other faults in words, the first few of them in full; empty without any."""
        if not self.others:
            return ""
        named = [f"{one.within}: {one.reason}{one.found}" for one in self.others[:_NAMED]]
        rest = len(self.others) - len(named)
        more = f"; and {rest} further" if rest else ""
        return f"{len(self.others)} more: {'; '.join(named)}{more}"

    def __str__(self) -> str:
        said = f"{self.place}: {self.reason}{self.found}"
        return "; ".join(text for text in (said, self.hint, self.further) if text)


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
