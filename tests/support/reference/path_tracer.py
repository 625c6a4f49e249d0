"""The same surface, lights and camera in Mitsuba 3, with the same BRDF: truth for the renderer.

Only for measuring (dependency group ``reference``). Mitsuba's compiled variant needs an LLVM of
at least version 17; with an older one it ends the process, so the library is looked for first.
"""

from __future__ import annotations

import ctypes.util
import os

import numpy as np

from seatlook.model import Appearance, Camera, Light, Rig
from seatlook.pbr.kernels.brdf import MIN_ALPHA
from seatlook.pbr.light.rig import sky_colour
from seatlook.pbr.reflectance import brdf
from seatlook.pbr.reflectance.brdf import COAT_F0
from seatlook.pbr.shading.studio import Studio

# Far enough for parallel light: the irradiance of a 0.3 m object differs by 0.3 %.
_FAR = 200.0
_NODES = 1024


def find_llvm() -> str | None:
    """Return the name of an LLVM library that Mitsuba can use, None where there is none."""
    if os.environ.get("DRJIT_LIBLLVM_PATH"):
        return os.environ["DRJIT_LIBLLVM_PATH"]
    for version in (19, 20, 21, 18, 17):
        for name in (f"libLLVM.so.{version}.1", f"libLLVM-{version}.so.1", f"libLLVM-{version}.so"):
            try:
                ctypes.CDLL(name)
            except OSError:
                continue
            return name
    return None


def load_mitsuba():
    """Return the module ``mitsuba`` with its variant set; ImportError where it cannot run."""
    llvm = find_llvm()
    if llvm is None:
        raise ImportError("Mitsuba needs LLVM 17 or later: install libllvm19")
    os.environ["DRJIT_LIBLLVM_PATH"] = llvm
    import drjit
    import mitsuba

    mitsuba.set_variant("llvm_ad_rgb")
    drjit.set_thread_count(1)
    return mitsuba


def trace(
    studio: Studio,
    appearance: Appearance,
    *,
    rig: Rig,
    camera: Camera,
    depth: int,
    spp: int,
    relief: Relief | None = None,
    seed: int = 0,
) -> np.ndarray:
    """Radiance (h, w, 3) [cd/m2] by path tracing; ``depth`` 2 is direct light alone."""
    mi = load_mitsuba()
    scene = {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": depth, "rr_depth": 100},
        "sensor": _sensor(mi, camera),
        "cover": _shape(mi, studio, layered_bsdf(mi, appearance, relief)),
    }
    for light in rig.lights:
        scene[light.name] = _emitter(mi, light)
    if rig.ambient > 0:
        scene["sky"] = {"type": "constant", "radiance": _rgb(rig.ambient * sky_colour(rig))}
    return np.array(mi.render(mi.load_dict(scene), spp=spp, seed=seed))


def _rgb(value) -> dict:
    return {"type": "rgb", "value": [float(v) for v in value]}


def _sensor(mi, camera: Camera) -> dict:
    width, height = camera.size
    look = mi.ScalarTransform4f().look_at(
        origin=camera.position.tolist(), target=camera.target.tolist(), up=camera.up.tolist()
    )
    film = {"type": "hdrfilm", "width": width, "height": height, "pixel_format": "rgb"}
    film |= {"component_format": "float32", "rfilter": {"type": "box"}}
    return {
        "type": "perspective",
        "fov": camera.vertical_fov_deg,
        "fov_axis": "y",
        "near_clip": 0.01,
        "to_world": look,
        "film": film,
        "sampler": {"type": "multijitter"},
    }


def _emitter(mi, light: Light) -> dict:
    """A disc in the sky, or a sphere, of the light's size and power."""
    to = mi.ScalarTransform4f()
    if light.near:
        radiance = light.intensity * light.colour / (np.pi * light.size**2)
        shape = {"type": "sphere", "center": light.vector.tolist(), "radius": light.size}
    else:
        half = light.size / 2
        radiance = light.intensity * light.colour / (np.pi * np.sin(half) ** 2)
        up = [0.0, 1.0, 0.0] if abs(light.vector[2]) > 0.9 else [0.0, 0.0, 1.0]
        place = to.look_at(origin=(_FAR * light.vector).tolist(), target=[0, 0, 0], up=up)
        shape = {"type": "disk", "to_world": place @ to.scale([_FAR * float(np.tan(half))] * 3)}
    return shape | {"emitter": {"type": "area", "radiance": _rgb(radiance)}}


def _shape(mi, studio: Studio, bsdf):
    drawn = studio.surface.cover_mesh
    props = mi.Properties()
    props["bsdf"] = bsdf
    mesh = mi.Mesh(
        "cover",
        vertex_count=len(drawn.vertices),
        face_count=len(drawn.faces),
        has_vertex_normals=True,
        has_vertex_texcoords=True,
        props=props,
    )
    values = mi.traverse(mesh)
    values["vertex_positions"] = drawn.vertices.ravel().astype(np.float32)
    values["vertex_normals"] = drawn.normals.ravel().astype(np.float32)
    values["vertex_texcoords"] = drawn.uv.ravel().astype(np.float32)
    values["faces"] = drawn.faces.ravel().astype(np.uint32)
    values.update()
    return mesh


class Relief:
    """Slopes and colour share (n, n, 3) of a relief that repeats, and its tone over the scene.

    ``tile`` [m] is the width of the repeated map; ``tone`` (k, k) multiplies the colour share
    between pattern coordinates ``-edge`` and ``edge`` [m].
    """

    def __init__(self, values: np.ndarray, tile: float, tone: np.ndarray, edge: float) -> None:
        self.values, self.tile = values.astype(np.float32), tile
        self.tone, self.edge = tone[..., None].astype(np.float32), edge


def layered_bsdf(mi, appearance: Appearance, relief: Relief | None):  # noqa: C901
    """Return ``seatlook.pbr.reflectance.brdf.evaluate`` as a Mitsuba BSDF."""
    import drjit as dr

    a = appearance
    alpha = max(a.roughness**2, MIN_ALPHA)
    if a.anisotropy != 0:
        raise ValueError("anisotropy is not written")
    if a.maps is not None:
        raise ValueError("measured maps are not written")
    curves = _curves(a)
    f0, metal = np.full(3, a.f0), a.metalness
    f90 = brdf.F90(f0)
    mean, coat_mean = brdf.E_mean(a.roughness), brdf.E_mean(a.coat_roughness)
    multiple = brdf.F_multiple(f0, f90, mean)
    bare = (a.albedo, brdf.F90(a.albedo), brdf.F_multiple(a.albedo, brdf.F90(a.albedo), mean))
    coat_multiple = float(brdf.F_multiple(np.full(1, COAT_F0), np.ones(1), coat_mean)[0])
    coat, sheen = a.coat, float(a.sheen.max())
    tilted = np.array([0.6, 0.0, 0.8])
    sheen_norm = float(brdf.sheen(a, tilted, tilted)) / _bare_sheen(a.sheen_roughness**2, 0.8)
    lobes = [alpha, a.coat_roughness**2] if coat > 0 else [alpha]

    class Layered(mi.BSDF):
        def __init__(self, props):
            mi.BSDF.__init__(self, props)
            flags = mi.BSDFFlags.GlossyReflection | mi.BSDFFlags.FrontSide
            self.m_components = [flags]
            self.m_flags = flags
            self.curves = {k: mi.Float(v.astype(np.float32)) for k, v in curves.items()}
            if relief is not None:
                linear = {"filter_mode": dr.FilterMode.Linear}
                self.map = mi.Texture2f(
                    mi.TensorXf(relief.values), wrap_mode=dr.WrapMode.Repeat, **linear
                )
                self.tone = mi.Texture2f(
                    mi.TensorXf(relief.tone), wrap_mode=dr.WrapMode.Clamp, **linear
                )

        def curve(self, name, mu):
            x = dr.sqrt(dr.clip(mu, 0, 1)) * (_NODES - 1)
            i = dr.minimum(mi.UInt32(x), _NODES - 2)
            b = x - mi.Float(i)
            low = dr.gather(mi.Float, self.curves[name], i)
            return low + b * (dr.gather(mi.Float, self.curves[name], i + 1) - low)

        def frame(self, si):
            """Frame (warp, weft, normal) of the relief in the local one, and the colour share."""
            n, share = _towards(mi.Vector3f(0, 0, 1), si.wi), mi.Float(1)
            if relief is not None:
                t, s = _axes(n)
                su, sv, share = self.map.eval(mi.Point2f(si.uv / relief.tile))
                share *= self.tone.eval(mi.Point2f(0.5 + 0.5 * si.uv / relief.edge))[0]
                n = _towards(dr.normalize(n - su * t - sv * s), si.wi)
            t, s = _axes(n)
            return mi.Frame3f(t, s, n), share

        def value(self, v, l, share):
            """BRDF times the cosine of ``l``, both in the relief's frame."""
            c = self.curve
            h = dr.normalize(v + l)
            noh, loh = dr.clip(h.z, 0, 1), dr.clip(dr.dot(l, h), 0, 1)
            colour = mi.Color3f(a.albedo.tolist()) * share
            low, high = mi.Color3f(f0.tolist()), mi.Color3f(f90.tolist())
            if metal > 0 and relief is not None:
                raise ValueError("metal with a relief is not written")
            schlick = low + (high - low) * (1 - loh) ** 5
            single = _ggx(alpha, noh, v.z, l.z)
            again_base = c("lost", v.z) * c("lost", l.z) / (np.pi * (1 - mean))
            specular = schlick * single + mi.Color3f(multiple.tolist()) * again_base
            out = dr.minimum(c("below", v.z), c("below", l.z)) * specular
            out += colour * c("base", v.z) * c("base", l.z)
            if sheen > 0:
                s = 1 / a.sheen_roughness**2
                lobe = (2 + s) * dr.power(dr.maximum(1 - noh * noh, 1e-12), s / 2) / (2 * np.pi)
                lobe *= sheen_norm / (4 * (l.z + v.z - l.z * v.z))
                out += (
                    dr.minimum(c("coat", v.z), c("coat", l.z)) * mi.Color3f(a.sheen.tolist()) * lobe
                )
            if coat > 0:
                schlick = COAT_F0 + (1 - COAT_F0) * (1 - loh) ** 5
                again = c("coat_lost", v.z) * c("coat_lost", l.z) / (np.pi * (1 - coat_mean))
                out += coat * (
                    schlick * _ggx(a.coat_roughness**2, noh, v.z, l.z) + coat_multiple * again
                )
            if metal > 0:
                low, high, more = (mi.Color3f(x.tolist()) for x in bare)
                specular = (low + (high - low) * (1 - loh) ** 5) * single + more * again_base
                out = (1 - metal) * out + metal * specular
            return out * l.z

        def density(self, v, l):
            h = dr.normalize(v + l)
            total = 0.5 * l.z / np.pi
            for width in lobes:
                d = _distribution(width, h.z) * h.z / (4 * dr.maximum(dr.dot(v, h), 1e-6))
                total += 0.5 / len(lobes) * d
            return total

        def local(self, si, wo, active):
            frame, share = self.frame(si)
            v, l = frame.to_local(si.wi), frame.to_local(wo)
            front = dr.dot(si.n, si.to_world(si.wi)) > 0
            return v, l, share, active & front & (v.z > 1e-6) & (l.z > 1e-5)

        def eval(self, ctx, si, wo, active=True):
            v, l, share, active = self.local(si, wo, active)
            return dr.select(active, self.value(v, l, share), 0)

        def pdf(self, ctx, si, wo, active=True):
            v, l, _, active = self.local(si, wo, active)
            return dr.select(active, self.density(v, l), 0)

        def eval_pdf(self, ctx, si, wo, active=True):
            v, l, share, active = self.local(si, wo, active)
            return dr.select(active, self.value(v, l, share), 0), dr.select(
                active, self.density(v, l), 0
            )

        def sample(self, ctx, si, sample1, sample2, active=True):
            frame, share = self.frame(si)
            v = frame.to_local(si.wi)
            l = mi.warp.square_to_cosine_hemisphere(sample2)
            for k, width in enumerate(lobes):
                q = sample2.x
                z = dr.sqrt((1 - q) / (1 + (width**2 - 1) * q))
                r, phi = dr.safe_sqrt(1 - z * z), 2 * np.pi * sample2.y
                h = mi.Vector3f(r * dr.cos(phi), r * dr.sin(phi), z)
                turn = 0.5 + 0.5 * k / len(lobes)
                l = dr.select(sample1 >= turn, 2 * dr.dot(v, h) * h - v, l)
            front = dr.dot(si.n, si.to_world(si.wi)) > 0
            active &= front & (v.z > 1e-6) & (l.z > 1e-5)
            bs = mi.BSDFSample3f()
            bs.wo = frame.to_world(l)
            bs.pdf = dr.select(active, self.density(v, l), 0)
            bs.eta = 1.0
            bs.sampled_type = mi.UInt32(+mi.BSDFFlags.GlossyReflection)
            bs.sampled_component = 0
            weight = self.value(v, l, share) / bs.pdf
            return bs, dr.select(active & (bs.pdf > 0), weight, 0)

        def to_string(self):
            return "Layered[]"

    def _distribution(width, noh):
        d = noh * noh * (width**2 - 1) + 1
        return width**2 / (np.pi * d * d)

    def _ggx(width, noh, nov, nol):
        view = nol * dr.sqrt(width**2 * (1 - nov * nov) + nov * nov)
        light = nov * dr.sqrt(width**2 * (1 - nol * nol) + nol * nol)
        return _distribution(width, noh) * 0.5 / (view + light)

    def _towards(n, v):
        c = dr.dot(n, v)
        return dr.select(c >= 0.01, n, dr.normalize(n + (0.01 - c) * v))

    def _axes(n):
        t = dr.normalize(mi.Vector3f(1, 0, 0) - n.x * n)
        return t, dr.cross(n, t)

    return Layered(mi.Properties())


def _curves(a: Appearance) -> dict[str, np.ndarray]:
    """What each layer lets through and loses over sqrt(mu); ``base`` with its own mean."""
    mu = np.linspace(0, 1, _NODES) ** 2
    d = np.column_stack([np.sqrt(1 - mu**2), np.zeros(_NODES), mu])
    coat, below, base = brdf.passed(a, d)
    return {
        "coat": coat,
        "below": below,
        "base": base / np.sqrt(np.pi * brdf.coupling(a)),
        "lost": brdf.E_lost(a.roughness, 0.0, d),
        "coat_lost": brdf.E_lost(a.coat_roughness, 0.0, d),
    }


def _bare_sheen(alpha: float, cosine: float) -> float:
    mu = np.array(cosine)
    return float(brdf.D_Charlie(alpha, mu) * brdf.V_Neubelt(mu, mu))
