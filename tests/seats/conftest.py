from support.demo_shapes import cushion, flattened, foam, solid_angle, surface

__all__ = ["cushion", "flattened", "foam", "solid_angle", "surface"]
