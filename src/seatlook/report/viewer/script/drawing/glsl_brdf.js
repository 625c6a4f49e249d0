// The BRDF in GLSL: same terms, tables and names as in seatlook/pbr/kernels/brdf.py and lobes.py.

export const ALL = { coat: true, sheen: true, metal: true, stretch: true };

/**
 * Terms that a shader is to have: software computes those of a branch that is not taken as well.
 * @param {Record<string, boolean>} terms
 */
export function termsOf(terms) {
  return Object.entries(terms).map(([name, on]) => `#define ${name.toUpperCase()} ${on}\n`).join("");
}

export const BRDF = `
const float PI = 3.14159265358979;
const float ROUGHNESS_LOW = 0.08;
const float MIN_ALPHA = 0.0064;
const float COAT_F0 = 0.04;
const ivec4 STRETCHED = ivec4(16, 9, 9, 20);

uniform sampler2D uAlbedos;
uniform sampler2D uMeans;
uniform sampler2D uStretched;
uniform sampler2D uStretchedMeans;

struct Material {
  vec3 albedo;
  float metalness;
  float roughness;
  float f0;
  vec3 sheen;
  float sheen_roughness;
  float coat;
  float coat_roughness;
  float anisotropy;
};

// Place on even nodes: x the index, y the weight of the next.
vec2 cellOf(float value, float low, float high, int n) {
  float x = clamp((value - low) * (float(n - 1) / (high - low)), 0.0, float(n - 1));
  float i = min(floor(x), float(n - 2));
  return vec2(i, x - i);
}

vec3 albedosAt(vec2 row, vec2 column) {
  ivec2 at = ivec2(int(column.x), int(row.x));
  vec3 below = mix(texelFetch(uAlbedos, at, 0).rgb, texelFetch(uAlbedos, at + ivec2(1, 0), 0).rgb, column.y);
  vec3 above = mix(texelFetch(uAlbedos, at + ivec2(0, 1), 0).rgb, texelFetch(uAlbedos, at + ivec2(1, 1), 0).rgb, column.y);
  return mix(below, above, row.y);
}

// Hemisphere mean of a lobe with F = 1, and the sheen's norm.
vec2 meansAt(float roughness) {
  vec2 row = cellOf(roughness, ROUGHNESS_LOW, 1.0, textureSize(uMeans, 0).x);
  ivec2 at = ivec2(int(row.x), 0);
  return mix(texelFetch(uMeans, at, 0).rg, texelFetch(uMeans, at + ivec2(1, 0), 0).rg, row.y);
}

float stretchedMean(float roughness, float anisotropy) {
  vec2 i = cellOf(roughness, ROUGHNESS_LOW, 1.0, STRETCHED.x);
  vec2 k = cellOf(abs(anisotropy), 0.0, 1.0, STRETCHED.y);
  ivec2 at = ivec2(int(k.x), int(i.x));
  float below = mix(texelFetch(uStretchedMeans, at, 0).r, texelFetch(uStretchedMeans, at + ivec2(1, 0), 0).r, k.y);
  float above = mix(texelFetch(uStretchedMeans, at + ivec2(0, 1), 0).r, texelFetch(uStretchedMeans, at + ivec2(1, 1), 0).r, k.y);
  return mix(below, above, i.y);
}

// What anisotropy adds to scale and bias; the table lies as (roughness, anisotropy) down and
// (azimuth, root of the cosine) across.
vec2 stretchedAt(float roughness, float anisotropy, float x, float root) {
  vec2 i = cellOf(roughness, ROUGHNESS_LOW, 1.0, STRETCHED.x);
  vec2 k = cellOf(abs(anisotropy), 0.0, 1.0, STRETCHED.y);
  vec2 t = cellOf(x, 0.0, 1.0, STRETCHED.z);
  vec2 j = cellOf(root, 0.0, 1.0, STRETCHED.w);
  vec2 total = vec2(0.0);
  for (int q = 0; q < 16; ++q) {
    ivec4 side = ivec4(q & 1, q >> 1 & 1, q >> 2 & 1, q >> 3);
    vec4 weight = mix(vec4(1.0 - i.y, 1.0 - k.y, 1.0 - t.y, 1.0 - j.y), vec4(i.y, k.y, t.y, j.y), vec4(side));
    ivec2 at = ivec2((int(t.x) + side.z) * STRETCHED.w + int(j.x) + side.w, (int(i.x) + side.x) * STRETCHED.y + int(k.x) + side.y);
    total += weight.x * weight.y * weight.z * weight.w * texelFetch(uStretched, at, 0).rg;
  }
  return total;
}

float F90(float f0) { return min(1.0, 50.0 * f0); }
vec3 F90(vec3 f0) { return min(vec3(1.0), 50.0 * f0); }

float F_multiple(float f0, float f90, float mean) {
  float average = f0 + (f90 - f0) / 21.0;
  return average * average * mean / (1.0 - average * (1.0 - mean));
}
vec3 F_multiple(vec3 f0, vec3 f90, float mean) {
  vec3 average = f0 + (f90 - f0) / 21.0;
  return average * average * mean / (1.0 - average * (1.0 - mean));
}

float sheenShare(Material m) { return max(m.sheen.r, max(m.sheen.g, m.sheen.b)); }

struct Means { float base; float again; float coat; float coat_again; };

Means meansOf(Material m, float roughness) {
  Means means = Means(meansAt(roughness).x, 0.0, 1.0, 0.0);
  if (STRETCH && m.anisotropy != 0.0) means.base += stretchedMean(roughness, m.anisotropy);
  if (COAT && m.coat > 0.0) {
    means.coat = meansAt(m.coat_roughness).x;
    means.coat_again = F_multiple(COAT_F0, 1.0, means.coat);
  }
  means.again = F_multiple(m.f0, F90(m.f0), means.base);
  return means;
}

struct Layers { float scale; float bias; float coat_lost; float coat; float sheen; float base; };

float azimuthOf(Material m, float x, float y) {
  float both = x * x + y * y;
  if (both < 1e-12) return 0.5;
  return abs(m.anisotropy > 0.0 ? x : y) / sqrt(both);
}

Layers layersAt(Material m, float roughness, Means means, float azimuth, float mu) {
  float root = sqrt(mu);
  ivec2 size = textureSize(uAlbedos, 0);
  vec2 column = cellOf(root, 0.0, 1.0, size.x);
  vec2 base = albedosAt(cellOf(roughness, ROUGHNESS_LOW, 1.0, size.y), column).rg;
  if (STRETCH && m.anisotropy != 0.0) base += stretchedAt(roughness, m.anisotropy, azimuth, root);
  Layers layers = Layers(base.x, base.y, 0.0, 1.0, 1.0, 1.0);
  if (COAT && m.coat > 0.0) {
    vec2 coat = albedosAt(cellOf(m.coat_roughness, ROUGHNESS_LOW, 1.0, size.y), column).rg;
    layers.coat_lost = 1.0 - coat.x - coat.y;
    layers.coat -= m.coat * (COAT_F0 * coat.x + coat.y + means.coat_again * layers.coat_lost);
  }
  float share = sheenShare(m);
  if (SHEEN && share > 0.0) {
    vec2 row = cellOf(m.sheen_roughness, ROUGHNESS_LOW, 1.0, size.y);
    layers.sheen -= share * albedosAt(row, column).b;
  }
  layers.sheen *= layers.coat;
  float reflected = m.f0 * base.x + F90(m.f0) * base.y + means.again * (1.0 - base.x - base.y);
  layers.base = layers.sheen * (1.0 - reflected);
  return layers;
}

// A surface point and the sight of it; coupling: mean of what reaches the diffuse base.
struct Sight {
  vec3 v;
  vec2 alpha;
  float roughness;
  float coupling;
  Means means;
  Layers layers;
  vec3 colour;
};

Sight sightOf(Material m, float roughness, vec3 colour, float coupling, vec3 v) {
  float a = roughness * roughness;
  vec2 alpha = max(a * vec2(1.0 + m.anisotropy, 1.0 - m.anisotropy), vec2(MIN_ALPHA));
  Means means = meansOf(m, roughness);
  Layers layers = layersAt(m, roughness, means, azimuthOf(m, v.x, v.y), v.z);
  return Sight(v, alpha, roughness, coupling, means, layers, colour);
}

// Lobe of width alpha over half-vectors that vary by more, see lobes.lobe_of.
float GGX(float alpha, float more, float NoV, float NoL, float sine2) {
  float a2 = alpha * alpha, b2 = a2 + more;
  float inverse = 1.0 / (b2 + (1.0 - b2) * sine2);
  float t = sine2 * inverse;
  float view = NoL * sqrt(b2 + (1.0 - b2) * NoV * NoV);
  float light = NoV * sqrt(b2 + (1.0 - b2) * NoL * NoL);
  float bent = 1.0 + more * a2 / (b2 * b2) * (6.0 * t * (1.0 - t) - 1.0);
  return bent * b2 * inverse * inverse / (2.0 * PI * (view + light));
}

float widened(float alpha, float more) {
  return more > 1e-3 * alpha * alpha ? sqrt(alpha * alpha + more) : alpha;
}

float stretchedGGX(vec2 a, vec3 v, vec3 l, vec3 h) {
  vec3 d = vec3(a.y * h.x, a.x * h.y, a.x * a.y * h.z);
  float dd = dot(d, d), both = a.x * a.y;
  float seen = l.z * length(vec3(a * v.xy, v.z));
  float lit = v.z * length(vec3(a * l.xy, l.z));
  return both * both * both / (2.0 * PI * dd * dd * (seen + lit));
}

float sheenLobe(float roughness, float sine2, float NoV, float NoL) {
  float inverse = 1.0 / (roughness * roughness);
  float lobe = (2.0 + inverse) * pow(max(sine2, 1e-12), 0.5 * inverse) / (2.0 * PI);
  return meansAt(roughness).y * lobe / (4.0 * (NoL + NoV - NoL * NoV));
}

// BRDF [1/sr]; v and l in the frame (warp, weft, normal), both cosines above 0. wider: added to
// the squared width of the lobes.
vec3 brdf(Material m, Sight s, float wider, vec3 l) {
  vec3 h = normalize(s.v + l);
  float LoH = min(1.0, dot(l, h));
  // The sine from the vector product: near the normal a cosine has too few digits.
  float sine2 = dot(h.xy, h.xy);
  float lobe = !STRETCH || m.anisotropy == 0.0
    ? GGX(s.alpha.x, wider, s.v.z, l.z, sine2)
    : stretchedGGX(vec2(widened(s.alpha.x, wider), widened(s.alpha.y, wider)), s.v, l, h);
  Layers here = s.layers, there = layersAt(m, s.roughness, s.means, azimuthOf(m, l.x, l.y), l.z);
  float lost = (1.0 - here.scale - here.bias) * (1.0 - there.scale - there.bias) / (PI * (1.0 - s.means.base));
  float dielectric = 1.0 - m.metalness, f90 = F90(m.f0);
  float diffuse = dielectric * here.base * there.base / (PI * s.coupling);
  float g = 1.0 - LoH;
  g *= g * g * g * g;
  float grey = (m.f0 + (f90 - m.f0) * g) * lobe + s.means.again * lost;
  grey *= dielectric * min(here.sheen, there.sheen);
  if (COAT && m.coat > 0.0) {
    float again = here.coat_lost * there.coat_lost / (PI * (1.0 - s.means.coat));
    float top = GGX(m.coat_roughness * m.coat_roughness, wider, s.v.z, l.z, sine2);
    grey += dielectric * m.coat * ((COAT_F0 + (1.0 - COAT_F0) * g) * top + s.means.coat_again * again);
  }
  vec3 total = vec3(grey) + s.colour * diffuse;
  if (METAL && m.metalness > 0.0) {
    vec3 f = F90(s.colour);
    total += m.metalness * ((s.colour + (f - s.colour) * g) * lobe + F_multiple(s.colour, f, s.means.base) * lost);
  }
  if (SHEEN && sheenShare(m) > 0.0) {
    total += m.sheen * (dielectric * min(here.coat, there.coat) * sheenLobe(m.sheen_roughness, sine2, s.v.z, l.z));
  }
  return total;
}

// Share of a light equal from everywhere that leaves towards the view: by lobes, and by sheen and
// diffuse base.
void albedoTowards(Material m, Sight s, out vec3 specular, out vec3 diffuse) {
  Layers here = s.layers;
  float dielectric = 1.0 - m.metalness;
  float lost = 1.0 - here.scale - here.bias;
  float grey = dielectric * here.sheen * (m.f0 * here.scale + F90(m.f0) * here.bias + s.means.again * lost);
  specular = vec3(grey + dielectric * (1.0 - here.coat));
  if (METAL && m.metalness > 0.0) {
    vec3 f = F90(s.colour);
    specular += m.metalness * (s.colour * here.scale + f * here.bias + F_multiple(s.colour, f, s.means.base) * lost);
  }
  diffuse = dielectric * s.colour * here.base;
  if (SHEEN && sheenShare(m) > 0.0) {
    ivec2 size = textureSize(uAlbedos, 0);
    vec2 row = cellOf(m.sheen_roughness, ROUGHNESS_LOW, 1.0, size.y);
    float sheen = albedosAt(row, cellOf(sqrt(s.v.z), 0.0, 1.0, size.x)).b;
    diffuse += m.sheen * (dielectric * here.coat * sheen);
  }
}

// Mean over the hemisphere of what reaches the diffuse base at a roughness, by the midpoint rule.
float couplingOf(Material m, float roughness) {
  const int N = 256;
  const int TURNS = 12;
  Means means = meansOf(m, roughness);
  float total = 0.0;
  int turns = !STRETCH || m.anisotropy == 0.0 ? 1 : TURNS;
  for (int j = 0; j < N; ++j) {
    float s = (float(j) + 0.5) / float(N);
    for (int t = 0; t < turns; ++t) {
      float x = cos(0.5 * PI * (float(t) + 0.5) / float(turns));
      total += layersAt(m, roughness, means, x, s * s).base * s * s * s;
    }
  }
  return 4.0 * total / float(N * turns);
}
`;

// Materials lie in a float texture, a row each: what is drawn, tabulated and tested reads the same.
export const MATERIALS = `
uniform sampler2D uMaterials;
uniform sampler2D uCouplings;

Material materialOf(int row) {
  vec4 a = texelFetch(uMaterials, ivec2(0, row), 0), b = texelFetch(uMaterials, ivec2(1, row), 0);
  vec4 c = texelFetch(uMaterials, ivec2(2, row), 0), d = texelFetch(uMaterials, ivec2(3, row), 0);
  return Material(a.rgb, a.a, d.x, d.y, b.rgb, b.a, c.x, c.y, c.z);
}

float couplingAt(int row, float roughness) {
  vec2 at = cellOf(roughness, ROUGHNESS_LOW, 1.0, textureSize(uCouplings, 0).x);
  float low = texelFetch(uCouplings, ivec2(int(at.x), row), 0).r;
  return mix(low, texelFetch(uCouplings, ivec2(int(at.x) + 1, row), 0).r, at.y);
}
`;

// One row per material, one column per node of roughness.
export const COUPLING = `
out vec4 oMean;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  float roughness = ROUGHNESS_LOW + (1.0 - ROUGHNESS_LOW) * float(at.x) / float(textureSize(uMeans, 0).x - 1);
  oMean = vec4(couplingOf(materialOf(at.y), roughness), 0.0, 0.0, 1.0);
}
`;
