// Shading in GLSL of what each pixel sees: detail, lights, sky; the maps laid over it; the display.

import { BRDF, MATERIALS } from "./glsl_brdf.js";
import { SEEN } from "./glsl_seen.js";

export const MOST_LIGHTS = 8;

// Grain, seams and holes, see pbr/kernels/grain.py, sewn.py and detail.py.
const DETAIL = `
uniform float uPixel;
uniform int uTexture;
uniform vec3 uRelief;
uniform vec2 uGrain;
uniform sampler2D uSlopes;
uniform vec2 uHoles;
uniform vec4 uThread;
uniform vec4 uThreadColour;
uniform float uGauge;
uniform sampler2D uPhoto;
uniform vec4 uPhotoSize;

const int SUEDE = 1;
const int WEAVE = 2;
const float ROLL_DEPTH = 0.0008, ROLL_WIDTH = 0.0011, PRESS_DEPTH = 0.0002, PRESS_WIDTH = 0.0012;
const float PUCKER_HEIGHT = 0.00016, PUCKER_WIDTH = 0.0019, UNEVEN = 0.35;
const float DIMPLE_DEPTH = 0.00016, DIMPLE_WIDTH = 0.0006, HOLE = 0.00025;
const float PLY_LENGTH = 0.0011, PLY_ACROSS = 1.6, PLY_HEIGHT = 0.00006, PLY_DARK = 0.4;
const float STEEPEST = 0.9, BLUR = 2.0;

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

float overlap(float x, float h, float width) {
  return max(0.0, min(x + 0.5 * width, h) - max(x - 0.5 * width, -h)) / width;
}

// Share of a normal distribution below t; clamped, since tanh overflows on some cards.
float below(float t) {
  t = clamp(t, -6.0, 6.0);
  return 0.5 + 0.5 * tanh(0.7978846 * t * (1.0 + 0.044715 * t * t));
}

struct Sewn { float away; float onward; float left; float covered; float bright; };

// Relief beside a seam: slopes away from and along it, share of the colour, thread and its light.
Sewn sewnRelief(float rows, float distance, float arc, float width) {
  width = max(width, 1e-6);
  Sewn s = Sewn(ROLL_DEPTH / ROLL_WIDTH * exp(-distance / ROLL_WIDTH), 0.0,
    1.0 - 0.65 * exp(-distance / 0.0006), 0.0, 1.0);
  float pitch = uThread.y, h = 0.5 * uThread.w;
  if (rows < 0.5 || h == 0.0) return s;
  bool second = rows > 1.5 && distance > uThread.x + 0.5 * uGauge;
  float x = distance - uThread.x - (second ? uGauge : 0.0);
  float number = floor(arc / pitch);
  float y = arc - (number + 0.5) * pitch;
  float t = x / PRESS_WIDTH;
  s.away += PRESS_DEPTH / PRESS_WIDTH * t * exp(-0.5 * t * t);
  // Stitches are regular and would beat with the pixels: along the row they are blurred.
  float blur = BLUR * width, turn = 2.0 * PI / pitch;
  float seen = exp(-0.5 * turn * turn * blur * blur);
  float high = seen * PUCKER_HEIGHT
    * (1.0 + UNEVEN * (2.0 * even(uint(number), second ? 1u : 0u, 5u) - 1.0));
  t = x / PUCKER_WIDTH;
  float bell = exp(-0.5 * t * t);
  s.away -= 0.5 * high * (1.0 + cos(turn * y)) * bell * t / PUCKER_WIDTH;
  s.onward -= 0.5 * high * turn * sin(turn * y) * bell;
  float wide = DIMPLE_WIDTH * DIMPLE_WIDTH + blur * blur, hole = HOLE * HOLE + blur * blur;
  float deep = DIMPLE_DEPTH * DIMPLE_WIDTH * DIMPLE_WIDTH / wide, dark = 0.75 * HOLE * HOLE / hole;
  for (int k = -1; k <= 1; k += 2) {
    float z = y - 0.5 * float(k) * pitch, r2 = x * x + z * z;
    float dimple = deep * exp(-0.5 * r2 / wide);
    s.away += dimple * x / wide;
    s.onward += dimple * z / wide;
    s.left *= 1.0 - dark * exp(-0.5 * r2 / hole);
  }
  float fine = exp(-2.5 * width * width / (h * h));
  float over = max(0.0, abs(y) - (0.5 * uThread.z - h));
  float across = h - fine * (h - sqrt(max(0.1 * h * h, h * h - over * over)));
  float far = clamp(2.0 * width / pitch - 0.5, 0.0, 1.0), onto = 0.0;
  for (int k = -1; k <= 1; ++k) {
    float there = y - float(k) * pitch;
    onto += below((there + 0.5 * uThread.z) / blur) - below((there - 0.5 * uThread.z) / blur);
  }
  s.covered = overlap(x, across, width) * mix(onto, uThread.z / pitch, far);
  if (s.covered < 1e-6) return s;
  float r = min(1.0, sqrt(x * x + over * over) / h);
  float steep = fine * STEEPEST * r / sqrt(1.0 - 0.75 * r * r), size = max(r * h, 1e-9);
  float ends = exp(-0.5 * PI * PI * blur * blur / (uThread.w * uThread.w));
  vec2 slope = -steep * vec2(x, ends * over * sign(y)) / size;
  float turn_of_ply = 2.0 * PI * blur / PLY_LENGTH;
  seen = exp(-0.5 * turn_of_ply * turn_of_ply);
  float phase = 2.0 * PI * (y / PLY_LENGTH + PLY_ACROSS * x / uThread.w);
  slope -= PI * seen * PLY_HEIGHT * sin(phase) * vec2(PLY_ACROSS / uThread.w, 1.0 / PLY_LENGTH);
  float valley = 0.5 - 0.5 * cos(phase);
  s.bright = 1.0 - PLY_DARK * (seen * valley * valley + 0.375 * (1.0 - seen));
  s.away = mix(s.away, slope.x, s.covered);
  s.onward = mix(s.onward, slope.y, s.covered);
  s.left = mix(s.left, s.bright, s.covered);
  return s;
}

Detail detailOf(Material m, Seen seen, vec3 n, vec3 v, vec3 warp, vec3 weft, float reach) {
  Detail d = Detail(n, m.albedo, m.roughness, 1.0, 0.0);
  float cosine = max(0.05, dot(n, v));
  float width = reach * uPixel / sqrt(cosine);
  float share = 1.0, own = 0.0, bright = 1.0;
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
  if (SEWN && seen.seam.x < max(uThread.x + uGauge + 0.0057, 0.006)) {
    float sample_width = reach * uPixel / sqrt(max(0.05, abs(dot(seen.plane, v))));
    Sewn seam = sewnRelief(seen.seam.z, seen.seam.x, seen.seam.y, sample_width);
    d.n = normalize(d.n - seam.away * seen.away - seam.onward * seen.onward);
    share *= seam.left;
    own = seam.covered * uThreadColour.a;
    bright = seam.bright;
    d.roughness += seam.covered * max(0.0, 0.6 - d.roughness);
  }
  d.colour = d.colour * (share * (1.0 - own)) + own * bright * uThreadColour.rgb;
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
uniform vec4 uArea;
uniform vec2 uDrawn;
out vec4 oColour;

void main() {
  vec2 inside = gl_FragCoord.xy - uArea.xy;
  vec4 sum = texelFetch(uSum, ivec2(inside * uDrawn / uArea.zw), 0);
  vec3 x = (sum.rgb + (uCount - sum.a) * uPaper) / uCount / uNeutral;
  x = clamp(x, 0.0, 1.0);
  vec3 code = mix(1.055 * pow(max(x, 1e-9), vec3(1.0 / 2.4)) - 0.055, 12.92 * x, vec3(lessThanEqual(x, vec3(0.0031308))));
  vec2 at = vec2(floor(inside.x), uArea.w - 1.0 - floor(inside.y));
  float noise = fract(52.9829189 * fract(dot(at, vec2(0.06711056, 0.00583715))));
  oColour = vec4(floor(clamp(255.0 * code + 0.002 + 0.996 * noise, 0.0, 255.0)) / 255.0, 1.0);
}
`;
