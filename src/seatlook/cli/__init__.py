"""The command line: ``seatlook demo | check | evaluate | ...``."""

from seatlook.cli import (
    _check,
    _compare,
    _demo,
    _evaluate,
    _flatten,
    _identify,
    _improve,
    _init,
    _jury,
    _library,
    _machine,
    _making,
    _mend,
    _precision,
    _render,
    _score,
    _shape,
    _showing,
    _solve,
    _studio,
    _sweep,
    _wrinkle,
)
from seatlook.cli._app import app, run

__all__ = ["app", "run"]

app.command(_demo.demo)
app.command(_studio.studio)
app.command(_flatten.flatten)
app.command(_mend.mend)
app.command(_init.init)
app.command(_check.check)
app.command(_evaluate.evaluate)
app.command(_solve.solve)
app.command(_making.timeline)
app.command(_making.hooks)
app.command(_shape.shape)
app.command(_precision.precision)
app.command(_wrinkle.wrinkle)
app.command(_improve.improve)
app.command(_compare.compare)
app.command(_sweep.sweep)
app.command(_render.render)
app.command(_showing.turntable)
app.command(_showing.sheet)
app.command(_machine.materials)
app.command(_library.library)
app.command(_identify.identify)
app.command(_machine.doctor)
app.command(_score.score)
app.command(_jury.jury)
