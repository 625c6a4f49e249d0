"""Where a car-seat cover wrinkles, why, and whether anyone will see it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from seatlook._door import door
from seatlook._version import __version__ as __version__

if TYPE_CHECKING:
    from seatlook.assembly import (
        assemble as assemble,
    )
    from seatlook.chain.assess import (
        assess as assess,
    )
    from seatlook.chain.assess import (
        wrinkle_map as wrinkle_map,
    )
    from seatlook.chain.case import (
        Case as Case,
    )
    from seatlook.chain.start import (
        init as init,
    )
    from seatlook.comparison.compare import (
        Comparison as Comparison,
    )
    from seatlook.comparison.compare import (
        compare as compare,
    )
    from seatlook.errors import (
        InputError as InputError,
    )
    from seatlook.errors import (
        SeatlookError as SeatlookError,
    )
    from seatlook.flattening.files import (
        flatten_surface as flatten,
    )
    from seatlook.io.export.result import (
        read_result as read_result,
    )
    from seatlook.io.export.result import (
        write_result as write_result,
    )
    from seatlook.io.material import (
        read_material as read_material,
    )
    from seatlook.io.scene.read import (
        load_scene as load_scene,
    )
    from seatlook.jury.plan import (
        plan_jury as plan_jury,
    )
    from seatlook.model import (
        Camera as Camera,
    )
    from seatlook.model import (
        Cover as Cover,
    )
    from seatlook.model import (
        Criteria as Criteria,
    )
    from seatlook.model import (
        Rig as Rig,
    )
    from seatlook.model import (
        Scene as Scene,
    )
    from seatlook.model import (
        Solution as Solution,
    )
    from seatlook.model import (
        WrinkleMap as WrinkleMap,
    )
    from seatlook.model import (
        bulb as bulb,
    )
    from seatlook.model import (
        framed_view as framed_view,
    )
    from seatlook.model import (
        named_view as named_view,
    )
    from seatlook.model import (
        sun as sun,
    )
    from seatlook.pbr.maps.face_map import (
        render_map as render_map,
    )
    from seatlook.pbr.shading.studio import (
        render as render,
    )
    from seatlook.report.jury_export import (
        export_jury as export_jury,
    )
    from seatlook.report.jury_fit import (
        fit_jury as fit_jury,
    )
    from seatlook.seat import (
        Seat as Seat,
    )
    from seatlook.seat import (
        compare_into as compare_into,
    )
    from seatlook.seat import (
        evaluate as evaluate,
    )
    from seatlook.seat import (
        open as open,
    )
    from seatlook.seats.files import (
        write_demo as demo,
    )
    from seatlook.solver.solve import (
        solve as solve,
    )
    from seatlook.sweeps.sweep import (
        sweep as sweep,
    )
    from seatlook.wrinkle.equations import (
        surface_strains as surface_strains,
    )
    from seatlook.wrinkle.equations import (
        wrinkle_indices as wrinkle_indices,
    )

# name -> module; loaded on first use, so that "seatlook --help" stays light.
_PUBLIC: dict[str, str] = {
    "Camera": "seatlook.model",
    "Case": "seatlook.chain.case",
    "Comparison": "seatlook.comparison.compare",
    "Cover": "seatlook.model",
    "Criteria": "seatlook.model",
    "InputError": "seatlook.errors",
    "Rig": "seatlook.model",
    "Scene": "seatlook.model",
    "Seat": "seatlook.seat",
    "SeatlookError": "seatlook.errors",
    "Solution": "seatlook.model",
    "WrinkleMap": "seatlook.model",
    "assemble": "seatlook.assembly",
    "assess": "seatlook.chain.assess",
    "bulb": "seatlook.model",
    "compare": "seatlook.comparison.compare",
    "compare_into": "seatlook.seat",
    "demo": "seatlook.seats.files:write_demo",
    "evaluate": "seatlook.seat",
    "export_jury": "seatlook.report.jury_export",
    "fit_jury": "seatlook.report.jury_fit",
    "flatten": "seatlook.flattening.files:flatten_surface",
    "framed_view": "seatlook.model",
    "init": "seatlook.chain.start",
    "load_scene": "seatlook.io.scene.read",
    "named_view": "seatlook.model",
    "open": "seatlook.seat",
    "plan_jury": "seatlook.jury.plan",
    "read_material": "seatlook.io.material",
    "read_result": "seatlook.io.export.result",
    "render": "seatlook.pbr.shading.studio",
    "render_map": "seatlook.pbr.maps.face_map",
    "solve": "seatlook.solver.solve",
    "sun": "seatlook.model",
    "surface_strains": "seatlook.wrinkle.equations",
    "sweep": "seatlook.sweeps.sweep",
    "wrinkle_indices": "seatlook.wrinkle.equations",
    "wrinkle_map": "seatlook.chain.assess",
    "write_result": "seatlook.io.export.result",
}

__all__ = [
    "Camera",
    "Case",
    "Comparison",
    "Cover",
    "Criteria",
    "InputError",
    "Rig",
    "Scene",
    "Seat",
    "SeatlookError",
    "Solution",
    "WrinkleMap",
    "assemble",
    "assess",
    "bulb",
    "compare",
    "compare_into",
    "demo",
    "evaluate",
    "export_jury",
    "fit_jury",
    "flatten",
    "framed_view",
    "init",
    "load_scene",
    "named_view",
    "open",
    "plan_jury",
    "read_material",
    "read_result",
    "render",
    "render_map",
    "solve",
    "sun",
    "surface_strains",
    "sweep",
    "wrinkle_indices",
    "wrinkle_map",
    "write_result",
]

if not TYPE_CHECKING:
    __getattr__, __dir__ = door(__name__, _PUBLIC)
