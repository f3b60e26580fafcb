"""How a run goes, where somebody looks: a line in a terminal, a bar in a notebook."""

from __future__ import annotations

import sys
from typing import Any, Callable

Progress = Callable[[str, float, float], None]


def _notebook() -> bool:
    """Whether this runs in a notebook, which shows what is displayed."""
    shell: Any = sys.modules.get("IPython")
    shell = shell.get_ipython() if shell is not None else None
    return shell is not None and shell.has_trait("kernel")


class _Line:
    """One line of a terminal, written over."""

    def __call__(self, phase: str, share: float, time_s: float) -> None:
        done = int(30 * share)
        bar = "█" * done + "░" * (30 - done)
        sys.stderr.write(f"\r{bar} {100 * share:5.1f} %  {1e3 * time_s:.2f} ms  {phase:<24}")
        sys.stderr.flush()

    def end(self) -> None:
        sys.stderr.write("\n")


class _Bar:
    """A bar in a notebook."""

    def __init__(self) -> None:
        from IPython.display import HTML, display

        self._html = HTML
        self._shown = display(HTML(""), display_id=True)

    def __call__(self, phase: str, share: float, time_s: float) -> None:
        words = f"{phase}, {1e3 * time_s:.2f} ms"
        self._shown.update(self._html(f"<progress value='{share:.4f}' max='1'></progress> {100 * share:.0f} % {words}"))

    def end(self) -> None:
        pass


class shown:
    """What a run tells of its progress: the caller's function, or what suits the place; nothing for False."""

    def __init__(self, progress: Progress | bool | None):
        self.tell: Any = None
        self._own: Any = None
        if callable(progress):
            self.tell = progress
        elif progress is not False:
            if _notebook():
                self._own = _Bar()
            elif progress is True or sys.stderr.isatty():
                self._own = _Line()
            self.tell = self._own

    def __enter__(self) -> Any:
        return self.tell

    def __exit__(self, *_: Any) -> None:
        if self._own is not None:
            self._own.end()
