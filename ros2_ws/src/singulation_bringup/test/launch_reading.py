"""Launch files read as text: ``launch`` itself need not be installed.

A call becomes a ``Call``, a launch argument a ``{name}`` inside a string; nothing of the file is executed.
"""

import ast
from dataclasses import dataclass, field
from pathlib import Path

LAUNCH = Path(__file__).parents[1] / "launch"
FILES = sorted(LAUNCH.glob("*.launch.py"))


@dataclass
class Call:
    name: str
    arguments: list
    keywords: dict = field(default_factory=dict)


class Reader:
    """The functions and constants of a launch file, evaluated as far as they are plain data."""

    def __init__(self, path):
        self.tree = ast.parse(path.read_text())
        self.functions = {node.name: node for node in self.tree.body if isinstance(node, ast.FunctionDef)}
        self.scope = {"str": "str", "int": "int", "float": "float", "bool": "bool"}
        for node in self.tree.body:
            if isinstance(node, ast.Assign):
                self.scope[node.targets[0].id] = self.value(node.value, self.scope)

    def run(self, name, arguments=()):
        function = self.functions[name]
        scope = dict(self.scope)
        names = [one.arg for one in function.args.args]
        scope.update(zip(names, arguments, strict=False))
        if function.args.vararg:
            scope[function.args.vararg.arg] = list(arguments[len(names) :])
        for node in function.body:
            if isinstance(node, ast.Assign):
                scope[node.targets[0].id] = self.value(node.value, scope)
            elif isinstance(node, ast.Return):
                return self.value(node.value, scope)
            else:
                assert isinstance(node, ast.Expr), ast.dump(node)
        return None

    def value(self, node, scope):
        if isinstance(node, ast.Constant):
            return node.value
        if isinstance(node, ast.Name):
            return scope[node.id]
        if isinstance(node, ast.List | ast.Tuple):
            return self.items(node.elts, scope)
        if isinstance(node, ast.Dict):
            return {
                self.value(key, scope): self.value(item, scope)
                for key, item in zip(node.keys, node.values, strict=True)
            }
        if isinstance(node, ast.JoinedStr):
            parts = [one.value if isinstance(one, ast.FormattedValue) else one for one in node.values]
            return "".join(str(self.value(one, scope)) for one in parts)
        assert isinstance(node, ast.Call), ast.dump(node)
        return self.call(node, scope)

    def items(self, nodes, scope):
        found = []
        for one in nodes:
            if isinstance(one, ast.Starred):
                found += self.value(one.value, scope)
            else:
                found.append(self.value(one, scope))
        return found

    def call(self, node, scope):
        name = node.func.id
        arguments = self.items(node.args, scope)
        keywords = {one.arg: self.value(one.value, scope) for one in node.keywords}
        if name in self.functions:
            return self.run(name, arguments)
        if name == "LaunchConfiguration":
            return f"{{{arguments[0]}}}"
        if name == "FindPackageShare":
            return f"share:{arguments[0]}"
        if name == "PathJoinSubstitution":
            return "/".join(text(one) for one in arguments[0])
        if name in ("str", "sorted"):
            return {"str": str, "sorted": sorted}[name](*arguments)
        return Call(name, arguments, keywords)


def text(value):
    """A substitution, or a list of them, as one string."""
    if isinstance(value, list):
        return "".join(text(one) for one in value)
    if isinstance(value, Call):
        return f"<{value.name} {' '.join(text(one) for one in value.arguments)}>"
    return str(value)


def calls(value, name):
    """All calls of a name anywhere inside a value."""
    found = []
    if isinstance(value, Call):
        found += [value] if value.name == name else []
        inside = [*value.arguments, *value.keywords.values()]
    elif isinstance(value, dict):
        inside = [*value.values()]
    else:
        inside = value if isinstance(value, list) else []
    for one in inside:
        found += calls(one, name)
    return found


def description(path):
    return Reader(path).run("generate_launch_description")


def nodes(path):
    return calls(description(path), "Node")


def arguments(path):
    """Launch arguments by name: default text (None if there is none), choices, description."""
    return {one.arguments[0]: one.keywords for one in calls(description(path), "DeclareLaunchArgument")}
