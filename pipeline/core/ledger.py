"""The account of every file under `raw/`: what became of it, once and only once."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar, Literal

from deamat.core.errors import RawFileError
from deamat.core.schema import Entry

Status = Literal["used", "refused", "rejected", "excluded", "failed"]
Role = Literal["recording", "register", "campaign", "manifest", "document", "unnamed", "missing"]


@dataclass(frozen=True, slots=True)
class FileEntry:
    """One file and its fate.

    Parameters
    ----------
    path : relative to `raw/`
    sha256 : of its bytes, empty for a file that is missing
    role : what it is to its campaign; `unnamed` is a data file that no register names
    status : `used` gave at least one value; `refused` was read and gave none; `rejected` could not
        be read for certain; `excluded` is named in `config/exclusions.toml`; `failed` met an
        internal error of the program, which a `Failure` describes
    manifest : `ok`, or how it departs from the manifest: `changed`, `missing`, `extra` (not in it),
        `extended` (a register with rows appended)
    reason, line, column : why, and where in the file; of several bad rows one reason a line, and
        the place of the first
    placed : the reason itself begins with the path and the place
    awaits : name of the folder it stands in, where no technique is called so
    """

    ENTRY: ClassVar = Entry("file", "files", identity=("path",))

    path: str
    sha256: str
    size: int
    role: Role
    status: Status
    manifest: Literal["ok", "changed", "missing", "extra", "extended"] = "ok"
    reason: str = ""
    line: int | None = None
    column: int | None = None
    placed: bool = False
    awaits: str | None = None

    def __str__(self) -> str:
        return self.reason if self.placed else f"{self.path}: {self.reason}"

    def rejected(self, *errors: RawFileError) -> FileEntry:
        """Return the entry as rejected for these reasons, beside those that it is rejected for."""
        reasons = [str(error) for error in errors]
        if self.status == "rejected":
            return replace(self, reason="\n".join([self.reason, *reasons]))
        first = errors[0]
        own = first.path == self.path
        line, column = (first.line, first.column) if own else (None, None)
        reason = "\n".join(reasons)
        return replace(self, status="rejected", reason=reason, line=line, column=column, placed=own)

    @property
    def violates(self) -> bool:
        """Say whether this entry alone makes the run end with a non-zero status."""
        return self.status != "excluded" and (self.status == "rejected" or self.manifest != "ok")


@dataclass(frozen=True, slots=True)
class Failure:
    """An internal error: one unit of work ended in something that no project error foresaw.

    Parameters
    ----------
    stage, subject : the unit, as `deamat explain` calls it
    error : its kind and message, in one line
    traceback : for whoever looks for the fault in the program
    files : raw files that the unit rests on, relative to `raw/`
    """

    stage: str
    subject: str
    error: str
    traceback: str
    files: tuple[str, ...]

    def __str__(self) -> str:
        return f"{self.stage} {self.subject} ({self.error})"


@dataclass(frozen=True, slots=True)
class Provenance:
    """What made a release. It stands beside the contents and is no part of them.

    Parameters
    ----------
    version : of the distribution
    code : digest of the package's sources
    stages : name (`measurement compression`) to fingerprint of the code that ran it
    environment : Python, platform, and each library that computed, to its version
    config : file name to sha256 of the configuration files
    """

    version: str
    code: str
    stages: tuple[tuple[str, str], ...]
    environment: tuple[tuple[str, str], ...]
    config: tuple[tuple[str, str], ...]
