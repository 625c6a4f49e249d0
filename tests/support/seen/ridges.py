"""54 fixed scenes: 3 albedos x 3 roughnesses x 6 suns, the patch at half its size."""

from support.seen.field import PIXEL, PIXELS_PER_DEGREE, Look, Patch, creases, dome, sun

SIZE = (640, 360)
STEP, PPD = 2 * PIXEL, PIXELS_PER_DEGREE / 2
ALBEDOS = (0.03, 0.2, 0.6)
ROUGHNESSES = (0.3, 0.55, 0.85)
# elevation and azimuth [deg]; azimuth 90 shines along the creases
SUNS = ((80, 0), (70, 0), (40, 0), (20, 0), (10, 0), (40, 90))


def scenes():
    """Name, test and reference luminance (h, w) [cd/m2] of every scene."""
    patches = [
        Patch(dome(SIZE, STEP) + creases(SIZE, STEP), STEP),
        Patch(dome(SIZE, STEP), STEP),
    ]
    for albedo in ALBEDOS:
        for roughness in ROUGHNESSES:
            look = Look(albedo=albedo, roughness=roughness)
            for elevation, azimuth in SUNS:
                name = f"albedo {albedo} roughness {roughness} sun {elevation} {azimuth}"
                yield (name, *(p.draw(look, sun(elevation, azimuth)) for p in patches))
