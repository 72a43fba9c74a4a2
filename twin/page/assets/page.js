"use strict";
// The part in 3D, and findings that lead to their places; in each article of its own. No network, no library; WebGL 1.
(() => {
function beginArticle(root) {
const data = JSON.parse(root.querySelector(".kerf-data").textContent);
const part = (name) => root.querySelector("." + name);

// ---- data: base64 of little-endian numbers
function bytesOf(text) {
  const raw = atob(text), bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; ++i) bytes[i] = raw.charCodeAt(i);
  return bytes;
}

// Corners of triangles, three numbers each, with normals that are smooth where the surface is.
function buildMesh(mesh) {
  const placeBytes = bytesOf(mesh.places), triangleBytes = bytesOf(mesh.triangles);
  const corners = placeBytes.length / 6, triangles = triangleBytes.length / 9;
  const groups = mesh.groups ? bytesOf(mesh.groups) : null, deviations = mesh.deviations ? bytesOf(mesh.deviations) : null;
  const places = new Float32Array(3 * corners);
  for (let i = 0; i < 3 * corners; ++i) {
    const step = placeBytes[2 * i] | placeBytes[2 * i + 1] << 8, axis = i % 3;
    places[i] = mesh.min[axis] + (mesh.max[axis] - mesh.min[axis]) * step / 65535;
  }
  const index = new Uint32Array(3 * triangles);
  for (let i = 0; i < index.length; ++i)
    index[i] = triangleBytes[3 * i] | triangleBytes[3 * i + 1] << 8 | triangleBytes[3 * i + 2] << 16;
  const faces = new Float32Array(3 * triangles), weights = new Float32Array(triangles);
  for (let t = 0; t < triangles; ++t) {
    const a = 3 * index[3 * t], b = 3 * index[3 * t + 1], c = 3 * index[3 * t + 2];
    const ux = places[b] - places[a], uy = places[b + 1] - places[a + 1], uz = places[b + 2] - places[a + 2];
    const vx = places[c] - places[a], vy = places[c + 1] - places[a + 1], vz = places[c + 2] - places[a + 2];
    const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx, l = Math.hypot(x, y, z);
    weights[t] = l;
    if (l > 0) { faces[3 * t] = x / l; faces[3 * t + 1] = y / l; faces[3 * t + 2] = z / l; }
  }
  const first = new Uint32Array(corners + 1);
  for (const corner of index) ++first[corner + 1];
  for (let i = 0; i < corners; ++i) first[i + 1] += first[i];
  const at = first.slice(0, corners), around = new Uint32Array(index.length);
  for (let i = 0; i < index.length; ++i) around[at[index[i]]++] = i / 3 | 0;
  const kSmooth = Math.cos(32 * Math.PI / 180);
  const position = new Float32Array(9 * triangles), normal = new Float32Array(9 * triangles);
  for (let i = 0; i < index.length; ++i) {
    const t = i / 3 | 0, fx = faces[3 * t], fy = faces[3 * t + 1], fz = faces[3 * t + 2], corner = index[i];
    let x = 0, y = 0, z = 0;
    for (let k = first[corner]; k < first[corner + 1]; ++k) {
      const o = around[k], ox = faces[3 * o], oy = faces[3 * o + 1], oz = faces[3 * o + 2];
      if (ox * fx + oy * fy + oz * fz < kSmooth) continue;
      x += ox * weights[o]; y += oy * weights[o]; z += oz * weights[o];
    }
    const l = Math.hypot(x, y, z) || 1;
    normal[3 * i] = x / l; normal[3 * i + 1] = y / l; normal[3 * i + 2] = z / l;
    for (let axis = 0; axis < 3; ++axis) position[3 * i + axis] = places[3 * corner + axis];
  }
  // Edges: where faces meet at more than that angle.
  const open = new Map(), edges = [];
  for (let t = 0; t < triangles; ++t) {
    for (let k = 0; k < 3; ++k) {
      const a = index[3 * t + k], b = index[3 * t + (k + 1) % 3], key = Math.min(a, b) * 16777216 + Math.max(a, b);
      const other = open.get(key);
      if (other === undefined) { open.set(key, t); continue; }
      open.delete(key);
      const turn = faces[3 * t] * faces[3 * other] + faces[3 * t + 1] * faces[3 * other + 1] + faces[3 * t + 2] * faces[3 * other + 2];
      if (turn < kSmooth) edges.push(...places.subarray(3 * a, 3 * a + 3), ...places.subarray(3 * b, 3 * b + 3));
    }
  }
  return { position, normal, groups, triangles, edges: new Float32Array(edges), deviations };
}

// ---- colours
const rgb = (text) => [1, 3, 5].map((i) => parseInt(text.slice(i, i + 2), 16));
function ramp(t) {  // blue, green, yellow, red
  const stops = [[49, 92, 171], [66, 168, 132], [238, 208, 92], [196, 60, 45]];
  const x = Math.min(2.999, Math.max(0, 3 * t)), i = Math.floor(x), f = x - i;
  return stops[i].map((v, k) => Math.round(v + (stops[i + 1][k] - v) * f));
}
const kPlain = [176, 186, 194], kUncut = [205, 209, 212];
const hex = (c) => "#" + c.map((v) => v.toString(16).padStart(2, "0")).join("");

function colorsOf(mesh, mode) {
  const colors = new Uint8Array(4 * 3 * mesh.triangles), legend = [];
  const put = (corner, c) => { colors[4 * corner] = c[0]; colors[4 * corner + 1] = c[1]; colors[4 * corner + 2] = c[2]; colors[4 * corner + 3] = 255; };
  if (mode === "tool" && mesh.groups) {
    const table = data.groups.map((g) => rgb(g.color));
    for (let t = 0; t < mesh.triangles; ++t)
      for (let k = 0; k < 3; ++k) put(3 * t + k, table[mesh.groups[t]] || kUncut);
    data.groups.forEach((g) => legend.push([g.color, g.name]));
    legend.push([hex(kUncut), data.texts.uncut]);
  } else if (mode === "deviation" && mesh.deviations) {
    const table = data.deviation.colors.map(rgb);
    for (let t = 0; t < mesh.triangles; ++t)
      for (let k = 0; k < 3; ++k) put(3 * t + k, table[mesh.deviations[t]]);
    data.deviation.colors.forEach((color, i) => legend.push([color, data.deviation.names[i]]));
  } else if (mode === "height") {
    const low = data.mesh.min[2], high = data.mesh.max[2], span = high - low || 1;
    for (let i = 0; i < 3 * mesh.triangles; ++i) put(i, ramp((mesh.position[3 * i + 2] - low) / span));
    for (let i = 0; i <= 4; ++i) legend.push([hex(ramp(i / 4)), "Z " + lengthText(low + span * i / 4)]);
  } else {
    for (let i = 0; i < 3 * mesh.triangles; ++i) put(i, kPlain);
  }
  return { colors, legend };
}
function lengthText(mm) {
  return data.inch ? (mm / 25.4).toFixed(3) + " in" : mm.toFixed(2) + " mm";
}

// ---- drawing
const kVertex = "attribute vec3 place; attribute vec3 normal; attribute vec4 color; uniform mat4 view; uniform float size; varying vec3 n, p; varying vec4 c;"
  + "void main() { n = normal; p = place; c = color; gl_Position = view * vec4(place, 1.0); gl_PointSize = size; }";
const kFragment = "precision highp float; varying vec3 n, p; varying vec4 c; uniform vec4 plane; uniform vec3 eye; uniform int kind;"
  + "void main() {"
  + " if (kind < 3 && dot(plane.xyz, p) > plane.w) discard;"
  + " if (kind == 1) { gl_FragColor = vec4(0.16, 0.19, 0.22, 1.0); return; }"
  + " if (kind == 2) { gl_FragColor = c; return; }"
  + " if (kind == 3) { vec2 d = gl_PointCoord - 0.5; float r = length(d); if (r > 0.5) discard; gl_FragColor = r > 0.36 ? vec4(1.0) : c; return; }"
  + " if (kind == 4) { gl_FragColor = c; return; }"
  + " if (!gl_FrontFacing) { gl_FragColor = vec4(0.78, 0.55, 0.42, 1.0); return; }"
  + " vec3 m = normalize(n); float light = 0.42 + 0.5 * max(0.0, dot(m, eye)) + 0.16 * max(0.0, dot(m, normalize(vec3(-0.4, -0.6, 0.9))));"
  + " gl_FragColor = vec4(c.rgb * light, 1.0); }";

function makeView(canvas) {
  const made = startDrawing(canvas, kVertex, kFragment, true);
  if (!made) return null;
  const { gl, attribute, uniform } = made;
  const aPlace = attribute("place"), aNormal = attribute("normal"), aColor = attribute("color");
  const uView = uniform("view"), uPlane = uniform("plane"), uEye = uniform("eye"), uKind = uniform("kind"), uSize = uniform("size");
  const buffer = (values) => { const b = gl.createBuffer(); gl.bindBuffer(gl.ARRAY_BUFFER, b); gl.bufferData(gl.ARRAY_BUFFER, values, gl.STATIC_DRAW); return b; };

  const mesh = buildMesh(data.mesh);
  const places = buffer(mesh.position), normals = buffer(mesh.normal), edges = buffer(mesh.edges);
  let colors = null;
  const box = data.box, lines = [], lineColors = [];
  const line = (a, b, c) => { lines.push(...a, ...b); lineColors.push(...c, 255, ...c, 255); };
  for (let axis = 0; axis < 3; ++axis) {
    const u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (let k = 0; k < 4; ++k) {
      const a = [0, 0, 0];
      a[u] = box[k & 1][u]; a[v] = box[k >> 1][v];
      const b = a.slice();
      a[axis] = box[0][axis]; b[axis] = box[1][axis];
      line(a, b, [120, 130, 140]);
    }
  }
  const span = Math.hypot(...[0, 1, 2].map((i) => Math.max(box[1][i], data.mesh.max[i]) - Math.min(box[0][i], data.mesh.min[i]))) || 1;
  const arm = 0.12 * span;
  [[200, 50, 40], [40, 140, 60], [50, 90, 200]].forEach((c, axis) => { const tip = [0, 0, 0]; tip[axis] = arm; line([0, 0, 0], tip, c); });
  const lineBuffer = buffer(new Float32Array(lines)), lineColorBuffer = buffer(new Uint8Array(lineColors));
  const severityColor = { error: [179, 38, 30], warning: [214, 130, 10], note: [47, 102, 144] };
  const marked = data.findings.map((f, i) => [f, i]).filter(([f]) => f.place);
  const markPlaces = buffer(new Float32Array(marked.flatMap(([f]) => f.place)));
  const markColors = buffer(new Uint8Array(marked.flatMap(([f]) => [...severityColor[f.severity], 255])));

  const middle = [0, 1, 2].map((i) => (box[0][i] + box[1][i]) / 2);
  const state = { yaw: 0.62, pitch: 0.6, zoom: 1, span, target: middle.slice(), axis: -1, share: 0.5, chosen: -1, spot: null };

  const rows = () => eyeRows(state, data.lathe);
  const matrix = (width, height) => eyeMatrix(state, rows(), width, height, 4);
  const bind = (location, b, size, type, normalized) => {
    if (location < 0) return;
    gl.bindBuffer(gl.ARRAY_BUFFER, b);
    gl.enableVertexAttribArray(location);
    gl.vertexAttribPointer(location, size, type, normalized, 0, 0);
  };
  function draw(width = canvas.width, height = canvas.height) {
    const low = [0, 1, 2].map((i) => Math.min(box[0][i], data.mesh.min[i])), high = [0, 1, 2].map((i) => Math.max(box[1][i], data.mesh.max[i]));
    const eye = rows()[2], plane = [0, 0, 0, 1e9];
    if (state.axis >= 0) {
      // What is nearer to the eye is cut away.
      const sign = eye[state.axis] >= 0 ? 1 : -1;
      plane[state.axis] = sign;
      plane[3] = sign * (low[state.axis] + (high[state.axis] - low[state.axis]) * state.share);
    }
    gl.viewport(0, 0, width, height);
    gl.clearColor(0.914, 0.929, 0.941, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.uniformMatrix4fv(uView, false, matrix(width, height));
    gl.uniform4fv(uPlane, plane);
    gl.uniform3fv(uEye, eye);
    gl.uniform1f(uSize, 1);
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(1, 1);
    gl.uniform1i(uKind, 0);
    bind(aPlace, places, 3, gl.FLOAT, false);
    bind(aNormal, normals, 3, gl.FLOAT, false);
    bind(aColor, colors, 4, gl.UNSIGNED_BYTE, true);
    gl.drawArrays(gl.TRIANGLES, 0, 3 * mesh.triangles);
    gl.disable(gl.POLYGON_OFFSET_FILL);
    if (aNormal >= 0) gl.disableVertexAttribArray(aNormal);
    if (aColor >= 0) gl.disableVertexAttribArray(aColor);
    gl.uniform1i(uKind, 1);
    bind(aPlace, edges, 3, gl.FLOAT, false);
    gl.drawArrays(gl.LINES, 0, mesh.edges.length / 3);
    gl.uniform1i(uKind, 4);
    bind(aPlace, lineBuffer, 3, gl.FLOAT, false);
    bind(aColor, lineColorBuffer, 4, gl.UNSIGNED_BYTE, true);
    gl.drawArrays(gl.LINES, 0, lines.length / 3);
    if (marked.length) {
      gl.disable(gl.DEPTH_TEST);
      gl.uniform1i(uKind, 3);
      bind(aPlace, markPlaces, 3, gl.FLOAT, false);
      bind(aColor, markColors, 4, gl.UNSIGNED_BYTE, true);
      gl.uniform1f(uSize, 9 * (window.devicePixelRatio || 1));
      gl.drawArrays(gl.POINTS, 0, marked.length);
      const chosen = marked.findIndex(([, i]) => i === state.chosen);
      if (chosen >= 0) {
        gl.uniform1f(uSize, 20 * (window.devicePixelRatio || 1));
        gl.drawArrays(gl.POINTS, chosen, 1);
      }
    }
    if (state.spot) drawSpot();
  }
  // Where a table or a curve has led.
  const spotPlace = gl.createBuffer(), spotColor = buffer(new Uint8Array([150, 30, 160, 255]));
  function drawSpot() {
    gl.disable(gl.DEPTH_TEST);
    gl.uniform1i(uKind, 3);
    gl.bindBuffer(gl.ARRAY_BUFFER, spotPlace);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(state.spot), gl.DYNAMIC_DRAW);
    bind(aPlace, spotPlace, 3, gl.FLOAT, false);
    bind(aColor, spotColor, 4, gl.UNSIGNED_BYTE, true);
    gl.uniform1f(uSize, 16 * (window.devicePixelRatio || 1));
    gl.drawArrays(gl.POINTS, 0, 1);
  }
  let due = false;
  function redraw() {
    if (due) return;
    due = true;
    requestAnimationFrame(() => { due = false; fitCanvas(canvas); draw(); });
  }
  const self = {
    state, redraw,
    look(name) { [state.yaw, state.pitch] = kViews[name]; redraw(); },
    reset() { state.target = middle.slice(); state.zoom = 1; self.look("iso"); },
    color(mode) {
      const made = colorsOf(mesh, mode);
      if (colors) gl.deleteBuffer(colors);
      colors = buffer(made.colors);
      part("legend").replaceChildren(...made.legend.map(([color, name]) => {
        const item = document.createElement("span"), patch = document.createElement("i");
        patch.style.background = color;
        item.append(patch, name);
        return item;
      }));
      redraw();
    },
    goTo(place) { state.target = place.slice(); state.zoom = Math.max(state.zoom, 3); redraw(); },
    picture(name, width, height) {
      const kept = { ...state, target: state.target.slice() };
      Object.assign(state, { zoom: 1, target: middle.slice(), axis: -1, chosen: -1, spot: null });
      [state.yaw, state.pitch] = kViews[name];
      canvas.width = width; canvas.height = height;
      draw(width, height);
      const url = canvas.toDataURL("image/png");
      Object.assign(state, kept);
      redraw();
      return url;
    },
    // Number of the finding whose mark is there, or -1. CSS pixels.
    markAt(x, y) {
      const m = matrix(canvas.width, canvas.height);
      let best = -1, nearest = 12;
      for (const [f, i] of marked) {
        const [px, py, pz] = f.place, sx = m[0] * px + m[4] * py + m[8] * pz + m[12], sy = m[1] * px + m[5] * py + m[9] * pz + m[13];
        const d = Math.hypot((sx + 1) / 2 * canvas.clientWidth - x, (1 - sy) / 2 * canvas.clientHeight - y);
        if (d < nearest) { nearest = d; best = i; }
      }
      return best;
    },
    drag(dx, dy, pans) { dragEye(state, data.lathe, canvas, dx, dy, pans); redraw(); },
    zoom(factor) { zoomEye(state, factor); redraw(); },
  };
  canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
  window.addEventListener("resize", redraw);
  return self;
}

// ---- findings
let view = null;
function showPlace(file, line, place) {
  const program = part("program");
  program.replaceChildren();
  const source = line > 0 && data.sources[file];
  if (source) {
    program.append(file + ":" + line + "\n");
    for (let n = Math.max(1, line - 4); n <= line + 4; ++n) {
      if (source[n] === undefined) continue;
      const row = document.createElement("span");
      if (n === line) row.className = "at";
      row.textContent = String(n).padStart(6) + "  " + source[n] + (n === line ? "" : "\n");
      program.append(row);
    }
  }
  if (!view) return;
  if (place) view.goTo(place); else view.redraw();
}
function choose(number) {
  const finding = data.findings[number];
  root.querySelectorAll(".findings button").forEach((b, i) => b.setAttribute("aria-current", String(i === number)));
  const button = root.querySelectorAll(".findings button")[number];
  if (button) button.scrollIntoView({ block: "nearest" });
  if (view) { view.state.chosen = number; view.state.spot = null; }
  showPlace(finding.file, finding.line, finding.place);
}
// A line of a table, a column of a curve: [file, line, place].
function chooseSpot([file, line, place]) {
  root.querySelectorAll(".findings button").forEach((b) => b.setAttribute("aria-current", "false"));
  if (view) { view.state.chosen = -1; view.state.spot = place; }
  showPlace(data.files[file], line, place);
}
// ---- curves: a column is where the mouse is in the picture's own units
function columnAt(svg, event) {
  const box = svg.getBoundingClientRect(), edge = 8, width = svg.viewBox.baseVal.width;
  const share = ((event.clientX - box.left) / box.width * width - edge) / (width - 2 * edge), count = Number(svg.dataset.columns);
  return Math.min(count - 1, Math.max(0, Math.floor(share * count)));
}
function showPart() { (part("split") || part("program")).scrollIntoView({ block: "nearest" }); }
function beginCurves() {
  const curves = [...root.querySelectorAll("svg.curve")];
  for (const svg of curves) {
    if (data.columns.length !== Number(svg.dataset.columns)) continue;
    svg.classList.add("leads");
    svg.addEventListener("click", (event) => {
      const column = columnAt(svg, event), spot = data.columns[column];
      const x = 8 + (column + 0.5) * (svg.viewBox.baseVal.width - 16) / data.columns.length;
      curves.forEach((other) => other.querySelector(".now").setAttribute("d", `M${x.toFixed(1)} 20V90`));
      if (spot[1] > 0) { chooseSpot(spot); showPart(); }
    });
  }
}

function begin() {
  root.querySelectorAll(".findings button").forEach((button, i) => button.addEventListener("click", () => choose(i)));
  root.querySelectorAll(".spot").forEach((button) => button.addEventListener("click", () => {
    chooseSpot(data.spots[Number(button.dataset.spot)]);
    showPart();
  }));
  beginCurves();
  if (!data.mesh) return;
  const canvas = document.createElement("canvas"), holder = part("view");
  canvas.tabIndex = 0;
  canvas.setAttribute("aria-label", data.texts.view);
  holder.append(canvas);
  try { view = makeView(canvas); } catch (error) { console.error(error); view = null; }
  if (!view) {
    canvas.remove();
    const none = document.createElement("p");
    none.className = "none";
    none.textContent = data.texts.none;
    holder.append(none);
    return;
  }
  holder.querySelectorAll(".none").forEach((n) => n.remove());
  listenToHand(canvas, view, (x, y) => {
    const number = view.markAt(x, y);
    if (number >= 0) choose(number);
  });
  for (const button of root.querySelectorAll("[data-look]"))
    button.addEventListener("click", () => button.dataset.look === "reset" ? view.reset() : view.look(button.dataset.look));
  const colors = part("color");
  colors.addEventListener("change", () => view.color(colors.value));
  const axis = part("section"), share = part("share");
  const cut = () => { view.state.axis = Number(axis.value); view.state.share = Number(share.value) / 1000; share.disabled = view.state.axis < 0; view.redraw(); };
  axis.addEventListener("change", cut);
  share.addEventListener("input", cut);
  view.color(colors.value);
  root.querySelectorAll(".sheet img").forEach((image) => { image.src = view.picture(image.dataset.view, 960, 720); });
  root.dataset.drawn = "yes";
}
begin();
}
document.querySelectorAll("article").forEach(beginArticle);
if (!document.querySelector("article:not([data-drawn])")) document.body.dataset.drawn = "yes";
})();
