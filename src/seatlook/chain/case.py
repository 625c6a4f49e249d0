"""A seat from its scene to its pictures; each step is made when it is first asked for, and kept."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from seatlook import io, pbr
from seatlook.assembly import assemble
from seatlook.assembly.contradictions import (
    Contradiction,
    contradictions,
    out_of_scale,
    refuse,
)
from seatlook.chain.assess import Assessment, assess, limited, zones_with_faces
from seatlook.chain.choose import Look, camera_of, look_of, narrowed, rig_of
from seatlook.chain.draw import map_ends
from seatlook.chain.files import earlier_result, of_scene
from seatlook.chain.local import solve_scene, solve_scene_in_stages
from seatlook.errors import InputError, SolverError
from seatlook.model import (
    Appearance,
    Camera,
    Cover,
    Criteria,
    Rig,
    Scene,
    Solution,
    criteria_of,
)
from seatlook.model.progress import Progress, silent
from seatlook.pbr import Image
from seatlook.pbr.maps.plotter import plotter
from seatlook.pbr.picture import img
from seatlook.results.gap import ZoneGap
from seatlook.results.resolution import Resolution
from seatlook.results.ring_pulls import RingPull, ring_pulls
from seatlook.solver import SolverSettings
from seatlook.visibility.light_search import WorstLight, worst_lights
from seatlook.visibility.reference import CUTOFF, Mode
from seatlook.visibility.scoring import SceneScore, score_scene
from seatlook.visibility.view import SAMPLING, Sampling, View
from seatlook.wrinkle import INDICES

if TYPE_CHECKING:
    from seatlook.pbr.maps.plotter import Plotter


class Case:
    """Scene, cover, solution, assessment, pictures and score of one seat.

    Examples
    --------
    >>> case = Case(io.load_scene("seat.toml"))                              # doctest: +SKIP
    >>> case.assessment.zones[0]["w2_mean"]                                  # doctest: +SKIP
    0.0475
    >>> case.render("suede", rig="sun", camera="top").save(Path("a.png"))    # doctest: +SKIP
    """

    def __init__(self, scene: Scene, *, solution: Solution | None = None) -> None:
        """Begin with a scene, or with a result of it, whose shape is then taken as it is."""
        self.scene = scene
        self._solution = solution

    def __repr__(self) -> str:
        state = "not solved yet" if self._solution is None else self.resolution.status
        return f"{type(self).__name__}({self.scene!r}, {state})"

    def _repr_html_(self) -> str:
        """A picture in a notebook: solved, under the first rig; else only what there is."""
        if self._solution is None:
            return f"<pre>{self!r}</pre>"
        view = self.camera(None)
        width = min(640, view.size[0])
        small = replace(view, size=(width, round(width * view.size[1] / view.size[0])))
        texture = next(iter(self.scene.textures))
        image = pbr.render(
            self.solution, self.scene.textures[texture], rig=self.rig(None), camera=small
        )
        return f"{img(image.to_png(), f'{self.scene.name}, {texture}')}<pre>{self!r}</pre>"

    @property
    def cover(self) -> Cover:
        """The panels meshed and placed, with what pulls on them.

        Where the mesh follows from a tolerance, it is a first mesh until the seat is solved.

        Raises
        ------
        InputError
            As ``assemble``; or the pattern is out of scale with the foam.
        """
        return self._placed if self._solution is None else self._solution.cover

    @cached_property
    def _placed(self) -> Cover:
        refuse(out_of_scale(self.scene))
        return assemble(self.scene)

    @property
    def solution(self) -> Solution:
        """The solved cover; solved now if it has not been."""
        return self.solve()

    @property
    def current(self) -> bool:
        """Whether the solution is of the scene as it now is."""
        return of_scene(self.solution, self.scene)

    @property
    def criteria(self) -> Criteria:
        """The scene's curvature mode, and the thresholds of the cover's materials."""
        return criteria_of(
            self.cover.materials, self.scene.curvature, default=self.scene.c_threshold
        )

    @cached_property
    def assessment(self) -> Assessment:
        """Indices, zones, worst wrinkles, sections, distortion, distances."""
        return assess(self.solution, self.criteria, design=self.scene.design)

    @property
    def resolution(self) -> Resolution:
        """Whether the result is resolved, or only converged, or not even that, and why."""
        return self.assessment.resolution

    def solve(
        self,
        path: Path | None = None,
        *,
        resume: bool = False,
        settings: SolverSettings | None = None,
        progress: Progress = silent,
    ) -> Solution:
        """Sew, hook and cover; the solution is kept, and written where a path is given.

        Parameters
        ----------
        path : result file to write
        resume : take the result in ``path`` if it is converged and of this very scene
        settings : method and steps of the solver; None for its own

        Raises
        ------
        InputError, SolverError
        """
        if path is not None and resume and self.reuse(path):
            return self.solution
        if self._solution is None:
            progress("mesh")
            cover = self.cover
            with mesh_in_memory(cover):
                self._solution = solve_scene(
                    self.scene, cover, settings=settings, progress=progress
                )
        if path is not None:
            io.write_result(self._solution, path)
        return self._solution

    def solve_in_stages(
        self,
        folder: Path,
        *,
        again_from: str | None = None,
        resume: bool = False,
        progress: Progress = silent,
    ) -> Solution:
        """Solve, and keep the state at the end of every stage, see ``chain.timeline``."""
        cover = self.cover
        with mesh_in_memory(cover):
            self._solution = solve_scene_in_stages(
                self.scene,
                cover,
                folder,
                again_from=again_from,
                resume=resume,
                progress=progress,
            )
        return self._solution

    def reuse(self, path: Path) -> bool:
        """Take the result in a file if it may stand for solving the scene; say whether it did."""
        if self._solution is None:
            self._solution = earlier_result(self.scene, path)
            return self._solution is not None
        return False

    def check(self) -> Cover:
        """Try all that can be tried before the solve: mesh, limits, looks, lights, views.

        Raises
        ------
        InputError
            What stands against solving and drawing the scene.
        """
        cover, scene = self.cover, self.scene
        needed = {"rig": scene.rigs, "camera.views": scene.cameras}
        for what, known in (needed | {"gallery.textures": tuple(scene.textures)}).items():
            if not known:
                raise InputError.single(what, got="none", expected="one or more", file=scene.path)
        zones = zones_with_faces(cover.zone, cover.zone_names)
        for limit in scene.limits:
            limited(limit, scene, zones)
        refuse(self.contradictions)
        return cover

    @cached_property
    def contradictions(self) -> tuple[Contradiction, ...]:
        """What a solve could not mend, with places, see ``assembly.contradictions``."""
        return contradictions(self.scene, self.cover)

    def look(self, texture: Look) -> Appearance | None:
        """Appearance of a texture of the scene, of a supplied material or of an object."""
        return look_of(self.scene, texture)

    def rig(self, rig: str | Rig | None) -> Rig:
        """A rig of the scene by its name, or the first, or the object itself."""
        return rig_of(self.scene, rig)

    def camera(self, camera: str | Camera | None) -> Camera:
        """A view of the scene or a named view of the seat, or the first, or the object itself."""
        return camera_of(self.scene, camera)

    def narrowed(self, textures: Iterable[str] = (), rigs: Iterable[str] = ()) -> Scene:
        """The scene with some of its textures and rigs; all where none is named."""
        return narrowed(self.scene, textures, rigs)

    def render(
        self,
        texture: Look = None,
        *,
        rig: str | Rig | None = None,
        camera: str | Camera | None = None,
        quality: str = "standard",
        surroundings: str | None = None,
    ) -> Image:
        """Render the seat.

        Parameters
        ----------
        texture : name of a texture of the scene or of a supplied material, or an object; None
            for the panels' own materials
        rig : name of a rig of the scene, or an object; None for the first
        camera : name of a view of the scene or of ``VIEWS``, or an object; None for the first
        surroundings : what is around the seat, see ``seatlook.render``; None for the scene's

        Raises
        ------
        InputError, RenderError
        """
        return pbr.render(
            self.solution,
            self.look(texture),
            rig=self.rig(rig),
            camera=self.camera(camera),
            quality=quality,
            surroundings=self.scene.surroundings if surroundings is None else surroundings,
        )

    def score(
        self,
        *,
        textures: Iterable[str] = (),
        rigs: Iterable[str] = (),
        camera: str | Camera | None = None,
        mode: Mode = "view-ray",
        cutoff: float = CUTOFF,
        progress: Progress = silent,
    ) -> SceneScore:
        """Say how visible the wrinkles are, for every texture under every rig.

        Parameters
        ----------
        textures, rigs : names; all of the scene where none is given
        mode, cutoff : see :class:`seatlook.visibility.view.View`

        Raises
        ------
        InputError, RenderError
        """
        progress("score", what="reference")
        return score_scene(
            self.narrowed(textures, rigs),
            View(self.solution, self.camera(camera), mode=mode, cutoff=cutoff),
            self.assessment.indices,
            progress=progress,
        )

    def worst_lights(
        self,
        *,
        textures: Iterable[str] = (),
        camera: str | Camera | None = None,
        mode: Mode = "view-ray",
        progress: Progress = silent,
    ) -> dict[str, dict[str, WorstLight]]:
        """Search the sun and the bulb that show the wrinkles of each texture most.

        Returns
        -------
        dict
            texture -> "sun" or "bulb" -> the worst light.
        """
        # A quarter of the pixels of a score will do.
        coarse = Sampling("draft", SAMPLING.pixels_per_degree / 2)
        view = View(self.solution, self.camera(camera), mode=mode, sampling=coarse)
        return worst_lights(view, self.narrowed(textures).textures, progress=progress)

    def shape(self) -> tuple[ZoneGap, ...]:
        """How far the cover is from the scene's design surface, zone by zone.

        Raises
        ------
        InputError
            The scene names no design surface.
        """
        if self.scene.design is None:
            raise InputError.single(
                "design",
                got="nothing",
                expected="a table [design] with a file",
                file=self.scene.path,
            )
        return self.assessment.zone_deviations

    def view_3d(self, index: str = "w2", *, size: tuple[int, int] = (960, 540)) -> Plotter:
        """An index on the cover to be turned by hand in a notebook, a PyVista plotter.

        Raises
        ------
        InputError
            No index of this name.
        """
        values = self.assessment.values(index)
        entry = INDICES[index]
        ends = map_ends(entry, values, self.assessment.top)
        return plotter(self.solution, values, title=entry.symbol, value_range=ends, size=size)

    def hooks(self) -> tuple[RingPull, ...]:
        """What every hog ring pulls with."""
        return ring_pulls(self.solution)

    def export(self, path: Path | str) -> Path:
        """Write the cover with every index for another program: .vtp, .csv, .glb, .k or .npz.

        Raises
        ------
        InputError
            Another ending.
        """
        return export(self.assessment, Path(path))


def export(assessment: Assessment, path: Path) -> Path:
    """Write a cover with every index of the registry for another program.

    Raises
    ------
    InputError
        An ending that names no format.
    """
    solution = assessment.solution
    # A viewer knows no grain by formula.
    drawn = pbr.bake_grain(solution) if path.suffix.lower() == ".glb" else solution
    io.export_cover(drawn, assessment.fields, path)
    return path


@contextmanager
def mesh_in_memory(cover: Cover) -> Iterator[None]:
    """Say what size of mesh takes less, where the memory ends inside.

    Raises
    ------
    SolverError
        Instead of MemoryError.
    """
    try:
        yield
    except MemoryError as error:
        size, count = 1e3 * cover.element_size, len(cover.faces)
        tried = f" ({error})" if str(error) else ""
        raise SolverError(
            f"out of memory{tried}: {count} triangles of {size:.3g} mm; a coarser mesh takes less, "
            f"as --element-size-mm {2 * size:.3g} with about {count // 4}"
        ) from error
