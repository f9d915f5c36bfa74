"""Fingerprints of code: what a stage runs, found by its imports and hashed by content.

A result is keyed on the sources that made it, so that nobody has to remember to raise a number.
The sources are found without running them: the modules that a module imports (inside functions
too), those that these import, and so on inside the package, with the data files of their folders
(`.toml`, templates). The libraries are those that these sources import, and what these require.

Rather redo than guess: a module that imports by a computed name counts as importing everything in
its folder. Of a package on the way to a module (`a` for `a.b`) the bytes of `__init__` count, not
its imports: otherwise the one list of all rooms would tie every room to every other.
"""

from __future__ import annotations

import hashlib
import re
import sys
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

from deamat.core.import_statements import Import, imports_in

_REQUIRED = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]*")


@dataclass(frozen=True, slots=True)
class Fingerprint:
    """The code behind a result.

    Parameters
    ----------
    code : digest of the sources and of the data files beside them
    libraries : distribution and version, sorted
    """

    code: str
    libraries: tuple[tuple[str, str], ...]


@dataclass(frozen=True, slots=True)
class Closure:
    """Files of the package below its folder, and top-level names that they import from outside."""

    files: frozenset[str]
    foreign: frozenset[str]


@dataclass(frozen=True, slots=True)
class Sources:
    """The sources of one package; a module is parsed when a closure first reaches it.

    Parameters
    ----------
    name : of the package, as it is imported
    root : its folder
    hashes : every file below it (`core/units.py`) to its sha256
    """

    name: str
    root: Path
    hashes: Mapping[str, str]
    _parsed: dict[str, tuple[frozenset[str], frozenset[str]]] = field(default_factory=dict)
    _data: dict[str, list[str]] = field(default_factory=dict)

    def fingerprint(self, starts: Iterable[str], without: Iterable[str] = ()) -> Fingerprint:
        """Hash what some modules run.

        Parameters
        ----------
        starts : modules by their full names (`deamat.techniques.compression`)
        without : modules left out, with all that only they import: those whose results are
            components of the key already

        Raises
        ------
        ModuleNotFoundError : a start that is no module of the package
        """
        found = self.closure(starts, without)
        digest = hashlib.sha256()
        for path in sorted(found.files):
            digest.update(f"{path} {self.hashes[path]}\n".encode())
        return Fingerprint(digest.hexdigest()[:16], libraries(found.foreign))

    def closure(self, starts: Iterable[str], without: Iterable[str] = ()) -> Closure:
        """Follow the imports of some modules; parameters and errors as for `fingerprint`."""
        out = frozenset(without)
        waiting = list(starts)
        for name in waiting:
            if self._file(name) is None:
                raise ModuleNotFoundError(f"no module {name} in {self.root}", name=name)
        seen: set[str] = set()
        files: set[str] = set()
        foreign: set[str] = set()
        while waiting:
            module = waiting.pop()
            if module in seen or module in out:
                continue
            seen.add(module)
            path = self._path(module)
            files |= {path, *self._data_beside(path)}
            files |= {self._path(parent) for parent in self._parents(module) if parent not in out}
            own, others = self._imports(module, path)
            waiting += own
            foreign |= others
        return Closure(frozenset(files), frozenset(foreign))

    def _file(self, module: str) -> str | None:
        """Find a module's file, None if it is not of this package."""
        package, _, rest = module.partition(".")
        if package != self.name:
            return None
        stem = rest.replace(".", "/")
        for path in (f"{stem}.py", f"{stem}/__init__.py".lstrip("/")):
            if path in self.hashes:
                return path
        return None

    def _path(self, module: str) -> str:
        path = self._file(module)
        if path is None:
            raise ModuleNotFoundError(f"no module {module} in {self.root}", name=module)
        return path

    def _parents(self, module: str) -> Iterator[str]:
        while "." in module:
            module = module.rpartition(".")[0]
            if self._file(module) is not None:  # a folder without `__init__` has nothing to count
                yield module

    def _data_beside(self, path: str) -> list[str]:
        if not self._data:
            for other in self.hashes:
                folder, _, name = other.rpartition("/")
                mine = self._data.setdefault(folder, [])
                if not name.endswith((".py", ".pyc")):
                    mine.append(other)
        return self._data.get(path.rpartition("/")[0], [])

    def _imports(self, module: str, path: str) -> tuple[frozenset[str], frozenset[str]]:
        """List the modules of the package that a module imports, and the other top-level names."""
        if module not in self._parsed:
            source = (self.root / path).read_text(encoding="utf-8")
            package = module if path.endswith("__init__.py") else module.rpartition(".")[0]
            names = [name for one in imports_in(source) for name in self._named(one, package)]
            own = frozenset(name for name in names if self._file(name) is not None)
            foreign = {name.partition(".")[0] for name in names} - {self.name}
            self._parsed[module] = own, frozenset(foreign - sys.stdlib_module_names)
        return self._parsed[module]

    def _named(self, one: Import, package: str) -> Iterator[str]:
        """Name the modules that one statement or call imports."""
        if one.module is None:
            yield from self._below(package)
            return
        base = one.module.lstrip(".")
        if above := len(one.module) - len(base):
            parts = package.split(".")
            base = ".".join([*parts[: len(parts) - above + 1], *filter(None, [base])])
        below = [f"{base}.{name}" for name in one.names]
        submodules = [name for name in below if self._file(name) is not None]
        yield from submodules
        if len(submodules) < len(below) or not below:
            yield base

    def _below(self, package: str) -> Iterator[str]:
        """Name every module in the folder of a package."""
        folder = "".join(f"{part}/" for part in package.split(".")[1:])
        for path in self.hashes:
            if path.startswith(folder) and path.endswith(".py"):
                stem = path.removesuffix(".py").removesuffix("__init__").rstrip("/")
                yield ".".join([self.name, *filter(None, stem.split("/"))])


@cache
def libraries(names: frozenset[str]) -> tuple[tuple[str, str], ...]:
    """Find the installed versions behind top-level names, and of what these distributions require.

    Returns
    -------
    distribution and version, sorted; a name that is not installed stands for itself with `absent`
    """
    found: dict[str, str] = {}
    waiting = [distribution for name in names for distribution in _distributions(name)]
    while waiting:
        name = waiting.pop()
        if name not in found:
            version, required = _installed(name)
            found[name] = version
            waiting += [other for other in required if _installed(other)[0] != _ABSENT]
    return tuple(sorted(found.items()))


_ABSENT = "absent"
_BROUGHT_BY = {"simdjson": "pysimdjson"}  # spares asking every distribution what it brings


def _distributions(module: str) -> list[str]:
    """Name the distributions that bring a module; mostly one of the same name."""
    name = _BROUGHT_BY.get(module, _normal(module))
    if _installed(name)[0] != _ABSENT:
        return [name]
    bringing = _packages()
    return [_normal(name) for name in bringing[module]] if module in bringing else [module]


@cache
def _packages() -> Mapping[str, list[str]]:
    from importlib.metadata import packages_distributions  # reads every list of files: 0.1 s

    return packages_distributions()


@cache
def _installed(name: str) -> tuple[str, tuple[str, ...]]:
    """Return the version of a distribution and the names of what it requires without extras."""
    from importlib import metadata

    try:
        distribution = metadata.distribution(name)
    except metadata.PackageNotFoundError:
        return _ABSENT, ()
    lines = [line for line in distribution.requires or () if "extra ==" not in line]
    needed = [match[0] for line in lines if (match := _REQUIRED.match(line))]
    return distribution.version, tuple(map(_normal, needed))


def _normal(name: str) -> str:
    """Write the name of a distribution as every tool compares it (PEP 503)."""
    return re.sub(r"[-_.]+", "-", name).lower()
