// The loaded pair over its mesh cycle, by WebGL 2 alone. The numbers are those of turning.py.
const STOPS = [[68, 1, 84], [72, 40, 120], [62, 74, 137], [49, 104, 142], [38, 130, 142], [31, 158, 137], [53, 183, 121], [110, 206, 88], [181, 222, 43], [253, 231, 37]];
const ROW = 1024;  // values in a row of a texture
const LINE = 0.05, HEIGHT = 3.0;  // half the width of a drawn line of contact, and the height of the largest load [modules]

const PLACE = `#version 300 es
  precision highp float; precision highp int; precision highp usampler2D;
  uniform usampler2D values; uniform int start; uniform vec3 centre, focus, moved; uniform vec2 size; uniform float angle, top;
  uniform mat3 eye; uniform bool stressed;
  in vec3 at, outward; in float value;
  out float shown; out vec3 normal;
  vec3 turned(vec3 p, float a) { return vec3(cos(a) * p.x - sin(a) * p.y, sin(a) * p.x + cos(a) * p.y, p.z); }
  void main() {
    int i = start + int(value);
    uvec4 held = texelFetch(values, ivec2(i % ${ROW}, i / ${ROW}), 0);
    vec3 shift = (vec3(held.xyz) - 2047.0) / 2047.0;
    shown = stressed ? float(held.w) / 4095.0 * top : length(shift) * top;
    vec3 seen = eye * (turned(at + moved * shift, angle) + centre - focus);
    normal = eye * turned(outward, angle);
    gl_Position = vec4(seen.xy / size, -seen.z / (40.0 * size.y), 1.0);
  }`;
const COLOUR = `#version 300 es
  precision highp float;
  uniform vec3 stops[${STOPS.length}]; uniform float alpha;
  in float shown; in vec3 normal; out vec4 colour;
  void main() {
    float place = clamp(shown, 0.0, 1.0) * ${STOPS.length - 1}.0;
    int low = min(int(place), ${STOPS.length - 2});
    vec3 bare = mix(stops[low], stops[low + 1], place - float(low)) / 255.0;
    float light = max(0.0, dot(normalize(normal), vec3(0.33, 0.55, 0.77)));
    colour = vec4((bare * (0.62 + 0.38 * light) + 0.12 * light * light) * alpha, alpha);
  }`;
const LOAD = `#version 300 es
  precision highp float;
  uniform mat3 eye; uniform vec3 focus; uniform vec2 size; in vec3 at;
  void main() { vec3 seen = eye * (at - focus); gl_Position = vec4(seen.xy / size, 0.0, 1.0); }`;
const INK = `#version 300 es
  precision highp float; uniform vec4 ink; out vec4 colour;
  void main() { colour = vec4(ink.rgb * ink.a, ink.a); }`;

async function unpacked(text) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  const halves = new Uint8Array(await new Response(stream).arrayBuffer()), count = halves.length / 2;
  return Uint16Array.from({ length: count }, (_, i) => halves[i] | (halves[count + i] << 8));
}

/** Surfaces, values of every tooth of every position, and loads, from the numbers in their order. */
function read(head, numbers) {
  let next = 0;
  const take = (count) => numbers.subarray(next, next += count);
  const gears = head.gears.map((gear) => {
    const points = Float32Array.from(take(3 * gear.points), (n, i) => gear.low[i % 3] + n / 65535 * (gear.high[i % 3] - gear.low[i % 3]));
    const triangles = take(3 * gear.triangles), value = take(gear.points), n = gear.values;
    const teeth = gear.angles.reduce((sum, one) => sum + one.length, 0), values = new Uint16Array(4 * ROW * Math.ceil(teeth * n / ROW));
    let before = {}, row = 0;
    const starts = gear.angles.map((angles, frame) => {
      const known = {}, start = row;
      angles.forEach((_, k) => {
        const tooth = gear.first[frame] + k, old = before[tooth], at = row++ * n;
        const shift = take(3 * n), stress = head.stress ? take(n) : null;
        for (let i = 0; i < n; i++) for (let j = 0; j < 4; j++) {
          const change = j < 3 ? shift[3 * i + j] : stress ? stress[i] : 0;
          values[4 * (at + i) + j] = change + (old === undefined ? 0 : values[4 * (old + i) + j]);
        }
        known[tooth] = at;
      });
      before = known;
      return start * n;
    });
    return { ...gear, each: n, points, triangles, value, values, starts };
  });
  const all = head.loads.counts.reduce((sum, one) => sum + one, 0);
  const scaled = (count, size) => Float32Array.from(take(count), (n) => (n - 32767) / 32767 * size);
  const loads = { ends: scaled(6 * all, head.loads.ends), moved: scaled(6 * all, head.loads.moved), load: scaled(3 * all, head.loads.load) };
  return { head, gears, loads };
}

const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => { const size = Math.hypot(...a) || 1; return a.map((x) => x / size); };

/** Corners of all triangles with place, outward direction (even over gentle edges) and number of the value. */
function corners(gear) {
  const at = (i) => gear.points.subarray(3 * i, 3 * i + 3), own = [], around = {};
  for (let t = 0; t < gear.triangles.length; t += 3) {
    const [a, b, c] = gear.triangles.subarray(t, t + 3), direction = cross(minus(at(b), at(a)), minus(at(c), at(a)));
    own.push({ corners: [a, b, c], direction, flat: unit(direction) });
    for (const i of [a, b, c]) (around[i] ||= []).push(own.length - 1);
  }
  const found = [];
  for (const { corners: three, flat } of own) for (const i of three) {
    const sum = [0, 0, 0];
    for (const k of around[i]) if (flat[0] * own[k].flat[0] + flat[1] * own[k].flat[1] + flat[2] * own[k].flat[2] > 0.8)
      own[k].direction.forEach((x, j) => { sum[j] += x; });
    found.push(...at(i), ...unit(sum), gear.value[i]);
  }
  return new Float32Array(found);
}

function program(gl, vertex, fragment) {
  const made = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text.trim()); gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(made));
  return made;
}

/** Draws a pair; the function that is returned draws a view of a position. */
function drawing(gl, pair) {
  const { head } = pair, surface = program(gl, PLACE, COLOUR), line = program(gl, LOAD, INK);
  const place = (of, name) => gl.getUniformLocation(of, name);
  const gears = pair.gears.map((gear, index) => {
    const array = gl.createVertexArray(), texture = gl.createTexture(), data = corners(gear);
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
    [["at", 3, 0], ["outward", 3, 12], ["value", 1, 24]].forEach(([name, size, offset]) => {
      const to = gl.getAttribLocation(surface, name);
      gl.enableVertexAttribArray(to); gl.vertexAttribPointer(to, size, gl.FLOAT, false, 28, offset);
    });
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA16UI, ROW, gear.values.length / (4 * ROW), 0, gl.RGBA_INTEGER, gl.UNSIGNED_SHORT, gear.values);
    return { ...gear, array, texture, count: data.length / 7, centre: index ? [...head.centre, 0] : [0, 0, 0] };
  });
  const array = gl.createVertexArray(), buffer = gl.createBuffer(), end = head.ticks[head.ticks.length - 1] / head.factor;
  gl.bindVertexArray(array);
  gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
  gl.enableVertexAttribArray(gl.getAttribLocation(line, "at"));
  gl.vertexAttribPointer(gl.getAttribLocation(line, "at"), 3, gl.FLOAT, false, 0, 0);

  /** Areas of the loads along their forces, then ribbons along and across them at the contacts. */
  function load(frame, scale) {
    const before = head.loads.counts.slice(0, frame).reduce((sum, one) => sum + one, 0), areas = [], ribbons = [];
    const quad = (to, a, b, c, d) => to.push(...a, ...b, ...c, ...a, ...c, ...d);
    const plus = (a, b, times) => a.map((x, j) => x + times * b[j]);
    for (let i = before; i < before + head.loads.counts[frame]; i++) {
      const [a, b] = [0, 3].map((k) => plus([...pair.loads.ends.subarray(6 * i + k, 6 * i + k + 3)], pair.loads.moved.subarray(6 * i + k, 6 * i + k + 3), scale));
      const force = [...pair.loads.load.subarray(3 * i, 3 * i + 3)], high = HEIGHT * head.module / head.loads.largest;
      quad(areas, a, b, plus(b, force, high), plus(a, force, high));
      for (const way of [unit(force), unit(cross(force, minus(b, a)))]) {
        const half = LINE * head.module;
        quad(ribbons, plus(a, way, -half), plus(b, way, -half), plus(b, way, half), plus(a, way, half));
      }
    }
    return [areas, ribbons];
  }

  return ({ frame, scale, eye, size, glass, ink }) => {
    gl.viewport(0, 0, gl.canvas.width, gl.canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST); gl.enable(gl.CULL_FACE); gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    const focus = [...head.focus, 0], surfaces = (index) => {
      const gear = gears[index], alpha = index && glass ? 0.22 : 1;
      gl.useProgram(surface);
      gl.uniformMatrix3fv(place(surface, "eye"), false, eye);
      gl.uniform3fv(place(surface, "stops"), STOPS.flat());
      gl.uniform3fv(place(surface, "focus"), focus);
      gl.uniform2fv(place(surface, "size"), size);
      gl.uniform3fv(place(surface, "centre"), gear.centre);
      gl.uniform3fv(place(surface, "moved"), [1, 1, 1].map((x) => x * scale * head.moved));
      gl.uniform1f(place(surface, "top"), (head.stress || head.moved) / end);
      gl.uniform1i(place(surface, "stressed"), head.stress ? 1 : 0);
      gl.uniform1f(place(surface, "alpha"), alpha);
      gl.bindTexture(gl.TEXTURE_2D, gear.texture);
      gl.bindVertexArray(gear.array);
      gl.depthMask(alpha === 1);
      gear.angles[frame].forEach((angle, k) => {
        gl.uniform1f(place(surface, "angle"), angle + (index ? 0 : scale * head.ahead[frame]));
        gl.uniform1i(place(surface, "start"), gear.starts[frame] + k * gear.each);
        gl.drawArrays(gl.TRIANGLES, 0, gear.count);
      });
      gl.depthMask(true);
    };
    surfaces(0); surfaces(1);
    gl.disable(gl.DEPTH_TEST); gl.disable(gl.CULL_FACE);
    gl.useProgram(line);
    gl.uniformMatrix3fv(place(line, "eye"), false, eye);
    gl.uniform3fv(place(line, "focus"), focus);
    gl.uniform2fv(place(line, "size"), size);
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    load(frame, scale).forEach((triangles, k) => {
      gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(triangles), gl.DYNAMIC_DRAW);
      gl.uniform4fv(place(line, "ink"), [...ink, k ? 1 : 0.4]);
      gl.drawArrays(gl.TRIANGLES, 0, triangles.length / 3);
    });
  };
}
