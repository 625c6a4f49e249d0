"""The cover as an elastic sheet on foam: from placed panels to the sewn, hooked cover at rest."""

from seatlook.solver.foam.contact import foam_wavelength
from seatlook.solver.methods.explicit import Explicit
from seatlook.solver.sheet import solve_sheet
from seatlook.solver.solve import solve

__all__ = ["Explicit", "foam_wavelength", "solve", "solve_sheet"]
