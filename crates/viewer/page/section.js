// The cross-section with the rays of one point, as SVG.

import { percent, time } from "./numbers.js";

const svg = document.getElementById("section");
const shapes = document.getElementById("shapes");
const rays = document.getElementById("lines");
const words = document.getElementById("ray-words");
const title = document.getElementById("section-words");

const WIDTH = 5;
const HEIGHT = 4;
// Steps of the rays' widths, each factor of ten of power.
const LEVELS = 5;
let section = null;
let tree = null;

function element(name, attributes) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  return made;
}

// y points up in the scene.
const path = (points, closed) =>
  points.length === 0 ? "" : `M${points.map(([x, y]) => `${x} ${-y}`).join("L")}${closed ? "Z" : ""}`;
const paths = (contours) => contours.map((points) => path(points, true)).join("");

// sRGB of linear light.
const code = (light) => {
  const value = Math.min(1, Math.max(0, light));
  return Math.round(255 * (value <= 0.0031308 ? 12.92 * value : 1.055 * value ** (1 / 2.4) - 0.055));
};

export const sectionView = {
  whole: false,

  show(newer) {
    section = newer;
    const drawn = [];
    for (const device of section.devices) {
      // What is seen from the side is an outline and nothing else.
      if (device.body || device.regions.length + device.metal.length === 0) {
        const area = element("path", { d: paths(device.outlines), class: "cell" });
        if (Array.isArray(device.body)) area.style.fill = `rgb(${device.body.map(code).join(" ")})`;
        else if (device.body === "image") area.classList.add("metal");
        drawn.push(area);
        continue;
      }
      for (const region of device.regions) {
        const kind = region.graded ? "cell graded" : "cell";
        drawn.push(element("path", { d: paths(region.border), class: kind, "fill-rule": "evenodd" }));
      }
      for (const metal of device.metal) {
        const kind = metal.closed ? "metal" : "thin";
        drawn.push(element("path", { d: path(metal.points, metal.closed), class: kind }));
      }
    }
    drawn.push(element("path", { d: path(section.photograph, false), class: "photo" }));
    const [eyeX, eyeY] = section.camera.position;
    if (!section.camera.parallel) {
      for (const [[fromX, fromY], [dx, dy]] of section.camera.edges) {
        const sight = `M${fromX} ${-fromY}L${fromX + 200 * dx} ${-(fromY + 200 * dy)}`;
        drawn.push(element("path", { d: sight, class: "sight" }));
      }
      drawn.push(element("circle", { cx: eyeX, cy: -eyeY, r: 1.6, class: "eye" }));
    }
    shapes.replaceChildren(...drawn);
    sectionView.fit();
  },

  // The part of the scene that is shown: the devices, or with camera and photograph.
  fit() {
    if (!section) return;
    const near = section.devices.flatMap((device) => [...device.outlines, ...device.metal.map((m) => m.points)]);
    const points = near.flat().filter(([x, y]) => Math.abs(x) < 150 && Math.abs(y) < 150);
    if (sectionView.whole || points.length === 0) {
      points.push(...section.photograph);
      if (Math.hypot(...section.camera.position) < 1000) points.push(section.camera.position);
    }
    const range = (i) => [Math.min(...points.map((p) => p[i])), Math.max(...points.map((p) => p[i]))];
    const [[left, right], [bottom, top]] = [range(0), range(1)];
    const scale = 1.25 * Math.max((right - left) / WIDTH, (top - bottom) / HEIGHT, 0.1);
    const [w, h] = [WIDTH * scale, HEIGHT * scale];
    svg.setAttribute("viewBox", `${(left + right - w) / 2} ${-(bottom + top + h) / 2} ${w} ${h}`);
    sectionView.drawRays();
  },

  rays(newer) {
    tree = newer;
    sectionView.drawRays();
    sectionView.say();
  },

  drawRays() {
    if (!tree) return;
    const size = Number(svg.getAttribute("viewBox")?.split(" ")[2] ?? 100);
    // A tree may have hundreds of pieces: those of about the same power are one path.
    const levels = new Map();
    for (const line of tree.lines) {
      const level = Math.round(LEVELS * Math.log10(Math.min(1, line.power)));
      if (!levels.has(level)) levels.set(level, []);
      levels.get(level).push(line);
    }
    const drawn = [];
    for (const [level, lines] of [...levels].sort(([a], [b]) => a - b)) {
      const power = 10 ** (level / LEVELS);
      const ray = element("path", { d: lines.map(({ points }) => path(points, false)).join(""), class: "ray" });
      ray.style.strokeOpacity = Math.max(0.15, power ** 0.4);
      ray.style.strokeWidth = `${Math.max(0.7, 2.4 * power ** 0.35)}px`;
      drawn.push(ray);
      for (const { points } of lines.filter(({ lands }) => lands)) {
        const [x, y] = points[points.length - 1];
        drawn.push(element("circle", { cx: x, cy: -y, r: (size / 130) * power ** 0.35, class: "landing" }));
      }
    }
    rays.replaceChildren(...drawn);
  },

  say() {
    const { pulses, pixel, lines } = tree;
    if (!pulses) return;
    const pieces = lines.length;
    const leaves = lines.filter((line) => line.leaves);
    const strongest = leaves.slice(0, 4).map((line) => percent(line.power));
    const delays = pulses.pulses.filter((pulse) => pulse.delay_ns !== null);
    const delay = delays.reduce((sum, pulse) => sum + pulse.delay_ns * pulse.power, 0);
    const power = delays.reduce((sum, pulse) => sum + pulse.power, 0);
    const said = [
      `Pixel ${pixel[0]}, ${pixel[1]}: ${percent(pulses.delivered)} from the photograph, ` +
        `${percent(pulses.escaped)} from the surroundings, ${percent(pulses.absorbed)} absorbed, ` +
        `${percent(pulses.pruned)} pruned.`,
      leaves.length > 0
        ? `${leaves.length} ${leaves.length === 1 ? "branch leaves" : "branches leave"}, ${pieces} ` +
          `${pieces === 1 ? "piece" : "pieces"}; strongest: ${strongest.join(", ")}.`
        : "",
      power > 0 ? `Against the empty view: ${time(delay / power, true)}.` : "",
    ];
    words.textContent = said.filter(Boolean).join(" ");
    title.textContent = `Cross-section of the scene with the light of pixel ${pixel[0]}, ${pixel[1]}`;
  },

  clear() {
    tree = null;
    rays.replaceChildren();
    words.textContent = "Point at the picture to follow the light of that point.";
    title.textContent = "Cross-section of the scene";
  },
};
