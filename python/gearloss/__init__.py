"""Power losses, efficiency and operating temperature of transmissions.

    import gearloss as gl

    t = gl.Gearbox.read("gearbox.yaml").transmission(models="joint")
    t.solve(gear="first", torque=10, speed=8000).loss              # W
    t.map(gear="first", torque=[5, 10], speed=[3000, 6000]).efficiency

Numbers without a unit are in Nm, rpm and degC; texts carry units: ``"10 Nm"``. Everything that is wrong with a document or a request
raises `Findings`, whose text is that of the terminal.
"""

from ._core import Column, Findings, Solution, __version__, models, schema
from .analyses import cycle, identify
from .gearbox import Gearbox, Transmission
from .law import Law, law
from .results import Map, Points, Table
from .reference import catalogue
from .study import Outcome, Study, run

__all__ = [
    "Column",
    "Findings",
    "Gearbox",
    "Law",
    "Map",
    "Outcome",
    "Points",
    "Solution",
    "Study",
    "Table",
    "Transmission",
    "__version__",
    "catalogue",
    "cycle",
    "identify",
    "law",
    "models",
    "run",
    "schema",
]
