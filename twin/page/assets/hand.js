"use strict";
// Of every page with a part in 3D: it is turned by dragging and the arrow keys, moved with Shift, a
// right button or two fingers, zoomed by the wheel, two fingers, + and -. `view` has
// drag(dx, dy, pans) and zoom(factor). `onTap(x, y)`, if given: a pointer has come and gone there.
function listenToHand(canvas, view, onTap) {
  const pointers = new Map(), kTap = 4;
  let moved = 0, spread = 0;
  canvas.addEventListener("pointerdown", (e) => {
    canvas.setPointerCapture(e.pointerId);
    pointers.set(e.pointerId, [e.offsetX, e.offsetY]);
    moved = 0;
    spread = 0;
  });
  canvas.addEventListener("pointermove", (e) => {
    const last = pointers.get(e.pointerId);
    if (!last) return;
    const dx = e.offsetX - last[0], dy = e.offsetY - last[1];
    pointers.set(e.pointerId, [e.offsetX, e.offsetY]);
    moved += Math.abs(dx) + Math.abs(dy);
    if (pointers.size === 2) {
      const [a, b] = [...pointers.values()], d = Math.hypot(a[0] - b[0], a[1] - b[1]);
      if (spread > 0) view.zoom(d / spread);
      spread = d;
      view.drag(dx / 2, dy / 2, true);
    } else {
      view.drag(dx, dy, e.shiftKey || (e.buttons & 6) !== 0);
    }
  });
  const up = (e) => {
    if (pointers.delete(e.pointerId) && moved < kTap && e.type === "pointerup" && onTap) onTap(e.offsetX, e.offsetY);
    spread = 0;
  };
  canvas.addEventListener("pointerup", up);
  canvas.addEventListener("pointercancel", up);
  canvas.addEventListener("contextmenu", (e) => e.preventDefault());
  canvas.addEventListener("wheel", (e) => { e.preventDefault(); view.zoom(Math.exp(-e.deltaY * 0.0012)); }, { passive: false });
  canvas.addEventListener("keydown", (e) => {
    const keys = { ArrowLeft: [-12, 0], ArrowRight: [12, 0], ArrowUp: [0, -12], ArrowDown: [0, 12] };
    if (keys[e.key]) view.drag(...keys[e.key], e.shiftKey);
    else if (e.key === "+") view.zoom(1.2);
    else if (e.key === "-") view.zoom(1 / 1.2);
    else return;
    e.preventDefault();
  });
}
