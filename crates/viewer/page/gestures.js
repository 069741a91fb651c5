// Pointer, wheel and keys; photographs dropped onto the page.

import { orbit, zoom } from "./orbit.js";
import { picture } from "./picture.js";

// Lets the pointer and the keys on the picture orbit, zoom, and choose the point whose ray is followed.
export function watchPointer(state, { changed, follow, resetCamera, say }) {
  let choosing = false;
  let chosen = [0.5, 0.5];
  const pointers = new Map();
  picture.canvas.addEventListener("pointerdown", (event) => {
    picture.canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
  });
  picture.canvas.addEventListener("pointermove", (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) {
      if (!choosing) follow(picture.place(event));
      return;
    }
    const spread = () => {
      const [a, b] = [...pointers.values()];
      return Math.hypot(a[0] - b[0], a[1] - b[1]);
    };
    const was = pointers.size === 2 ? spread() : 0;
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
    if (pointers.size === 2) zoom(state, was / Math.max(1, spread()));
    else orbit(state, (event.clientX - before[0]) / 4, (event.clientY - before[1]) / 4);
    changed(true);
  });
  for (const name of ["pointerup", "pointercancel"]) {
    picture.canvas.addEventListener(name, (event) => {
      pointers.delete(event.pointerId);
      if (event.pointerType !== "mouse") follow(picture.place(event));
    });
  }
  picture.canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    zoom(state, Math.exp(Math.max(-60, Math.min(60, event.deltaY)) / 400));
    changed(true);
  }, { passive: false });
  picture.canvas.addEventListener("keydown", (event) => {
    const step = event.shiftKey ? 10 : 2;
    const by = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (by && choosing) {
      const [x, y] = chosen;
      const move = (value, by) => Math.min(1, Math.max(0, value + (by * step) / 200));
      chosen = [move(x, by[0]), move(y, by[1])];
      follow(chosen);
    } else if (by) {
      orbit(state, by[0] * step, by[1] * step);
      changed(true);
    } else if (event.key === "+" || event.key === "=" || event.key === "-") {
      zoom(state, event.key === "-" ? 1.1 : 1 / 1.1);
      changed(true);
    } else if (event.key === "Home") {
      resetCamera();
    } else if (event.key === "Escape") {
      choosing = false;
      follow(null);
    } else if (event.key === "Enter") {
      choosing = !choosing;
      if (choosing) follow(chosen);
      say(choosing ? "choosing" : "orbiting");
    } else {
      return;
    }
    event.preventDefault();
  });
}

// The keys that work everywhere on the page. Space turns the device, unless the keyboard has gone to something that Space presses:
// what was clicked on does not count.
export function watchKeys({ ready, play, rotate, show, split, full }) {
  let tabbed = false;
  document.addEventListener("pointerdown", () => (tabbed = false), true);
  document.addEventListener("keydown", (event) => {
    if (event.key === "Tab") tabbed = true;
    if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return;
    const at = event.target;
    const isSpace = event.key === " ";
    const typing = at.matches("input[type=number], select");
    if (typing && !(isSpace && (!tabbed || at.type === "number"))) return;
    if (isSpace && tabbed && at.matches("button, summary, a, input[type=checkbox], input[type=file]")) return;
    const step = event.shiftKey ? 10 : 1;
    const done = {
      " ": () => play(),
      "[": () => rotate(-step),
      "{": () => rotate(-10),
      "]": () => rotate(step),
      "}": () => rotate(10),
      c: () => show("cloak"),
      b: () => show("bare"),
      m: () => show("mirror"),
      s: () => split(),
      f: () => full(),
    }[event.key.toLowerCase()];
    if (!ready() || !done) return;
    done();
    event.preventDefault();
  });
  // Firefox presses a button when Space is released.
  document.addEventListener("keyup", (event) => {
    if (event.key === " " && !tabbed && event.target.matches("button, summary, input[type=checkbox]")) event.preventDefault();
  });
}

// Takes files that are dropped onto the page.
export function watchDrops(bring) {
  const sign = document.getElementById("drop");
  let dragged = 0;
  const isFile = (event) => event.dataTransfer?.types.includes("Files");
  addEventListener("dragenter", (event) => {
    if (isFile(event)) sign.hidden = ++dragged === 0;
  });
  addEventListener("dragleave", (event) => {
    if (isFile(event)) sign.hidden = --dragged <= 0;
  });
  addEventListener("dragover", (event) => {
    if (isFile(event)) event.preventDefault();
  });
  addEventListener("drop", (event) => {
    event.preventDefault();
    dragged = 0;
    sign.hidden = true;
    bring(event.dataTransfer?.files[0]);
  });
}
