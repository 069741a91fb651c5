"""Drawings of scenes: the setting to scale, and ray diagrams."""

from __future__ import annotations

import os

from . import _cloakroom

__all__ = ["Drawing"]


class Drawing:
    """A drawing, of `Scene.setting` or `Scene.diagram`. In a notebook it shows itself."""

    _native: _cloakroom.Drawing

    def __init__(self) -> None:
        raise TypeError("drawings are made by Scene.setting and Scene.diagram")

    @classmethod
    def _of(cls, native: _cloakroom.Drawing) -> Drawing:
        drawing = object.__new__(cls)
        drawing._native = native
        return drawing

    @property
    def svg(self) -> str:
        """The drawing as the text of an SVG file."""
        return self._native.svg

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the drawing as the ending asks for: ``.svg``, ``.pdf`` or ``.png``.

        Raises
        ------
        ValueError
            If the ending is another.
        OSError
            If the file cannot be written; then there is none.
        """
        self._native.save(os.fspath(path))

    def _repr_svg_(self) -> str:
        return self.svg
