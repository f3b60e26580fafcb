"""Fields of a scene, given as dicts, in the words of scene files."""

from __future__ import annotations

import difflib
import json
import math
import os
from collections.abc import Mapping
from typing import Any

# Fields whose value is a word, or a word with what belongs to it: {"reduced": {"modes_khz": 30}} is reduced(modes_khz: 30).
_WORDS = {
    "model": {"full", "reduced"},
    "housing": {"adapter", "pedestal", "mesh", "rigid", "springs"},
    "speed_profile": {"ramp", "harmonic", "points", "table"},
    "outer_speed_profile": {"ramp", "harmonic", "points", "table"},
    "load_profile": {"ramp", "harmonic", "points", "table"},
    "on": {"outer", "inner", "roller"},
    "form": {"spall", "dent", "profile", "waviness", "roughness", "diameter", "missing"},
}

# Fields whose value is a text, which stands in quotes; all other strings are words of their own.
_TEXTS = {"name", "designation", "file", "table", "text", "bore", "loaded", "raceway", "fit"}


def _is_word(key: str, value: Any) -> bool:
    return isinstance(value, Mapping) and len(value) == 1 and next(iter(value)) in _WORDS.get(key, ())


def _no_word(key: str, given: Mapping[str, Any]) -> ValueError:
    found, words = ", ".join(map(str, given)), sorted(_WORDS[key])
    near = difflib.get_close_matches(found, words, 1)
    return ValueError(
        f"{key} is {found or 'empty'}, which is not one of its words: {', '.join(words)}"
        + (f"; did you mean {near[0]}?" if near else "")
    )


def value(key: str, given: Any) -> str:
    """What stands behind ``key:`` in a scene file."""
    if hasattr(given, "tolist"):
        given = given.tolist()
    if isinstance(given, os.PathLike):
        given = os.fspath(given)
    if given is None:
        return "None"
    if isinstance(given, bool):
        return "true" if given else "false"
    if isinstance(given, float) and not math.isfinite(given):
        raise ValueError(f"{key} is {given}, which no scene can hold")
    if isinstance(given, (int, float)):
        return repr(given)
    if isinstance(given, str):
        return json.dumps(given, ensure_ascii=False) if key in _TEXTS else given
    if _is_word(key, given):
        ((word, inner),) = given.items()
        written = value(word, inner)
        return word + (written if written.startswith("(") else f"({written})")
    if isinstance(given, Mapping) and key in _WORDS:
        raise _no_word(key, given)
    if isinstance(given, Mapping):
        return "(" + ", ".join(f"{name}: {value(str(name), inner)}" for name, inner in given.items()) + ")"
    if isinstance(given, (list, tuple)):
        return "[" + ", ".join(_item(key, inner) for inner in given) + "]"
    raise ValueError(f"{key} is a {type(given).__name__}: numbers, strings, None, lists and dicts can stand in a scene")


def _item(key: str, given: Any) -> str:
    if hasattr(given, "tolist"):
        given = given.tolist()
    # Points of a profile are pairs, not lists.
    if key == "points" and isinstance(given, (list, tuple)):
        return "(" + ", ".join(value(key, inner) for inner in given) + ")"
    return value(key, given)


def overrides(fields: Mapping[str, Any], above: str = "") -> list[str]:
    """Each field as ``field.path=value``, as the program takes it. A dict goes into a section, field by field, and leaves the
    section's other fields as they are; in a list, and behind a word, it is the whole of a group."""
    found: list[str] = []
    for key, given in fields.items():
        path = f"{above}.{key}" if above else str(key)
        name = path.rsplit(".", 1)[-1]
        if name in _WORDS and isinstance(given, Mapping) and not _is_word(name, given):
            # What belongs to a word are numbers and texts: a dict among them is a word that is misspelt, or one too many.
            if any(isinstance(inner, Mapping) for inner in given.values()):
                raise _no_word(name, given)
        if isinstance(given, Mapping) and given and not _is_word(name, given):
            found += overrides(given, path)
        elif isinstance(given, str):
            # The program puts texts into quotes.
            found.append(f"{path}={given}")
        else:
            found.append(f"{path}={value(name, given)}")
    return found
