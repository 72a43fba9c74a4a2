"use strict";
// Of every page with a part in 3D: what it is drawn with, and from where it is looked at. A camera has yaw, pitch, zoom, span
// (how large all of it is) and target, the place in the middle of the picture.

const kViews = { iso: [0.62, 0.6], top: [0, Math.PI / 2], front: [0, 0], right: [Math.PI / 2, 0] };

// False: what is drawn is drawn by the processor.
function hasGraphicsCard() {
  const gl = document.createElement("canvas").getContext("webgl", { failIfMajorPerformanceCaveat: true });
  const losing = gl && gl.getExtension("WEBGL_lose_context");
  if (losing) losing.loseContext();
  return gl !== null;
}

// A context with one program in use, or null where nothing can be drawn.
function startDrawing(canvas, vertexText, fragmentText, isSmooth) {
  const gl = canvas.getContext("webgl", { antialias: isSmooth, alpha: false });
  if (!gl) return null;
  const program = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertexText], [gl.FRAGMENT_SHADER, fragmentText]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) { console.error(gl.getShaderInfoLog(shader)); return null; }
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) { console.error(gl.getProgramInfoLog(program)); return null; }
  gl.useProgram(program);
  return { gl, attribute: (name) => gl.getAttribLocation(program, name), uniform: (name) => gl.getUniformLocation(program, name) };
}

// Moved by what a hand does, on a canvas; `pans`: across the picture.
function dragEye(camera, isLathe, canvas, dx, dy, pans) {
  if (pans) {
    const [right, up] = eyeRows(camera, isLathe), step = 2 * camera.span / 1.7 / camera.zoom / Math.min(canvas.clientWidth, canvas.clientHeight);
    for (let i = 0; i < 3; ++i) camera.target[i] += (up[i] * dy - right[i] * dx) * step;
  } else {
    camera.yaw -= 0.008 * dx;  // what is near goes with the hand
    camera.pitch = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, camera.pitch + 0.008 * dy));
  }
}
function zoomEye(camera, factor) { camera.zoom = Math.max(0.2, Math.min(400, camera.zoom * factor)); }

const dotOf = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

// Rows of the eye's frame: right, up, towards the eye. A lathe's Z lies to the right, X up.
function eyeRows(camera, isLathe) {
  const [cy, sy, cp, sp] = [Math.cos(camera.yaw), Math.sin(camera.yaw), Math.cos(camera.pitch), Math.sin(camera.pitch)];
  const rows = [[cy, sy, 0], [-sy * sp, cy * sp, cp], [sy * cp, -cy * cp, sp]];
  return isLathe ? rows.map((r) => [r[2], -r[1], r[0]]) : rows;
}

// Columns of what WebGL takes; `depth` spans before and behind the target are seen.
function eyeMatrix(camera, [right, up, eye], width, height, depth) {
  const scale = 1.7 / camera.span * camera.zoom, aspect = width / height;
  const sx = aspect >= 1 ? scale / aspect : scale, sy = aspect >= 1 ? scale : scale * aspect, sz = -1 / (depth * camera.span);
  return [right[0] * sx, up[0] * sy, eye[0] * sz, 0, right[1] * sx, up[1] * sy, eye[1] * sz, 0,
    right[2] * sx, up[2] * sy, eye[2] * sz, 0,
    -dotOf(right, camera.target) * sx, -dotOf(up, camera.target) * sy, -dotOf(eye, camera.target) * sz, 1];
}

// The canvas has as many points as the screen has below it: their number, [across, down].
function fitCanvas(canvas) {
  const ratio = window.devicePixelRatio || 1;
  const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((size) => Math.max(2, Math.round(size * ratio)));
  if (canvas.width !== width || canvas.height !== height) { canvas.width = width; canvas.height = height; }
  return [width, height];
}
