"""The shipped catalogues."""

from __future__ import annotations

from typing import Any

from . import _core


def catalogue(of: str, text: str = "") -> list[dict[str, Any]]:
    """Rows of the catalogue of ``bearings`` or ``oils`` whose designations contain a text, such as ``catalogue("bearings", "6208")``: dicts
    of designation, data as in a gearbox file, `confidence` and `basis`; `pandas.DataFrame` reads them. A bearing is found with suffixes, too.

    Raises:
        Findings: if there is no such catalogue.
    """
    return _core.catalogue(of, text)
