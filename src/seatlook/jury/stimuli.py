"""What a jury compares: pictures of covers under code names, and pairs that nobody can mistake."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass, replace
from typing import Any

from seatlook import io
from seatlook.errors import InputError
from seatlook.jury.questionnaire import SEEN, WRINKLES, Catch, Questionnaire, Stimulus
from seatlook.model import Appearance, Camera, Rig, Scene, Solution
from seatlook.model.progress import Progress, silent
from seatlook.pbr import Image
from seatlook.visibility.cross_check import Measures
from seatlook.visibility.heights import amplified, peak_to_valley, reference_rig
from seatlook.visibility.scoring import BLACK
from seatlook.visibility.view import Sampling, View, luminance

# A catch pair differs by 1 mm of wrinkles, or by as much more as makes it this visible.
CATCH_HEIGHT = 0.001  # [m]
CATCH_VWI = 10.0
_HIGHEST = 0.032  # [m]
FEWEST, MOST = 8, 12  # pictures that screen judges without tiring them


@dataclass(frozen=True, slots=True, kw_only=True)
class Shown:
    """One picture of a questionnaire, with what the judges do not see.

    Parameters
    ----------
    code : name on the page; reveals nothing
    geometry : cover that it shows
    measures : how visible its wrinkles are, for the calibration; None for a catch pair's
    """

    code: str
    label: str
    geometry: str
    texture: str
    rig: str
    picture: Image
    measures: Measures | None

    @property
    def path(self) -> str:
        """Of the picture, from the page of the judges."""
        return f"images/{self.code}.png"

    @property
    def stimulus(self) -> Stimulus:
        """What the page holds: a judge who reads its source must not learn which cover it is."""
        return Stimulus(name=self.code, picture=self.path, geometry="")

    @property
    def key(self) -> dict[str, Any]:
        """What the judges do not see."""
        names = {"label": self.label, "geometry": self.geometry}
        names |= {"texture": self.texture, "rig": self.rig}
        return names | (asdict(self.measures) if self.measures else {})


Pair = tuple[Shown, Shown]


@dataclass(frozen=True, slots=True, kw_only=True)
class Stimuli:
    """All pictures of a questionnaire.

    Parameters
    ----------
    cells : the pictures that are ranked
    catches : (wrinkled, smooth), the pairs that screen judges
    """

    cells: tuple[Shown, ...]
    catches: tuple[Pair, ...]

    @property
    def shown(self) -> tuple[Shown, ...]:
        """Every picture, ranked or not."""
        return (*self.cells, *(one for pair in self.catches for one in pair))

    @property
    def key(self) -> dict[str, dict[str, Any]]:
        """What the judges do not see, by code."""
        return {one.code: one.key for one in self.shown}

    @property
    def notices(self) -> Iterator[str]:
        """What makes the answers of these judges less certain."""
        if not self.catches:
            yield (
                f"no catch pair: even {1e3 * _HIGHEST:g} mm high these wrinkles would be missed, "
                "so judges cannot be screened"
            )
        if not FEWEST <= len(self.cells) <= MOST:
            yield (
                f"{len(self.cells)} pictures; {FEWEST} to {MOST} screen judges without tiring them"
            )

    def questionnaire(
        self, *, title: str, questions: tuple[str, ...] = (SEEN, WRINKLES), ties: bool = False
    ) -> Questionnaire:
        """Ask for these pictures; see :class:`seatlook.jury.questionnaire.Questionnaire`."""
        return Questionnaire(
            title=title,
            stimuli=tuple(cell.stimulus for cell in self.cells),
            catches=tuple(
                Catch(wrinkled=wrinkled.stimulus, smooth=smooth.stimulus)
                for wrinkled, smooth in self.catches
            ),
            questions=questions,
            ties=ties,
        )


def draw_stimuli(
    covers: Iterable[tuple[str, Scene, View]], *, seed: int, progress: Progress = silent
) -> Stimuli:
    """Draw every cell of every cover, and catch pairs of the first cover that has any.

    Parameters
    ----------
    covers : name, scene, and view of its solution, see :func:`jury_view`; taken one by one
    seed : of the code names

    Raises
    ------
    InputError
        No cover.
    """
    cells: list[Shown] = []
    catches: list[Pair] = []
    black = io.read_material(BLACK).appearance
    for name, scene, view in covers:
        progress("draw", scene=name)
        cells += shown_cells(scene, view, name=name, seed=seed)
        if not catches:
            progress("draw", scene=name, what="catch pairs")
            pairs = [
                catch_pair(view, black, rig, seed=seed) for rig in catch_rigs(scene, view.camera)
            ]
            catches = [pair for pair in pairs if pair is not None]
    if not cells:
        raise InputError.single("scenes", got="none", expected="a scene file or more")
    return Stimuli(cells=tuple(cells), catches=tuple(catches))


def shown_cells(scene: Scene, view: View, *, name: str, seed: int) -> Iterator[Shown]:
    """Draw and score every texture of a scene under every rig, as seen by ``view``."""
    for rig in scene.rigs:
        for texture, looks in scene.textures.items():
            picture, reference = view.draw(looks, rig)
            label = f"{name}, {texture}, {rig.name}"
            yield Shown(
                code=code_of(label, seed),
                label=label,
                geometry=name,
                texture=texture,
                rig=rig.name,
                picture=picture,
                measures=view.compare(picture, reference, rig).measures,
            )


def catch_pair(view: View, black: Appearance, rig: Rig, *, seed: int) -> Pair | None:
    """Draw black leather with its wrinkles raised beside the same without any.

    Returns
    -------
    (wrinkled, smooth), or None where even 32 mm of this field under these lights do not reach a VWI
    of 10, so that a judge could miss them
    """
    smooth = view.reference_studio.render(black, rig=rig, camera=view.camera, quality=view.quality)
    height = CATCH_HEIGHT
    while height <= _HIGHEST:
        studio = view.studio_of(amplified(view, height / peak_to_valley(view)))
        wrinkled = studio.render(black, rig=rig, camera=view.camera, quality=view.quality)
        result = view.score(luminance(wrinkled), luminance(smooth), view.region)
        if result.vwi >= CATCH_VWI:
            return (
                _catch(f"wrinkles of {1e3 * height:g} mm", wrinkled, rig, seed),
                _catch("no wrinkles", smooth, rig, seed),
            )
        # Visibility grows about linearly with height.
        height *= 2 ** max(1, math.ceil(math.log2(CATCH_VWI / max(result.vwi, 1e-3))))
    return None


def catch_rigs(scene: Scene, camera: Camera) -> tuple[Rig, ...]:
    """Lights of the catch pairs: the reference rig, and the scene's first."""
    return (reference_rig(camera), scene.rigs[0])


def jury_view(solution: Solution, camera: Camera, *, width: int) -> View:
    """View for a jury: the camera's picture, cut to ``width`` pixels at the same scale."""
    cut = replace(camera, size=(min(width, camera.size[0]), camera.size[1]))
    # Judges see the very pictures that are scored.
    return View(solution, cut, sampling=Sampling(pixels_per_degree=cut.pixels_per_degree))


def code_of(label: str, seed: int) -> str:
    """Name that reveals nothing, the same for the same label and seed.

    Examples
    --------
    >>> code_of("demo, suede, sun", 1)
    '8bf1e3'
    """
    return hashlib.sha256(f"{seed} {label}".encode()).hexdigest()[:6]


def _catch(what: str, picture: Image, rig: Rig, seed: int) -> Shown:
    label = f"catch, {what}, {rig.name}"
    return Shown(
        code=code_of(label, seed),
        label=label,
        geometry="",
        texture="black leather",
        rig=rig.name,
        picture=picture,
        measures=None,
    )
