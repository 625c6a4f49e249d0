"""The fence: the only file that imports VTK. It finds the triangle that each sample sees.

Nothing is shaded here. One shader writes the number of the triangle into a float32 framebuffer;
position, normal and light follow from it in ``kernels``, in double precision and with one BRDF.
"""

from __future__ import annotations

import functools
import os
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import (
    VTK_FLOAT,
    vtkCommand,
    vtkLogger,
    vtkObject,
    vtkOutputWindow,
    vtkPoints,
    vtkStringOutputWindow,
)
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkRenderingCore import vtkActor, vtkRenderer, vtkRenderWindow
from vtkmodules.vtkRenderingOpenGL2 import (
    vtkCameraPass,
    vtkFramebufferPass,
    vtkOpaquePass,
    vtkOpenGLPolyDataMapper,
    vtkRenderPassCollection,
    vtkSequencePass,
    vtkTextureObject,
)

from seatlook.errors import RenderError
from seatlook.model import Camera, FloatArray, IntArray
from seatlook.pbr.backend import offscreen_backend
from seatlook.pbr.kernels import surface

FaceIds = npt.NDArray[np.int32]

# A float32 holds every integer up to this one.
MAX_FACES = 2**24 - 1
# Samples along a side of the window: larger ones fail to open, or take gigabytes.
_LARGEST = 2048

_WRITE_FACE = """
//VTK::Light::Impl
  gl_FragData[0] = vec4(float(gl_PrimitiveID + PrimitiveIDOffset + 1), 0.0, 0.0, 1.0);
"""


class Part(NamedTuple):
    """Rectangle of samples of a picture, from its top left."""

    left: int
    top: int
    width: int
    height: int

    @property
    def lines(self) -> slice:
        """Its lines in the picture."""
        return slice(self.top, self.top + self.height)

    @property
    def columns(self) -> slice:
        """Its columns in the picture."""
        return slice(self.left, self.left + self.width)


def parts_of(size: tuple[int, int]) -> list[Part]:
    """Rectangles of a picture of ``size`` that a window may have, line by line.

    Examples
    --------
    >>> [(part.left, part.width) for part in parts_of((2560, 100))]
    [(0, 1280), (1280, 1280)]
    """
    edges = []
    for length in size:
        count = -(-length // _LARGEST)
        edges.append([length * k // count for k in range(count + 1)])
    return [
        Part(left, top, right - left, bottom - top)
        for top, bottom in pairwise(edges[1])
        for left, right in pairwise(edges[0])
    ]


class FaceWindow:
    """One offscreen window that stays open, with one mesh in it.

    Raises
    ------
    RenderError
        On any error VTK reports, such as a shader that does not compile.
    """

    def __init__(self) -> None:
        offscreen_backend()
        self._mesh: tuple[FloatArray, IntArray] | None = None
        self._mapper = vtkOpenGLPolyDataMapper()
        self._actor = vtkActor()
        self._actor.SetMapper(self._mapper)
        self._actor.GetShaderProperty().AddFragmentShaderReplacement(
            "//VTK::Light::Impl", True, _WRITE_FACE, False
        )
        self._renderer = vtkRenderer()
        self._renderer.AddActor(self._actor)
        self._renderer.SetBackground(0.0, 0.0, 0.0)
        self._renderer.SetBackgroundAlpha(0.0)
        self._pass = _float_pass()
        self._renderer.SetPass(self._pass)
        self._window = vtkRenderWindow()
        self._window.SetOffScreenRendering(True)
        self._window.SetMultiSamples(0)
        self._window.AddRenderer(self._renderer)

    def faces(
        self,
        vertices: FloatArray,
        faces: IntArray,
        camera: Camera,
        size: tuple[int, int],
        part: Part | None = None,
    ) -> FaceIds:
        """Return the number of the nearest face at every sample centre, -1 where there is none.

        Parameters
        ----------
        vertices : (n, 3) float64 [m]; faces : (m, 3) int64
        size : (width, height) in samples; the camera's own size sets only the aspect
        part : what to draw of it, all if None; see :func:`parts_of`

        Returns
        -------
        (height, width) int32, first row at the top
        """
        self._set_mesh(vertices, faces)
        part = part or Part(0, 0, *size)
        self._aim(camera, size, part)
        with _errors_raised():
            self._window.Render()
        picture = self._read((part.width, part.height))
        ids = np.empty(picture.shape[:2], dtype=np.int32)
        if not surface.face_numbers(picture, len(faces), ids):
            raise RenderError("the face shader did not run: the frame holds no face numbers")
        return ids

    def describe(self) -> str:
        """Return window class and GL renderer, for ``seatlook doctor``."""
        with _errors_raised():
            self._window.Render()
        lines = self._window.ReportCapabilities().splitlines()
        named = [line.strip() for line in lines if line.startswith("OpenGL renderer")]
        return ", ".join([self._window.GetClassName(), *named])

    def _set_mesh(self, vertices: FloatArray, faces: IntArray) -> None:
        if self._mesh is not None and self._mesh[0] is vertices and self._mesh[1] is faces:
            return
        if len(faces) > MAX_FACES:
            raise RenderError(f"{len(faces)} triangles are more than {MAX_FACES}")
        points = vtkPoints()
        points.SetDataTypeToDouble()
        points.SetData(numpy_to_vtk(np.ascontiguousarray(vertices), deep=True))
        cells = vtkCellArray()
        offsets = np.arange(0, 3 * len(faces) + 1, 3, dtype=np.int64)
        cells.SetData(
            numpy_to_vtkIdTypeArray(offsets, deep=True),
            numpy_to_vtkIdTypeArray(np.ascontiguousarray(faces).ravel(), deep=True),
        )
        data = vtkPolyData()
        data.SetPoints(points)
        data.SetPolys(cells)
        self._mapper.SetInputData(data)
        self._mesh = (vertices, faces)

    def _aim(self, camera: Camera, size: tuple[int, int], part: Part) -> None:
        eye = self._renderer.GetActiveCamera()
        eye.ParallelProjectionOff()
        eye.SetPosition(*camera.position)
        eye.SetFocalPoint(*camera.target)
        eye.SetViewUp(*camera.up)
        half = np.tan(np.radians(camera.vertical_fov_deg) / 2) * part.height / size[1]
        eye.SetViewAngle(
            camera.vertical_fov_deg
            if part.height == size[1]
            else float(np.degrees(2 * np.arctan(half)))
        )
        # The middle of the picture lies so many half parts left of and below that of the part.
        eye.SetWindowCenter(
            (2 * part.left + part.width - size[0]) / part.width,
            (size[1] - 2 * part.top - part.height) / part.height,
        )
        self._window.SetSize(part.width, part.height)
        self._renderer.ResetCameraClippingRange()

    def _read(self, size: tuple[int, int]) -> npt.NDArray[np.float32]:
        width, height = size
        texture = self._pass.GetColorTexture()
        if texture is None or (texture.GetWidth(), texture.GetHeight()) != size:
            raise RenderError(f"the GL library did not give a frame of {width} x {height} samples")
        buffer = texture.Download()
        picture = np.empty((height, width, 4), dtype=np.float32)
        done = buffer.Download2D(VTK_FLOAT, picture, [width, height], 4, [0, 0])
        # VTK keeps every buffer that it hands out as long as the window is open.
        buffer.ReleaseMemory()
        if not done:
            raise RenderError("the frame could not be read back from the GL library")
        return picture


@functools.cache
def face_window() -> FaceWindow:
    """Return the one window of this process."""
    with _errors_raised():
        return FaceWindow()


def open_window() -> str:
    """Open and close a window, and return its class.

    For a process of its own: VTK may end it, where no window opens.

    Raises
    ------
    RenderError
        VTK opened another class than the one it was told to, or OpenGL is too old for it.
    """
    window = vtkRenderWindow()
    window.SetOffScreenRendering(True)
    window.SetSize(8, 8)
    name, wanted = window.GetClassName(), os.environ.get("VTK_DEFAULT_OPENGL_WINDOW", "")
    if wanted and name != wanted:
        raise RenderError("it gives no OpenGL that VTK can use")
    window.AddRenderer(vtkRenderer())
    window.Render()
    if not window.SupportsOpenGL():
        raise RenderError("its OpenGL is too old for VTK")
    return str(name)


def _float_pass() -> vtkFramebufferPass:
    """Pass that keeps its colours as float32 and draws opaque triangles only."""
    steps = vtkRenderPassCollection()
    steps.AddItem(vtkOpaquePass())
    sequence = vtkSequencePass()
    sequence.SetPasses(steps)
    camera = vtkCameraPass()
    camera.SetDelegatePass(sequence)
    framebuffer = vtkFramebufferPass()
    framebuffer.SetDelegatePass(camera)
    framebuffer.SetColorFormat(vtkTextureObject.Float32)
    return framebuffer


@contextmanager
def _errors_raised() -> Iterator[None]:
    """Turn what VTK writes to its output window, and otherwise forgets, into a RenderError."""
    errors: list[str] = []

    def collect(_source: vtkObject, _event: str, text: str) -> None:
        errors.append(" ".join(text.split())[:500])

    # VTK reads from this attribute that the text of the event is wanted.
    collect.CallDataType = "string0"  # type: ignore[attr-defined]
    listening = vtkStringOutputWindow()
    listening.AddObserver(vtkCommand.ErrorEvent, collect)
    before = vtkOutputWindow.GetInstance()
    verbosity = vtkLogger.GetCurrentVerbosityCutoff()
    vtkOutputWindow.SetInstance(listening)
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    try:
        yield
    finally:
        vtkOutputWindow.SetInstance(before)
        vtkLogger.SetStderrVerbosity(verbosity)
    if errors:
        raise RenderError("VTK reported: " + "; ".join(dict.fromkeys(errors)))
