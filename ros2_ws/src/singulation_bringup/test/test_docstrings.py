"""What the API documentation is made of: every public name says what it is, entry points with arguments and errors."""

import ast
import dataclasses
import importlib
import inspect
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[4]
SOURCE = ROOT / "ros2_ws" / "src"
PACKAGES = sorted(path.parent.name for path in SOURCE.glob("*/setup.py"))
ARRAY = re.compile(r"\bNDArray\b|\bFloatArray\b|\bndarray\b")


def public(body, place):
    """(name, node) of every public class and function, methods included."""
    for node in body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef) and not node.name.startswith("_"):
            yield f"{place}.{node.name}", node
            if isinstance(node, ast.ClassDef):
                yield from public(node.body, f"{place}.{node.name}")


def all_public():
    for package in PACKAGES:
        for path in sorted((SOURCE / package / package).rglob("*.py")):
            tree = ast.parse(path.read_text())
            module = ".".join(path.relative_to(SOURCE / package).with_suffix("").parts)
            yield module, tree
            yield from public(tree.body, module)


def raises_itself(node):
    return isinstance(node, ast.FunctionDef) and any(isinstance(one, ast.Raise) and one.exc for one in ast.walk(node))


def entry_points():
    found = []
    for package in PACKAGES:
        module = importlib.import_module(package)
        for name in getattr(module, "__all__", ()):
            entry = getattr(module, name)
            if inspect.isfunction(entry) or inspect.isclass(entry):
                found.append(pytest.param(entry, id=f"{package}.{name}"))
    return found


def test_every_public_name_says_what_it_is():
    names = list(all_public())
    assert len(names) > 1000
    assert [name for name, node in names if not ast.get_docstring(node)] == []


def test_what_is_raised_is_documented():
    found = [name for name, node in all_public() if raises_itself(node) and "Raise" not in ast.get_docstring(node)]
    assert found == []


@pytest.mark.parametrize("entry", entry_points())
def test_entry_points_document_their_arguments(entry):
    text = inspect.getdoc(entry)
    if inspect.isfunction(entry):
        names = list(inspect.signature(entry).parameters)
    elif dataclasses.is_dataclass(entry):
        names = [field.name for field in dataclasses.fields(entry) if field.init and not field.name.startswith("_")]
    else:
        names = []
    assert [name for name in names if not re.search(rf"\b{name}\b.*:", text)] == []


@pytest.mark.parametrize("entry", entry_points())
def test_entry_points_document_shapes(entry):
    if inspect.isfunction(entry) and ARRAY.search(str(inspect.signature(entry))):
        assert re.search(r"\(\w+, |\dx\d|[Aa]s (for )?``", inspect.getdoc(entry))
