"""Files in and out; one module per format, loaded when its first name is used."""

from __future__ import annotations

from typing import TYPE_CHECKING

from seatlook._door import door

if TYPE_CHECKING:
    from seatlook.io.curves import (
        read_curves as read_curves,
    )
    from seatlook.io.curves import (
        read_seam_lines as read_seam_lines,
    )
    from seatlook.io.curves import (
        write_curves as write_curves,
    )
    from seatlook.io.export.film import (
        check_animation as check_animation,
    )
    from seatlook.io.export.film import (
        read_shapes as read_shapes,
    )
    from seatlook.io.export.film import (
        write_animation as write_animation,
    )
    from seatlook.io.export.film import (
        write_shapes as write_shapes,
    )
    from seatlook.io.export.result import (
        read_result as read_result,
    )
    from seatlook.io.export.result import (
        write_result as write_result,
    )
    from seatlook.io.export.writers import (
        export_cover as export_cover,
    )
    from seatlook.io.lsdyna.d3plot.reader import (
        read_d3plot as read_d3plot,
    )
    from seatlook.io.lsdyna.deck.reader import (
        read_keyword as read_keyword,
    )
    from seatlook.io.lsdyna.dynain import (
        write_dynain as write_dynain,
    )
    from seatlook.io.lsdyna.shells import (
        read_shells as read_shells,
    )
    from seatlook.io.material import (
        list_foam_materials as list_foam_materials,
    )
    from seatlook.io.material import (
        list_materials as list_materials,
    )
    from seatlook.io.material import (
        materials_dir as materials_dir,
    )
    from seatlook.io.material import (
        read_foam_material as read_foam_material,
    )
    from seatlook.io.material import (
        read_material as read_material,
    )
    from seatlook.io.pattern.dxf import (
        read_dxf as read_dxf,
    )
    from seatlook.io.pattern.dxf import (
        report_dxf as report_dxf,
    )
    from seatlook.io.pattern.dxf_write import (
        write_dxf as write_dxf,
    )
    from seatlook.io.pattern.seams import (
        read_panels as read_panels,
    )
    from seatlook.io.pattern.seams import (
        read_pattern as read_pattern,
    )
    from seatlook.io.pattern.seams import (
        write_seams as write_seams,
    )
    from seatlook.io.scene.read import (
        load_scene as load_scene,
    )
    from seatlook.io.scene.read import (
        report_pattern as report_pattern,
    )
    from seatlook.io.surface.design import (
        GroupedMesh as GroupedMesh,
    )
    from seatlook.io.surface.design import (
        read_surface as read_surface,
    )
    from seatlook.io.surface.design import (
        write_obj as write_obj,
    )
    from seatlook.io.surface.design import (
        write_surface as write_surface,
    )
    from seatlook.io.surface.foam import (
        FoamSurface as FoamSurface,
    )
    from seatlook.io.surface.foam import (
        read_foam as read_foam,
    )
    from seatlook.io.surface.foam import (
        read_foam_surface as read_foam_surface,
    )
    from seatlook.io.surface.mended import (
        mend_file as mend_file,
    )
    from seatlook.io.table import (
        write_numbers as write_numbers,
    )
    from seatlook.io.table import (
        write_table as write_table,
    )

# name -> module; loaded on first use, so that "seatlook --help" stays light.
_PUBLIC: dict[str, str] = {
    "FoamSurface": "seatlook.io.surface.foam",
    "GroupedMesh": "seatlook.io.surface.design",
    "check_animation": "seatlook.io.export.film",
    "export_cover": "seatlook.io.export.writers",
    "list_foam_materials": "seatlook.io.material",
    "list_materials": "seatlook.io.material",
    "load_scene": "seatlook.io.scene.read",
    "materials_dir": "seatlook.io.material",
    "mend_file": "seatlook.io.surface.mended",
    "read_curves": "seatlook.io.curves",
    "read_seam_lines": "seatlook.io.curves",
    "read_d3plot": "seatlook.io.lsdyna.d3plot.reader",
    "read_dxf": "seatlook.io.pattern.dxf",
    "read_foam": "seatlook.io.surface.foam",
    "read_foam_surface": "seatlook.io.surface.foam",
    "read_foam_material": "seatlook.io.material",
    "read_keyword": "seatlook.io.lsdyna.deck.reader",
    "read_material": "seatlook.io.material",
    "read_panels": "seatlook.io.pattern.seams",
    "read_pattern": "seatlook.io.pattern.seams",
    "read_result": "seatlook.io.export.result",
    "read_shapes": "seatlook.io.export.film",
    "read_shells": "seatlook.io.lsdyna.shells",
    "read_surface": "seatlook.io.surface.design",
    "report_dxf": "seatlook.io.pattern.dxf",
    "report_pattern": "seatlook.io.scene.read",
    "write_animation": "seatlook.io.export.film",
    "write_curves": "seatlook.io.curves",
    "write_dxf": "seatlook.io.pattern.dxf_write",
    "write_dynain": "seatlook.io.lsdyna.dynain",
    "write_numbers": "seatlook.io.table",
    "write_obj": "seatlook.io.surface.design",
    "write_result": "seatlook.io.export.result",
    "write_seams": "seatlook.io.pattern.seams",
    "write_shapes": "seatlook.io.export.film",
    "write_surface": "seatlook.io.surface.design",
    "write_table": "seatlook.io.table",
}

__all__ = [
    "FoamSurface",
    "GroupedMesh",
    "check_animation",
    "export_cover",
    "list_foam_materials",
    "list_materials",
    "load_scene",
    "materials_dir",
    "mend_file",
    "read_curves",
    "read_d3plot",
    "read_dxf",
    "read_foam",
    "read_foam_material",
    "read_foam_surface",
    "read_keyword",
    "read_material",
    "read_panels",
    "read_pattern",
    "read_result",
    "read_seam_lines",
    "read_shapes",
    "read_shells",
    "read_surface",
    "report_dxf",
    "report_pattern",
    "write_animation",
    "write_curves",
    "write_dxf",
    "write_dynain",
    "write_numbers",
    "write_obj",
    "write_result",
    "write_seams",
    "write_shapes",
    "write_surface",
    "write_table",
]

if not TYPE_CHECKING:
    __getattr__, __dir__ = door(__name__, _PUBLIC)
