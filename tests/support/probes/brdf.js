// Values of the viewer's BRDF at given directions, read from a picture of floats.

import { ALL, BRDF, MATERIALS, termsOf } from "./drawing/glsl_brdf.js";
import { MaterialTable, tablesOf } from "./drawing/materials.js";
import { WHOLE, bind, fill, floatTable, programOf, targetOf, use } from "./drawing/gl.js";
import { arraysOf } from "./drawing/payload.js";

const FRAGMENT = `${termsOf(ALL)}${BRDF}${MATERIALS}
uniform sampler2D uSight;
uniform sampler2D uLight;
out vec4 oValue;

void main() {
  vec4 sight = texelFetch(uSight, ivec2(gl_FragCoord.xy), 0), light = texelFetch(uLight, ivec2(gl_FragCoord.xy), 0);
  int row = int(light.w);
  Material m = materialOf(row);
  Sight s = sightOf(m, m.roughness, m.albedo, couplingAt(row, m.roughness), sight.xyz);
  oValue = vec4(brdf(m, s, sight.w, light.xyz), couplingAt(row, m.roughness));
}
`;

async function probe() {
  const content = JSON.parse(document.getElementById("content").textContent);
  const array = await arraysOf(content.buffers);
  const gl = document.createElement("canvas").getContext("webgl2");
  gl.getExtension("EXT_color_buffer_float");
  const table = new MaterialTable(gl, tablesOf(gl, array, true));
  table.fill(content.materials);
  const program = programOf(gl, WHOLE, FRAGMENT);
  const side = content.side;
  const target = targetOf(gl, side, side, gl.RGBA32F, false);
  gl.viewport(0, 0, side, side);
  use(gl, program, {});
  bind(gl, program, {
    ...table.textures, uSight: floatTable(gl, side, side, 4, array("sight")), uLight: floatTable(gl, side, side, 4, array("light")),
  });
  gl.bindFramebuffer(gl.FRAMEBUFFER, target.frame);
  fill(gl);
  const values = new Float32Array(4 * side * side);
  gl.readPixels(0, 0, side, side, gl.RGBA, gl.FLOAT, values);
  return Array.from(values);
}

window.probed = probe();
