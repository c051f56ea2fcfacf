"""Builds the API documentation with pdoc: every public module of the suite, from its docstrings.

Usage: python api_pages.py FOLDER
"""

import importlib
import pkgutil
import sys
import warnings
from pathlib import Path

PACKAGES = (
    "singulation_core",
    "singulation_node",
    "singulation_perception",
    "singulation_planner",
    "yumi_push_executor",
    "singulation_sim",
    "singulation_bringup",
)


def public_modules(package: str) -> list[str]:
    """The package and every module below it whose name does not begin with an underscore."""
    path = importlib.import_module(package).__path__
    found = [one.name for one in pkgutil.walk_packages(path, f"{package}.")]
    return [package, *(name for name in found if not any(part.startswith("_") for part in name.split(".")))]


def load_lazy_names(package: str) -> None:
    """Put the names of ``__all__`` into the module: pdoc looks there and does not ask ``__getattr__``."""
    module = importlib.import_module(package)
    for name in getattr(module, "__all__", ()):
        setattr(module, name, getattr(module, name))


def main() -> None:
    """Write the pages."""
    import pdoc  # noqa: PLC0415  # installed for this alone, by scripts/docs

    for package in PACKAGES:
        load_lazy_names(package)
    pdoc.render.configure(docformat="google", footer_text="units: SI, frames: see README.md")
    # A package without __all__ brings its modules along.
    warnings.filterwarnings("ignore", message="The module specification")
    modules = [name for package in PACKAGES for name in public_modules(package)]
    pdoc.pdoc(*modules, output_directory=Path(sys.argv[1]))


if __name__ == "__main__":
    main()
