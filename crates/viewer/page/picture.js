// The rendered view: one picture, or two on the sides of a divider.

import { say } from "./words.js";

const canvas = document.getElementById("picture");
const divider = document.getElementById("divider");
const probe = document.getElementById("probe");
const labels = { left: document.getElementById("left-label"), right: document.getElementById("right-label") };
const context = canvas.getContext("2d");

const views = new Map();

export const picture = {
  canvas,

  // Takes a picture of a view.
  show(caption, image, state) {
    let view = views.get(caption.view);
    if (!view) views.set(caption.view, (view = document.createElement("canvas")));
    if (view.width !== caption.width || view.height !== caption.height) {
      view.width = caption.width;
      view.height = caption.height;
    }
    view.getContext("2d").putImageData(image, 0, 0);
    picture.draw(state);
  },

  // Forgets what was shown beside.
  forget() {
    for (const name of views.keys()) if (name !== "scene") views.delete(name);
  },

  draw(state) {
    const [width, height] = state.size;
    if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
      canvas.parentElement.parentElement.style.setProperty("--ratio", width / height);
    }
    const put = (name, from, to) => {
      const view = views.get(name);
      if (!view || to <= from) return;
      context.save();
      context.beginPath();
      context.rect(from, 0, to - from, height);
      context.clip();
      context.imageSmoothingEnabled = view.width !== width;
      context.imageSmoothingQuality = "high";
      context.drawImage(view, 0, 0, width, height);
      context.restore();
    };
    const split = state.beside !== "nothing" && views.has(state.beside);
    const place = split ? Math.round(state.divider * width) : 0;
    if (split) put(state.beside, 0, place);
    put("scene", place, width);
  },

  // Puts divider and labels where they belong.
  layOut(state, shown) {
    const split = state.beside !== "nothing";
    divider.hidden = labels.left.hidden = labels.right.hidden = !split;
    if (!split) return;
    divider.style.left = `${100 * state.divider}%`;
    divider.setAttribute("aria-valuenow", String(Math.round(100 * state.divider)));
    const left = say(`beside.${state.beside}`);
    divider.setAttribute("aria-valuetext", say("side.says", { p: Math.round(100 * state.divider), left, right: shown }));
    labels.left.textContent = left;
    labels.right.textContent = shown;
  },

  // Where on the picture a pointer is, as shares.
  place(event) {
    const box = canvas.getBoundingClientRect();
    const share = (value, low, size) => Math.min(1, Math.max(0, (value - low) / size));
    return [share(event.clientX, box.left, box.width), share(event.clientY, box.top, box.height)];
  },

  mark(at) {
    probe.hidden = !at;
    if (at) {
      probe.style.left = `${100 * at[0]}%`;
      probe.style.top = `${100 * at[1]}%`;
    }
  },

  toBlob: () => new Promise((resolve) => canvas.toBlob(resolve, "image/png")),
};

// Lets the divider be moved; `moved` is told.
export function watchDivider(state, moved) {
  const set = (share) => {
    state.divider = Math.min(1, Math.max(0, share));
    moved();
  };
  divider.addEventListener("pointerdown", (event) => {
    divider.setPointerCapture(event.pointerId);
    event.preventDefault();
    divider.focus();
  });
  divider.addEventListener("pointermove", (event) => {
    if (divider.hasPointerCapture(event.pointerId)) set(picture.place(event)[0]);
  });
  divider.addEventListener("keydown", (event) => {
    const step = event.shiftKey ? 0.1 : 0.02;
    const by = { ArrowLeft: -step, ArrowDown: -step, ArrowRight: step, ArrowUp: step }[event.key];
    if (by !== undefined) set(state.divider + by);
    else if (event.key === "Home") set(0);
    else if (event.key === "End") set(1);
    else return;
    event.preventDefault();
    event.stopPropagation();
  });
}
