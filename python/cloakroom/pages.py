"""The interactive page of a scene."""

from __future__ import annotations

import time
import webbrowser
from pathlib import Path

from . import _cloakroom

__all__ = ["Page"]


class Page:
    """An interactive page, of `Scene.view`, that is served to this machine until it is closed.

    ``with scene.view() as page: ...`` closes it at the end.
    """

    _native: _cloakroom.Page

    def __init__(self) -> None:
        raise TypeError("pages are made by Scene.view")

    @classmethod
    def _of(cls, native: _cloakroom.Page) -> Page:
        page = object.__new__(cls)
        page._native = native
        return page

    @property
    def address(self) -> str:
        """Its address, which has a secret: who knows it may look at the scene."""
        return self._native.address

    def open(self) -> bool:
        """Opens it in the browser; whether there is one."""
        # All users of a machine see the command lines of browsers; the file is for this one alone.
        way_in = self._native.way_in
        return way_in is not None and webbrowser.open(Path(way_in).as_uri())

    def wait(self) -> None:
        """Waits until Ctrl-C, and closes it."""
        try:
            while True:
                time.sleep(0.1)
        except KeyboardInterrupt:
            self.close()

    def close(self) -> None:
        """Ends it."""
        self._native.close()

    def __enter__(self) -> Page:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _repr_html_(self) -> str:
        return f'<a href="{self.address}" target="_blank">{self.address}</a>'

    def __repr__(self) -> str:
        return f"<Page at {self.address}>"
