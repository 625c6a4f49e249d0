// Shading in GLSL of what each pixel sees: detail, lights, sky; the maps laid over it; the display.

import { BRDF, MATERIALS } from "./glsl_brdf.js";
import { SEEN } from "./glsl_seen.js";

export const MOST_LIGHTS = 8;

// Grain, seams and holes, see pbr/kernels/grain.py, stitch.py and detail.py.
const DETAIL = `
uniform float uPixel;
uniform int uTexture;
uniform vec3 uRelief;
uniform vec2 uGrain;
uniform sampler2D uSlopes;
uniform vec2 uHoles;
uniform vec4 uThread;
uniform vec4 uThreadColour;
uniform sampler2D uPhoto;
uniform vec4 uPhotoSize;

const int SUEDE = 1;
const int WEAVE = 2;
const float ROLL_DEPTH = 0.0008, ROLL_WIDTH = 0.0011, PRESS_DEPTH = 0.00022, PRESS_WIDTH = 0.0012;
const float HOLE = 0.00045;

struct Detail { vec3 n; vec3 colour; float roughness; float left; float wider; };

float even(uint i, uint j, uint k) {
  uint h = (i * 73856093u) ^ (j * 19349663u) ^ (k * 83492791u);
  h = (h ^ (h >> 16)) * 0x7FEB352Du;
  h = (h ^ (h >> 15)) * 0x846CA68Bu;
  return float((h ^ (h >> 16)) >> 8) / 16777216.0;
}

float smoothNoise(vec2 x, uint k) {
  vec2 i = floor(x), a = x - i;
  a = a * a * a * (a * (6.0 * a - 15.0) + 10.0);
  uvec2 u = uvec2(ivec2(i) + 1048576);
  float low = mix(even(u.x, u.y, k), even(u.x + 1u, u.y, k), a.x);
  float high = mix(even(u.x, u.y + 1u, k), even(u.x + 1u, u.y + 1u, k), a.x);
  return 2.0 * mix(low, high, a.y) - 1.0;
}

float stroke(vec2 uv) {
  float bend = 0.4 * smoothNoise(uv / 0.06, 3u);
  float mark = 4.0 * smoothNoise(vec2(uv.x / 0.05, uv.y / 0.03) + bend, 1u);
  return 1.0 + 0.035 * (mark / sqrt(1.0 + mark * mark) - 1.0);
}

float holes(vec2 uv, float width) {
  float pitch = uHoles.x, diameter = uHoles.y, height = pitch * sqrt(0.75);
  float mean = 0.25 * PI * diameter * diameter / (pitch * height);
  float blur = clamp(width / pitch - 0.5, 0.0, 1.0);
  float line = floor(uv.y / height), nearest = 1e9;
  for (int j = 0; j < 2; ++j) {
    float y = uv.y - (line + float(j)) * height;
    float x = uv.x / pitch - 0.5 * mod(line + float(j), 2.0);
    x = (x - floor(x + 0.5)) * pitch;
    nearest = min(nearest, x * x + y * y);
  }
  float inside = clamp((0.5 * diameter - sqrt(nearest)) / max(width, 1e-9) + 0.5, 0.0, 1.0);
  return mix(inside, mean, blur);
}

// Groove and top stitch: slopes away from and along the seam, share of the colour, thread.
vec4 seamRelief(float distance, float arc, float width) {
  float away = ROLL_DEPTH / ROLL_WIDTH * exp(-distance / ROLL_WIDTH);
  float share = 1.0 - 0.65 * exp(-distance / 0.0006);
  float thread = uThread.w;
  if (thread == 0.0) return vec4(away, 0.0, share, 0.0);
  float x = (distance - uThread.x) / PRESS_WIDTH;
  away += PRESS_DEPTH / PRESS_WIDTH * x * exp(-0.5 * x * x);
  float y = arc / uThread.y;
  y = (y - floor(y) - 0.5) * uThread.y;
  x = distance - uThread.x;
  float half_width = 0.5 * thread;
  float over = max(0.0, abs(y) - (0.5 * uThread.z - half_width));
  float r = sqrt(x * x + over * over);
  float covered = clamp((half_width - r) / max(width, 1e-6) + 0.5, 0.0, 1.0);
  if (covered > 0.0) {
    float q = min(r / half_width, 0.95);
    float steep = covered * q / sqrt(1.0 - q * q);
    away = (1.0 - covered) * away - steep * x / max(r, 1e-9);
    return vec4(away, -steep * over * sign(y) / max(r, 1e-9), 1.0, covered);
  }
  float hole = sqrt(x * x + pow(abs(y) - 0.5 * uThread.y, 2.0));
  share *= 1.0 - 0.75 * clamp((HOLE - hole) / max(width, 1e-6) + 0.5, 0.0, 1.0);
  return vec4(away, 0.0, share, 0.0);
}

Detail detailOf(Material m, Seen seen, vec3 n, vec3 v, vec3 warp, vec3 weft, float reach) {
  Detail d = Detail(n, m.albedo, m.roughness, 1.0, 0.0);
  float cosine = max(0.05, dot(n, v));
  float width = reach * uPixel / sqrt(cosine);
  float share = 1.0, own = 0.0;
  if (PHOTO && uPhotoSize.x > 0.0) {
    float texel = sqrt(uPhotoSize.x / uPhotoSize.z * uPhotoSize.y / uPhotoSize.w);
    d.colour = textureLod(uPhoto, seen.pattern / uPhotoSize.xy, max(0.0, log2(0.5 * width / texel))).rgb;
  }
  if (RELIEF && uTexture >= 0) {
    float wide = uTexture == WEAVE ? width * max(1.0, 4.0 * width / uGrain.x) : width;
    // Samples of a relief are finer than those of one lobe: what they leave out averages away.
    float texel = uRelief.x / uRelief.y;
    float level = max(0.0, log2(0.5 * wide / texel));
    vec4 t = textureLod(uSlopes, seen.pattern / uRelief.x, level);
    float steep = uGrain.y / uGrain.x;
    float variance = max(0.0, t.z - 0.5 * dot(t.xy, t.xy));
    d.n = normalize(d.n - steep * t.x * warp - steep * t.y * weft);
    share = t.w * (NAP && uTexture == SUEDE ? stroke(seen.pattern) : 1.0);
    if (uTexture == WEAVE || STRETCH && m.anisotropy != 0.0) {
      float alpha = m.roughness * m.roughness;
      d.roughness = min(1.0, sqrt(sqrt(alpha * alpha + 2.0 * steep * steep * variance)));
    } else {
      d.wider = 2.0 * steep * steep * variance;
    }
  }
  if (HOLES && uHoles.y > 0.0) d.left = 1.0 - holes(seen.pattern, width);
  if (SEWN && seen.seam.x < uThread.x + 6.0 * PRESS_WIDTH + uThread.w) {
    vec4 seam = seamRelief(seen.seam.x, seen.seam.y, reach * uPixel / sqrt(max(0.05, abs(dot(seen.plane, v)))));
    d.n = normalize(d.n - seam.x * seen.away - seam.y * seen.onward);
    share *= seam.z;
    own = seam.w * uThreadColour.a;
    d.roughness += seam.w * max(0.0, 0.6 - d.roughness);
  }
  d.colour = d.colour * (share * (1.0 - own)) + own * uThreadColour.rgb;
  return d;
}
`;

const LIGHT = `
uniform int uLights;
uniform vec4 uVector[${MOST_LIGHTS}];
uniform vec3 uIntensity[${MOST_LIGHTS}];
uniform vec4 uAhead[${MOST_LIGHTS}];
uniform vec2 uLightSize[${MOST_LIGHTS}];
uniform mat4 uShadow[${MOST_LIGHTS}];
uniform sampler2DArrayShadow uShadows;
uniform vec3 uSky;

float aboveHorizon(float cosine, float flat_cosine, float angle) {
  float w = 0.866 * angle, least = min(cosine, flat_cosine);
  if (least >= w) return cosine;
  return least > -w ? (pow(cosine + w, 2.0) - pow(cosine - least, 2.0)) / (4.0 * w) : 0.0;
}

// Share of a light that its shadow map lets through, from four places of it.
float lit(int k, vec3 p) {
  vec4 at = uShadow[k] * vec4(p, 1.0);
  vec3 place = at.xyz / at.w * 0.5 + 0.5;
  if (at.w <= 0.0 || any(lessThan(place, vec3(0.0))) || any(greaterThan(place, vec3(1.0)))) return 1.0;
  return texture(uShadows, vec4(place.xy, float(k), place.z));
}
`;

// Radiance over that which is just white.
export const SHADE = `${SEEN}${BRDF}${MATERIALS}${DETAIL}${LIGHT}
uniform int uRow;
uniform float uWhite;
uniform float uSpread;
out vec4 oRadiance;

vec4 shaded() {
  Material m = materialOf(uRow);
  Seen seen = seenAt();
  vec3 v = uEye - seen.position;
  float reach = length(v);
  v /= reach;
  vec3 n = seen.normal;
  float c = dot(n, v);
  if (c < 0.01) n = normalize(n + (0.01 - c) * v);
  vec3 flat_n = n, warp = normalize(seen.warp - dot(seen.warp, n) * n);
  vec3 weft = cross(n, warp);
  Detail d = detailOf(m, seen, n, v, warp, weft, reach);
  n = d.n;
  c = dot(n, v);
  if (c < 0.01) n = normalize(n + (0.01 - c) * v);
  warp = normalize(warp - dot(warp, n) * n);
  weft = cross(n, warp);
  vec3 towards = vec3(dot(warp, v), dot(weft, v), dot(n, v));
  Sight sight = sightOf(m, d.roughness, d.colour, couplingAt(uRow, d.roughness), towards);
  vec3 specular, diffuse;
  albedoTowards(m, sight, specular, diffuse);
  vec3 total = uSky * seen.open * (specular + diffuse);
  for (int k = 0; k < uLights; ++k) {
    vec3 l = uVector[k].xyz - uVector[k].w * seen.position;
    float squared = dot(l, l);
    l *= inversesqrt(squared);
    float angle = uVector[k].w > 0.0 ? uLightSize[k].x * inversesqrt(squared) : uLightSize[k].x;
    float radius = angle * uSpread;
    float NoL = aboveHorizon(dot(n, l), dot(flat_n, l), radius);
    if (NoL <= 1e-5) continue;
    float strength = uVector[k].w > 0.0 ? 1.0 / squared : 1.0;
    float ahead = dot(uAhead[k].xyz, l);
    if (uAhead[k].w > 0.0) strength *= uAhead[k].w > 1.5 ? abs(ahead) : max(0.0, ahead);
    // A little above the surface: the map's own grid must not shade it.
    float lift = uLightSize[k].y * (uVector[k].w > 0.0 ? sqrt(squared) : 1.0);
    strength *= lit(k, seen.position + lift * (1.5 * seen.plane + 0.5 * l));
    if (strength <= 0.0) continue;
    float wider = d.wider + 0.125 * angle * angle * uSpread * uSpread;
    total += brdf(m, sight, wider, vec3(dot(warp, l), dot(weft, l), min(NoL, 1.0))) * (NoL * strength) * uIntensity[k];
  }
  return vec4(total * d.left * uWhite, 1.0);
}

void main() {
  // Of a tile that sees several materials, each adds its own pixels.
  oRadiance = rowAt() == uRow + 1 ? shaded() : vec4(0.0);
}
`;

// A map: colours by value, darker where the surface turns away, as in the pictures of maps.
export const OVERLAY = `${SEEN}
uniform sampler2D uColours;
uniform int uFoam;
out vec4 oRadiance;

void main() {
  int row = rowAt() - 1;
  Seen seen = seenAt();
  float light = 0.62 + 0.38 * abs(dot(seen.normal, normalize(uEye - seen.position)));
  float code = seen.open * 255.0;
  vec3 root = texelFetch(uColours, ivec2(int(clamp((code - 1.0) / 254.0 * 255.0 + 0.5, 0.0, 255.0)), 0), 0).rgb;
  vec3 colour = row != uFoam && code >= 0.5 ? root * root : vec3(pow(205.0 / 255.0, 2.2));
  oRadiance = row < 0 ? vec4(0.0) : vec4(light * colour, 1.0);
}
`;

// From the sum of some pictures to the display: what sees no seat sees the paper, exposure is in the
// radiance, then white point, clamp, sRGB and the dither of pbr/light/exposure.py.
export const DISPLAY = `
uniform sampler2D uSum;
uniform float uCount;
uniform vec3 uNeutral;
uniform vec3 uPaper;
uniform vec2 uSize;
uniform vec2 uDrawn;
out vec4 oColour;

void main() {
  vec4 sum = texelFetch(uSum, ivec2(gl_FragCoord.xy * uDrawn / uSize), 0);
  vec3 x = (sum.rgb + (uCount - sum.a) * uPaper) / uCount / uNeutral;
  x = clamp(x, 0.0, 1.0);
  vec3 code = mix(1.055 * pow(max(x, 1e-9), vec3(1.0 / 2.4)) - 0.055, 12.92 * x, vec3(lessThanEqual(x, vec3(0.0031308))));
  vec2 at = vec2(floor(gl_FragCoord.x), uSize.y - 1.0 - floor(gl_FragCoord.y));
  float noise = fract(52.9829189 * fract(dot(at, vec2(0.06711056, 0.00583715))));
  oColour = vec4(floor(clamp(255.0 * code + 0.002 + 0.996 * noise, 0.0, 255.0)) / 255.0, 1.0);
}
`;
