// What each pixel sees of the seat, in GLSL: packed as eight whole numbers, and read again. Shading
// goes by pixels then: triangles are as small as a few of them, and shade most of them twice.

// Unit vectors as a point of the square that an octahedron unfolds to.
const UNFOLD = `
vec3 unfolded(vec2 e) {
  vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
  if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * vec2(n.x >= 0.0 ? 1.0 : -1.0, n.y >= 0.0 ? 1.0 : -1.0);
  return normalize(n);
}

// Two directions in a plane.
void sidesOf(vec3 plane, vec3 warp, out vec3 first, out vec3 second) {
  first = warp - dot(warp, plane) * plane;
  first *= inversesqrt(max(dot(first, first), 1e-12));
  second = cross(plane, first);
}
`;

export const VERTEX = `
layout(location = 0) in vec3 inPosition;
layout(location = 1) in vec2 inNormal;
layout(location = 2) in vec2 inPattern;
layout(location = 3) in vec3 inSeam;
layout(location = 4) in vec3 inWarp;
layout(location = 5) in float inOpen;
uniform mat4 uCamera;
uniform vec3 uLow;
uniform vec3 uStep;
uniform vec2 uSeamRange;
out vec3 vPosition;
out vec3 vNormal;
out vec2 vPattern;
out vec3 vSeam;
out vec3 vWarp;
out float vOpen;
${UNFOLD}
void main() {
  vPosition = uLow + uStep * inPosition;
  vNormal = unfolded(inNormal);
  vPattern = inPattern / 65535.0;
  // Beyond the reach nothing is known: far away, and so is what lies between.
  vSeam = inSeam.x > 65534.5 ? vec3(1e3, 0.0, 0.0) : vec3(uSeamRange * inSeam.xy / 65534.0, inSeam.z);
  vWarp = inWarp;
  vOpen = inOpen;
  gl_Position = uCamera * vec4(vPosition, 1.0);
}
`;

export const DEPTH = `
layout(location = 0) in vec3 inPosition;
uniform mat4 uCamera;
uniform vec3 uLow;
uniform vec3 uStep;
void main() { gl_Position = uCamera * vec4(uLow + uStep * inPosition, 1.0); }
`;

export const NOTHING = "void main() {}\n";

// oPlace: normal, plane of the triangle, pattern, seam with its rows; oSides: warp with the row of the material
// plus one, slopes of the distance from the seam and of the length along it, depth with open share.
export const SEE = `
in vec3 vPosition;
in vec3 vNormal;
in vec2 vPattern;
in vec3 vSeam;
in vec3 vWarp;
in float vOpen;
uniform vec3 uEye;
uniform vec2 uSeamRange;
uniform int uRow;
layout(location = 0) out uvec4 oPlace;
layout(location = 1) out uvec4 oSides;
${UNFOLD}
vec2 folded(vec3 n) {
  vec2 e = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
  if (n.z < 0.0) e = (1.0 - abs(e.yx)) * vec2(e.x >= 0.0 ? 1.0 : -1.0, e.y >= 0.0 ? 1.0 : -1.0);
  return e;
}

// Gradient of a value over the surface, from what changes between pixels.
vec3 gradient(vec3 px, vec3 py, vec3 plane, float dx, float dy) {
  vec3 r1 = cross(py, plane), r2 = cross(plane, px);
  float det = dot(px, r1);
  return abs(det) < 1e-16 ? vec3(0.0) : (r1 * dx + r2 * dy) / det;
}

void main() {
  vec3 v = uEye - vPosition, px = dFdx(vPosition), py = dFdy(vPosition);
  vec3 n = normalize(vNormal), plane = cross(px, py);
  float size = dot(plane, plane);
  // Of a triangle seen from its edge nothing can be told.
  plane = size > 1e-30 ? plane * inversesqrt(size) : n;
  if (dot(plane, v) < 0.0) plane = -plane;
  if (dot(plane, n) < 0.0) n = -n;
  vec3 warp = vWarp - dot(vWarp, n) * n;
  if (dot(warp, warp) < 1e-8) warp = abs(n.z) < 0.9 ? vec3(n.y, -n.x, 0.0) : vec3(0.0, n.z, -n.y);
  warp = normalize(warp);
  vec3 first, second;
  sidesOf(plane, warp, first, second);
  vec3 away = gradient(px, py, plane, dFdx(vSeam.x), dFdy(vSeam.x));
  vec3 onward = gradient(px, py, plane, dFdx(vSeam.y), dFdy(vSeam.y));
  // Where the nearest seam changes, or is no longer known, values jump: no stitch crosses that.
  bool even = dot(onward, onward) < 4.0 && dot(away, away) < 4.0;
  vec2 seam = even ? clamp(vSeam.xy / uSeamRange, 0.0, 1.0) : vec2(1.0, 0.0);
  // Rows of stitches end where those of the corners differ.
  uint rows = fwidth(vSeam.z) > 1e-3 ? 0u : min(uint(vSeam.z + 0.5), 2u);
  uint beside = seam.x >= 1.0 ? 65535u : rows << 14 | uint(seam.x * 16382.0 + 0.5);
  uint depth = min(uint(gl_FragCoord.z * 16777215.0 + 0.5), 16777215u);
  uvec2 weave = uvec2(2047.5 + 2047.0 * folded(warp));
  oPlace = uvec4(packSnorm2x16(folded(n)), packSnorm2x16(folded(plane)), packUnorm2x16(vPattern), uint(seam.y * 65535.0 + 0.5) << 16 | beside);
  oSides = uvec4(
    weave.x << 20 | weave.y << 8 | uint(uRow + 1), packHalf2x16(vec2(dot(away, first), dot(away, second))),
    packHalf2x16(vec2(dot(onward, first), dot(onward, second))), depth << 8 | uint(clamp(vOpen, 0.0, 1.0) * 255.0 + 0.5));
}
`;

// The same read again. uRight and uTop reach to the border of the picture at depth 1, uPlanes are
// the distances between which is drawn.
export const SEEN = `
uniform highp usampler2D uPlace;
uniform highp usampler2D uSides;
uniform vec3 uEye;
uniform vec3 uAlong;
uniform vec3 uRight;
uniform vec3 uTop;
uniform vec2 uPlanes;
uniform vec2 uShift;
uniform vec2 uDrawn;
uniform vec4 uPatternRange;
uniform vec2 uSeamRange;
${UNFOLD}
struct Seen {
  vec3 position; vec3 normal; vec3 plane; vec3 warp; vec2 pattern; vec3 seam; vec3 away; vec3 onward; float open;
};

// Row of the material plus one, 0 beside the seat.
int rowAt() { return int(texelFetch(uSides, ivec2(gl_FragCoord.xy), 0).x & 255u); }

Seen seenAt() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  uvec4 place = texelFetch(uPlace, at, 0), sides = texelFetch(uSides, at, 0);
  float z = 2.0 * float(sides.w >> 8) / 16777215.0 - 1.0;
  float depth = 2.0 * uPlanes.x * uPlanes.y / (uPlanes.x + uPlanes.y - z * (uPlanes.y - uPlanes.x));
  vec2 xy = 2.0 * gl_FragCoord.xy / uDrawn - 1.0 + uShift;
  Seen seen;
  seen.position = uEye + depth * (uAlong + xy.x * uRight + xy.y * uTop);
  seen.normal = unfolded(unpackSnorm2x16(place.x));
  seen.plane = unfolded(unpackSnorm2x16(place.y));
  seen.warp = unfolded(vec2(uvec2(sides.x >> 20, sides.x >> 8 & 4095u)) / 2047.0 - 1.0);
  seen.pattern = uPatternRange.xy + 65535.0 * uPatternRange.zw * unpackUnorm2x16(place.z);
  uint beside = place.w & 65535u;
  vec2 at_seam = uSeamRange * vec2(float(beside & 16383u) / 16382.0, float(place.w >> 16) / 65535.0);
  seen.seam = beside == 65535u ? vec3(1e3, 0.0, 0.0) : vec3(at_seam, float(beside >> 14));
  vec3 first, second;
  sidesOf(seen.plane, seen.warp, first, second);
  vec2 away = unpackHalf2x16(sides.y), onward = unpackHalf2x16(sides.z);
  seen.away = away.x * first + away.y * second;
  seen.onward = onward.x * first + onward.y * second;
  seen.open = float(sides.w & 255u) / 255.0;
  return seen;
}
`;
