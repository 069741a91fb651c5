// The corners of one's own prisms, to be moved in the cross-section.

import { sectionView } from "./section.js";
import { number, say } from "./words.js";

const layer = document.getElementById("corners");

// Corners nearer than this, cm, are one, of several prisms.
const SAME = 1e-6;

// A step of an arrow key, cm.
const STEP = 0.25;

const turned = ([x, y], degrees) => {
  const [c, s] = [Math.cos((degrees * Math.PI) / 180), Math.sin((degrees * Math.PI) / 180)];
  return [c * x - s * y, s * x + c * y];
};

// Shows a handle for each corner of the device, if it has prisms that are not seen from the side.
export function showCorners(device, changed) {
  const upright = (device?.axis ?? [0, 0, 1]).every((part, i) => Math.abs(part) < 1e-9 === i < 2);
  const prisms = device?.kind === "prisms" && upright && (device.show ?? "cloak") === "cloak" ? device.prism : [];
  const corners = [];
  for (const { corners: own } of prisms) {
    for (const corner of own) {
      const same = corners.find(([one]) => Math.hypot(one[0] - corner[0], one[1] - corner[1]) < SAME);
      if (same) same.push(corner);
      else corners.push([corner]);
    }
  }
  const [left, top] = device?.position ?? [0, 0, 0];
  const put = (all, handle) => {
    const [x, y] = turned(all[0], device.rotation ?? 0);
    const [across, down] = sectionView.shareOf([x + left, y + top]);
    handle.style.left = `${100 * across}%`;
    handle.style.top = `${100 * down}%`;
    handle.setAttribute("aria-label", say("corner", { x: number(all[0][0], 2), y: number(all[0][1], 2) }));
  };
  const move = (all, to, handle, moving) => {
    for (const corner of all) to.forEach((value, i) => (corner[i] = Math.round(value * 1e4) / 1e4));
    put(all, handle);
    changed(moving);
  };
  const handles = corners.map((all) => {
    const handle = document.createElement("button");
    handle.type = "button";
    handle.className = "corner";
    handle.addEventListener("pointerdown", (event) => {
      handle.setPointerCapture(event.pointerId);
      sectionView.isHeld = true;
    });
    handle.addEventListener("pointermove", (event) => {
      if (!handle.hasPointerCapture(event.pointerId)) return;
      const frame = layer.getBoundingClientRect();
      const share = [(event.clientX - frame.left) / frame.width, (event.clientY - frame.top) / frame.height];
      const [x, y] = sectionView.pointOf(share.map((one) => Math.min(1, Math.max(0, one))));
      move(all, turned([x - left, y - top], -(device.rotation ?? 0)), handle, true);
    });
    handle.addEventListener("lostpointercapture", () => {
      sectionView.isHeld = false;
      changed(false);
    });
    handle.addEventListener("keydown", (event) => {
      const by = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
      if (!by) return;
      event.preventDefault();
      move(all, all[0].map((value, i) => value + by[i] * STEP * (event.shiftKey ? 4 : 1)), handle, true);
    });
    put(all, handle);
    return { all, handle };
  });
  layer.replaceChildren(...handles.map(({ handle }) => handle));
  layer.hidden = handles.length === 0;
  sectionView.moved = () => handles.forEach(({ all, handle }) => put(all, handle));
}
