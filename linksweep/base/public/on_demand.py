"""Import on demand: public names when they are first used, and what to do once another package is imported."""

from __future__ import annotations

import ast
import sys
from collections.abc import Callable, Mapping
from dataclasses import is_dataclass
from importlib import import_module
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any

Action = Callable[[ModuleType], None]


def modules_of_names(package_file: str) -> dict[str, str]:
    """Return the module of each public name of a package, from the imports of the stub beside its __init__.py."""
    stub = ast.parse(Path(package_file).with_name("__init__.pyi").read_text(encoding="utf-8"))
    imports = [statement for statement in stub.body if isinstance(statement, ast.ImportFrom)]
    return {alias.name: str(each.module) for each in imports for alias in each.names}


def public_name(package: str, name: str, modules: Mapping[str, str]) -> Any:
    """Import a public name of a package; what "comes from" the package itself is a module in it."""
    if name not in modules:
        raise AttributeError(f"module {package!r} has no attribute {name!r}")
    module = modules[name]
    if module == package:
        return import_module(f"{package}.{name}")
    item = getattr(import_module(module), name)
    if isinstance(item, FunctionType):
        return _of_package(package, item)
    if isinstance(item, type) and is_dataclass(item):
        from linksweep.base.frozen import with_clear_calls

        return with_clear_calls(item)
    return item


def _of_package(package: str, function: FunctionType) -> Any:
    """Return a function that names its parameters where it is called with others, as one of the package, where pickle
    finds it."""
    from linksweep.base.public.clear_calls import naming_parameters

    called = naming_parameters(function, called=function)
    called.__module__ = package
    return called


def when_imported(name: str) -> Callable[[Action], Action]:
    """Decorate a function that is called with a module: at once if it is imported, else right after its import."""

    def decorate(action: Action) -> Action:
        if sys.modules.get(name):
            action(import_module(name))  # waits where another thread is importing it
        else:
            sys.meta_path.insert(0, _Watch(name, action))
        return action

    return decorate


class _Watch(MetaPathFinder):
    """Finds one module where others find it, for a loader that calls `action` with it once it is executed."""

    def __init__(self, name: str, action: Action) -> None:
        self.name, self.action = name, action

    def find_spec(self, fullname: str, path: Any = None, target: ModuleType | None = None) -> ModuleSpec | None:
        if fullname != self.name:
            return None
        others = (finder for finder in sys.meta_path if finder is not self)
        spec = next(filter(None, (finder.find_spec(fullname, path, target) for finder in others)), None)
        if spec is not None and spec.loader is not None:
            spec.loader = _Announcing(spec.loader, self)
        return spec


class _Announcing(Loader):
    """A loader that executes a module by its own loader, which it leaves to it, and then calls the watch's action."""

    def __init__(self, loader: Loader, watch: _Watch) -> None:
        self.loader, self.watch = loader, watch

    def create_module(self, spec: ModuleSpec) -> ModuleType | None:
        return self.loader.create_module(spec)

    def exec_module(self, module: ModuleType) -> None:
        module.__loader__ = self.loader
        if module.__spec__:
            module.__spec__.loader = self.loader
        self.loader.exec_module(module)
        sys.meta_path.remove(self.watch)
        self.watch.action(module)
