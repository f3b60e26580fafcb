"""`python -m stribeck`: the program."""

from . import _main

_main()
