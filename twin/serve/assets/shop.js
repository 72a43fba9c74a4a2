"use strict";
// The page for the shop: asks /scene for what is new, shows it. No library, no cookies; WebGL 1.
(() => {
const texts = JSON.parse(document.getElementById("texts").textContent);
const by = (id) => document.getElementById(id);
const fill = (text, value) => text.replace("{}", value);

// ---- what is known
const seen = { epoch: 0, version: 0, mesh: 0, findings: 0 };
let setup = {}, state = null, received = 0, isWhole = false, hasBeenWhole = false, failures = 0;
let token = decodeURIComponent(location.hash.slice(1));

// ---- drawing
const kVertex = "attribute vec3 place; attribute vec3 normal; attribute float cut; uniform mat4 view; uniform vec3 low, size;"
  + "varying vec3 n; varying float c; void main() { n = normal; c = cut; gl_Position = view * vec4(low + size * place, 1.0); }";
const kFragment = "precision highp float; varying vec3 n; varying float c; uniform vec3 eye, sun; uniform vec4 color; uniform bool lit;"
  + "void main() { if (!lit) { gl_FragColor = color; return; }"
  + " vec3 m = normalize(n); float light = 0.36 + 0.34 * max(0.0, dot(m, eye)) + 0.38 * max(0.0, dot(m, sun));"
  + " gl_FragColor = vec4(mix(color.rgb, vec3(0.55, 0.66, 0.74), 0.6 * c) * light, color.a); }";
const kPart = [0.72, 0.75, 0.78, 1], kTool = { cutter: [0.93, 0.55, 0.2, 1], shank: [0.6, 0.63, 0.66, 1],
  holder: [0.4, 0.44, 0.48, 1], spindle: [0.3, 0.33, 0.37, 0.9] };

function makeView(canvas) {
  // Smooth edges take four times the work: not where the processor has to do it, beside a machine perhaps.
  const made = startDrawing(canvas, kVertex, kFragment, hasGraphicsCard());
  if (!made || !made.gl.getExtension("OES_element_index_uint")) return null;
  const { gl, attribute, uniform } = made;
  const [aPlace, aNormal, aCut] = ["place", "normal", "cut"].map(attribute);
  const [uView, uLow, uSize, uEye, uSun, uColor, uLit] = ["view", "low", "size", "eye", "sun", "color", "lit"].map(uniform);
  for (const place of [aPlace, aNormal, aCut]) gl.enableVertexAttribArray(place);
  gl.enable(gl.DEPTH_TEST);
  const tiles = new Map();
  let tool = [], lines = null, lineCount = 0;
  const camera = { yaw: 0.62, pitch: 0.6, zoom: 1, target: [0, 0, 0], span: 1 };

  // Corners as packed_patch.h has them, 10 bytes each.
  function upload(corners, indices, isWide, low, size) {
    const made = { corners: gl.createBuffer(), indices: gl.createBuffer(), low, size,
      type: isWide ? gl.UNSIGNED_INT : gl.UNSIGNED_SHORT, count: indices.byteLength / (isWide ? 4 : 2) };
    gl.bindBuffer(gl.ARRAY_BUFFER, made.corners);
    gl.bufferData(gl.ARRAY_BUFFER, corners, gl.STATIC_DRAW);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, made.indices);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.STATIC_DRAW);
    return made;
  }
  function drop(made) { gl.deleteBuffer(made.corners); gl.deleteBuffer(made.indices); }
  function paint(made, color) {
    gl.bindBuffer(gl.ARRAY_BUFFER, made.corners);
    gl.vertexAttribPointer(aPlace, 3, gl.UNSIGNED_SHORT, true, 10, 0);
    gl.vertexAttribPointer(aNormal, 3, gl.BYTE, true, 10, 6);
    gl.vertexAttribPointer(aCut, 1, gl.UNSIGNED_BYTE, false, 10, 9);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, made.indices);
    gl.uniform3fv(uLow, made.low);
    gl.uniform3fv(uSize, made.size);
    gl.uniform4fv(uColor, color);
    gl.drawElements(gl.TRIANGLES, made.count, made.type, 0);
  }
  // Columns of the tool's frame; z is its axis.
  function moved(m, axis, tip) {
    const z = axis, side = Math.abs(z[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0];
    const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let y = cross(z, side);
    const l = Math.hypot(...y) || 1;
    y = y.map((v) => v / l);
    const x = cross(y, z), out = [];
    for (const column of [x, y, z]) for (let r = 0; r < 4; ++r) out.push(m[r] * column[0] + m[4 + r] * column[1] + m[8 + r] * column[2]);
    for (let r = 0; r < 4; ++r) out.push(m[r] * tip[0] + m[4 + r] * tip[1] + m[8 + r] * tip[2] + m[12 + r]);
    return [out, [x, y, z]];
  }
  function draw() {
    const [width, height] = fitCanvas(canvas);
    gl.viewport(0, 0, width, height);
    gl.clearColor(0.914, 0.929, 0.941, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const rows = eyeRows(camera, setup.turns), eye = rows[2], m = eyeMatrix(camera, rows, width, height, 8);
    // From above and the left of who looks, so that faces differ from every side.
    const sun = [0, 1, 2].map((i) => -0.45 * rows[0][i] + 0.75 * rows[1][i] + 0.5 * rows[2][i]);
    gl.uniformMatrix4fv(uView, false, m);
    gl.uniform3fv(uEye, eye);
    gl.uniform3fv(uSun, sun);
    gl.uniform1i(uLit, 1);
    for (const tile of tiles.values()) if (tile.count) paint(tile, kPart);
    if (lines) {
      gl.uniform1i(uLit, 0);
      gl.bindBuffer(gl.ARRAY_BUFFER, lines);
      gl.vertexAttribPointer(aPlace, 3, gl.FLOAT, false, 12, 0);
      gl.disableVertexAttribArray(aNormal);
      gl.disableVertexAttribArray(aCut);
      gl.uniform3f(uLow, 0, 0, 0);
      gl.uniform3f(uSize, 1, 1, 1);
      gl.uniform4f(uColor, 0.47, 0.51, 0.55, 1);
      gl.drawArrays(gl.LINES, 0, lineCount);
      gl.enableVertexAttribArray(aNormal);
      gl.enableVertexAttribArray(aCut);
    }
    if (tool.length && state && state.tip_mm) {
      const [own, axes] = moved(m, state.axis || [0, 0, 1], state.tip_mm);
      gl.uniform1i(uLit, 1);
      gl.uniformMatrix4fv(uView, false, own);
      gl.uniform3fv(uEye, axes.map((axis) => dotOf(axis, eye)));
      gl.uniform3fv(uSun, axes.map((axis) => dotOf(axis, sun)));
      for (const piece of tool) paint(piece.mesh, piece.color);
    }
  }
  let due = false;
  const waiting = [];
  function redraw(then) {
    if (then) waiting.push(then);
    if (due) return;
    due = true;
    requestAnimationFrame(() => { due = false; draw(); for (const call of waiting.splice(0)) call(); });
  }
  // A surface of revolution, or a plate between two planes, as corners and triangles in floats.
  function packFloats(places, normals, indices) {
    const low = [0, 1, 2].map((i) => Math.min(...places.map((p) => p[i]))), high = [0, 1, 2].map((i) => Math.max(...places.map((p) => p[i])));
    const size = low.map((v, i) => high[i] - v), bytes = new DataView(new ArrayBuffer(10 * places.length));
    places.forEach((p, k) => {
      for (let i = 0; i < 3; ++i) {
        bytes.setUint16(10 * k + 2 * i, size[i] > 0 ? Math.round((p[i] - low[i]) / size[i] * 65535) : 0, true);
        bytes.setInt8(10 * k + 6 + i, Math.round(127 * normals[k][i]));
      }
    });
    return upload(new Uint8Array(bytes.buffer), new Uint8Array(new Uint16Array(indices).buffer), false, low, size);
  }
  function turned(profile) {
    const places = [], normals = [], indices = [], kSides = 32;
    const outline = [[0, profile[0][1]], ...profile, [0, profile[profile.length - 1][1]]];
    for (let k = 0; k + 1 < outline.length; ++k) {
      const [r0, z0] = outline[k], [r1, z1] = outline[k + 1], l = Math.hypot(r1 - r0, z1 - z0);
      if (l < 1e-6) continue;
      const nr = (z1 - z0) / l, nz = (r0 - r1) / l, first = places.length;
      for (let s = 0; s <= kSides; ++s) {
        const c = Math.cos(2 * Math.PI * s / kSides), d = Math.sin(2 * Math.PI * s / kSides);
        places.push([r0 * c, r0 * d, z0], [r1 * c, r1 * d, z1]);
        normals.push([nr * c, nr * d, nz], [nr * c, nr * d, nz]);
        if (s < kSides) { const a = first + 2 * s; indices.push(a, a + 2, a + 1, a + 1, a + 2, a + 3); }
      }
    }
    return packFloats(places, normals, indices);
  }
  function flat(plate) {
    const places = [], normals = [], indices = [];
    for (const [y, n] of [[plate.low, -1], [plate.high, 1]]) {
      const first = places.length;
      for (const [z, x] of plate.corners) { places.push([x, y, z]); normals.push([0, n, 0]); }
      for (let k = 2; k < plate.corners.length; ++k) indices.push(first, first + k - 1, first + k);
    }
    return packFloats(places, normals, indices);
  }
  return {
    camera, redraw,
    clear() { for (const tile of tiles.values()) drop(tile); tiles.clear(); },
    // bytes: a Uint8Array of patches, one behind the other.
    take(bytes) {
      const data = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
      for (let at = 0; at < bytes.byteLength;) {
        const id = data.getUint32(at, true), corners = data.getUint32(at + 4, true), indices = data.getUint32(at + 8, true);
        const low = [0, 1, 2].map((i) => data.getFloat32(at + 12 + 4 * i, true)), size = [0, 1, 2].map((i) => data.getFloat32(at + 24 + 4 * i, true));
        const isWide = corners > 65536, first = at + 36, middle = first + 10 * corners, end = middle + indices * (isWide ? 4 : 2);
        if (tiles.has(id)) drop(tiles.get(id));
        tiles.set(id, upload(bytes.subarray(first, middle), bytes.subarray(middle, end), isWide, low, size));
        at = end + (4 - end % 4) % 4;
      }
    },
    setUp(box) {
      const list = [];
      for (let axis = 0; axis < 3; ++axis) for (let k = 0; k < 4; ++k) {
        const u = (axis + 1) % 3, v = (axis + 2) % 3, a = [0, 0, 0];
        a[u] = box[k & 1][u]; a[v] = box[k >> 1][v];
        const b = a.slice();
        a[axis] = box[0][axis]; b[axis] = box[1][axis];
        list.push(...a, ...b);
      }
      if (!lines) lines = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, lines);
      gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(list), gl.STATIC_DRAW);
      lineCount = list.length / 3;
      const span = Math.hypot(...box[0].map((v, i) => box[1][i] - v)) || 1;
      if (span !== camera.span) { camera.span = span; this.reset(box); }
    },
    setTool(shape) {
      for (const piece of tool) drop(piece.mesh);
      tool = [];
      for (const kind of ["cutter", "shank", "holder", "spindle"])
        if (shape && shape[kind] && shape[kind].length) tool.push({ mesh: turned(shape[kind]), color: kTool[kind] });
      for (const plate of (shape && shape.plates) || [])
        if (plate.corners.length > 2) tool.push({ mesh: flat(plate), color: plate.is_holder ? kTool.holder : kTool.cutter });
    },
    reset(box) { camera.target = box[0].map((v, i) => (v + box[1][i]) / 2); camera.zoom = 1; this.look("iso"); },
    look(name) { [camera.yaw, camera.pitch] = kViews[name]; redraw(); },
    drag(dx, dy, pans) { dragEye(camera, setup.turns, canvas, dx, dy, pans); redraw(); },
    zoom(factor) { zoomEye(camera, factor); redraw(); },
  };
}

const canvas = by("part");
const view = makeView(canvas);
if (!view) { by("loading").hidden = false; by("loading").textContent = texts.no_drawing; }

function listen() {
  listenToHand(canvas, view);
  for (const button of document.querySelectorAll("[data-look]"))
    button.addEventListener("click", () => view.look(button.dataset.look));
  new ResizeObserver(() => view.redraw()).observe(canvas);
}
if (view) listen();

// ---- words
by("findings_word").textContent = texts.findings;
canvas.setAttribute("aria-label", texts.part);
for (const button of document.querySelectorAll("[data-look]")) button.textContent = texts[button.dataset.look];
by("ask").querySelector("p").textContent = texts.token_wanted;
by("ask").querySelector("span").textContent = texts.token;
by("ask").querySelector("button").textContent = texts.open;
by("ask").addEventListener("submit", (e) => { e.preventDefault(); location.hash = by("token").value.trim(); });
window.addEventListener("hashchange", () => { token = decodeURIComponent(location.hash.slice(1)); });

const item = (name, text, kind) => { const made = document.createElement(name); made.textContent = text; if (kind) made.className = kind; return made; };
const ageText = (s) => s < 1 ? `${Math.round(1000 * s)} ms` : s < 60 ? `${s.toFixed(1)} s` : `${Math.floor(s / 60)} min ${String(Math.floor(s % 60)).padStart(2, "0")} s`;

// What stands there already is not laid out again, ten times a second.
function setText(place, text) { if (place.textContent !== String(text)) place.textContent = text; }
function showRows(list, rows) {
  if (list.children.length !== 2 * rows.length) list.replaceChildren(...rows.flatMap(() => [item("dt", ""), item("dd", "")]));
  rows.flat().forEach((text, k) => setText(list.children[k], text));
}
let shownCode = "";
function showCode(line, code) {
  const text = JSON.stringify([line, code]);
  if (text === shownCode) return;
  shownCode = text;
  by("code").replaceChildren(...code.map(([number, words]) => {
    const made = item("li", "", number === line ? "now" : "");
    made.append(item("span", number), words);
    return made;
  }));
}

function showState() {
  const badge = by("state"), isCut = failures > 1 || (state && performance.now() - received > 4000);
  document.body.classList.toggle("old", isCut || (state !== null && (state.state === "stale" || state.state === "lost")));
  if (!state) { badge.textContent = isCut ? texts.no_answer : texts.connecting; badge.className = isCut ? "cut" : "waiting"; return; }
  const age = state.age_s + (performance.now() - received) / 1000;
  badge.className = isCut ? "cut" : state.state;
  badge.textContent = isCut ? texts.no_answer : state.age_s === null ? state.state_text : `${state.state_text}, ${fill(texts.old, ageText(age))}`;
}

function showNews(news) {
  if (news.title !== undefined) {
    setup = news;
    document.title = `${news.title} - kerf`;
    by("title").textContent = news.title;
    by("source").textContent = news.source;
    if (view && news.box) view.setUp(news.box);
    if (view) view.setTool(news.tool_shape);
  }
  showRows(by("rows"), news.rows);
  showCode(news.line, news.code);
  by("alarm").hidden = !news.notice;
  setText(by("alarm"), news.notice || "");
  by("alarm").className = news.is_alarm ? "" : "warning";
  while (by("findings").children.length > news.findings_from) by("findings").lastChild.remove();
  for (const finding of news.findings) {
    const made = item("li", finding.text, finding.severity);
    if (finding.line > 0) made.append(item("small", `${finding.file} ${fill(texts.line, finding.line)}`));
    by("findings").append(made);
  }
  const listed = by("findings").children.length;
  setText(by("counts"), news.findings_count || (news.state === "ended" ? texts.none : texts.no_findings));
  by("more").hidden = news.findings_count <= listed;
  setText(by("more"), fill(texts.more_findings, news.findings_count - listed));
}

// ---- asking
function take(buffer) {
  const bytes = new Uint8Array(buffer), length = new DataView(buffer).getUint32(4, true);
  if (bytes.length < 8 || String.fromCharCode(...bytes.subarray(0, 4)) !== "KRF1") throw new Error("no scene");
  const news = JSON.parse(new TextDecoder().decode(bytes.subarray(8, 8 + length)));
  if (news.epoch !== seen.epoch) {
    if (view) view.clear();
    hasBeenWhole = false;
    by("findings").replaceChildren();
  }
  state = news;
  received = performance.now();
  isWhole = news.is_whole;
  hasBeenWhole = hasBeenWhole || isWhole;
  showNews(news);
  if (view) {
    view.take(bytes.subarray(8 + length));
    by("loading").hidden = hasBeenWhole;
    by("loading").textContent = texts.loading;
    // How old the newest position is that can be seen; for tests, on the computer of kerf.
    view.redraw(() => { document.body.dataset.delay = Math.round(Date.now() - news.told_ms + 1000 * news.age_s); });
  }
  Object.assign(seen, { epoch: news.epoch, version: news.version, mesh: news.mesh, findings: by("findings").children.length });
  document.body.dataset.answers = Number(document.body.dataset.answers || 0) + 1;
  document.body.dataset.whole = isWhole;
  showState();
}

// For tests: bytes on the wire.
function countBytes(length) { document.body.dataset.bytes = Number(document.body.dataset.bytes || 0) + Number(length); }
const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
async function follow() {
  while (true) {
    const begun = performance.now();
    try {
      const query = Object.entries(seen).map(([name, value]) => `${name}=${value}`).join("&");
      const limit = new AbortController(), timer = setTimeout(() => limit.abort(), 8000);
      const answer = await fetch(`/scene?${query}`, { signal: limit.signal, headers: token ? { Authorization: `Bearer ${token}` } : {} });
      const body = answer.ok ? await answer.arrayBuffer() : null;
      clearTimeout(timer);
      by("ask").hidden = answer.status !== 401;
      if (body) { take(body); failures = 0; countBytes(answer.headers.get("Content-Length")); }
      else { ++failures; await pause(1000); }
    } catch (error) {
      ++failures;
      showState();
      await pause(1000);
    }
    // Ten times a second at most, but for the first time that the part comes.
    if (hasBeenWhole) await pause(Math.max(0, 100 - (performance.now() - begun)));
  }
}
setInterval(showState, 200);
showState();
follow();
})();
