"""Runs a notebook from its first cell to its last; ends with the traceback of a cell that fails."""

import sys

import nbformat
from nbclient import NotebookClient

path = sys.argv[1]
NotebookClient(nbformat.read(path, as_version=4), timeout=1200, kernel_name="python3").execute()
print(f"{path}: every cell ran")
