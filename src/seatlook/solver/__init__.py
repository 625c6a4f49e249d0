"""The cover as an elastic sheet on foam: from placed panels to the sewn, hooked cover at rest."""

from seatlook.solver.foam.contact import foam_wavelength
from seatlook.solver.methods.explicit import Explicit, UnstableStepError
from seatlook.solver.process.settings import SheetSettings, SolverSettings
from seatlook.solver.sheet import Load, Moment, Sheet, SheetError, Support, solve_sheet
from seatlook.solver.solve import SETTINGS, ConvergenceError, settings_of, solve

__all__ = [
    "SETTINGS",
    "ConvergenceError",
    "Explicit",
    "Load",
    "Moment",
    "Sheet",
    "SheetError",
    "SheetSettings",
    "SolverSettings",
    "Support",
    "UnstableStepError",
    "foam_wavelength",
    "settings_of",
    "solve",
    "solve_sheet",
]
