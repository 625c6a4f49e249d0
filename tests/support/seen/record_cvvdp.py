"""Record ColorVideoVDP of the 54 scenes into tests/data/cvvdp.json; run once, by hand.

Needs packages that the project does not: cvvdp (MIT, without its dependencies), torch for the CPU,
einops, imageio, matplotlib and tqdm. Of torchvision it takes only a Gaussian blur, of ffmpeg and
huggingface_hub nothing for arrays, so these are stood in for here. From the folder ``tests``:
``python -m support.seen.record_cvvdp``.
"""

import importlib.metadata
import json
import sys
import types
from pathlib import Path

import torch

from support.seen.ridges import PPD, SIZE, scenes

PEAK = 1e6  # cd/m2; the linear display model clips there and has no black level of note


class GaussianBlur(torch.nn.Module):
    """Separable Gaussian blur with reflected edges, as torchvision defines it."""

    def __init__(self, kernel_size, sigma):
        super().__init__()
        size = kernel_size if isinstance(kernel_size, int) else kernel_size[0]
        x = torch.arange(size) - (size - 1) / 2
        weight = torch.exp(
            -0.5 * (x / (sigma if isinstance(sigma, int | float) else sigma[0])) ** 2
        )
        self.weight, self.half = weight / weight.sum(), size // 2

    def forward(self, image):
        shape = image.shape
        flat = image.reshape(-1, 1, *shape[-2:])
        flat = torch.nn.functional.pad(flat, [self.half] * 4, mode="reflect")
        weight = self.weight.to(flat)
        flat = torch.nn.functional.conv2d(flat, weight.reshape(1, 1, 1, -1))
        return torch.nn.functional.conv2d(flat, weight.reshape(1, 1, -1, 1)).reshape(shape)


def stand_ins():
    """Enough of torchvision and ffmpeg for cvvdp to be imported."""
    transforms = types.ModuleType("torchvision.transforms")
    transforms.GaussianBlur = GaussianBlur
    ops = types.ModuleType("torchvision.ops")
    ops.MLP = None
    hub = types.ModuleType("huggingface_hub")
    hub.hf_hub_download = None
    for name, module in {
        "torchvision": types.ModuleType("torchvision"),
        "torchvision.transforms": transforms,
        "torchvision.ops": ops,
        "ffmpeg": types.ModuleType("ffmpeg"),
        "huggingface_hub": hub,
    }.items():
        sys.modules.setdefault(name, module)


def observer(size, pixels_per_degree):
    """Return what ColorVideoVDP says was lost of the second of two pictures, 10 - JOD."""
    stand_ins()
    import pycvvdp
    from pycvvdp.display_model import vvdp_display_geometry, vvdp_display_photo_eotf

    torch.set_num_threads(1)
    metric = pycvvdp.cvvdp(
        display_photometry=vvdp_display_photo_eotf(PEAK, contrast=1e9, EOTF="linear"),
        display_geometry=vvdp_display_geometry(size, ppd=pixels_per_degree),
        heatmap=None,
        device=torch.device("cpu"),
    )

    def lost(test, reference):
        colour = [
            torch.tensor(p, dtype=torch.float32).expand(3, *p.shape) for p in (test, reference)
        ]
        return 10 - float(metric.predict(*colour, dim_order="CHW")[0])

    return lost


def record_scenes():
    lost = observer(SIZE, PPD)
    found = {}
    for name, test, reference in scenes():
        found[name] = round(lost(test, reference), 5)
        sys.stdout.write(f"{name}: {found[name]}\n")
    record = {
        "measure": "10 - JOD of ColorVideoVDP",
        "cvvdp": importlib.metadata.version("cvvdp"),
        "torch": importlib.metadata.version("torch"),
        "pixels_per_degree": PPD,
        "size": SIZE,
        "display": f"linear, {PEAK:g} cd/m2, no ambient light",
        "lost": found,
    }
    path = Path(__file__).parents[2] / "data" / "cvvdp.json"
    path.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    record_scenes()
