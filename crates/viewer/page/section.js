// The cross-section with the rays of one point, as SVG.

import { percent, time } from "./numbers.js";
import { number, plain, say, write } from "./words.js";

const $ = (id) => document.getElementById(id);
const svg = $("section");
const shapes = $("shapes");
const rays = $("lines");
const words = $("ray-words");
const title = $("section-words");

// Steps of the rays' widths, each factor of ten of power.
const LEVELS = 5;
let section = null;
let tree = null;
// What part of the scene is drawn: its left and upper end, and its size, cm.
let box = [0, 0, 1, 1];

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

// The colors of an index: of 1, of what is larger, and of what is less.
const FULL = 1.5;
function colorer() {
  const style = getComputedStyle(document.documentElement);
  const [one, more, less] = ["one", "more", "less"].map((name) => {
    const code = style.getPropertyValue(`--index-${name}`).trim();
    return [1, 3, 5].map((at) => parseInt(code.slice(at, at + 2), 16));
  });
  return (index) => {
    const share = Math.min(1, Math.abs(index - 1) / (index > 1 ? FULL : 1));
    return one.map((value, i) => Math.round(value + share * ((index > 1 ? more : less)[i] - value)));
  };
}

// A graded index as a picture within its borders.
function graded({ index, border }, name, color) {
  const { corner, across, up, rows } = index;
  const [height, width] = [rows.length, rows[0].length];
  const known = (x, y) => rows[y]?.[x] ?? null;
  // What lies beyond the border gets the number beside it, for pixels are drawn smoothly.
  const near = [[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1], [1, 1], [-1, 1], [1, -1], [-1, -1]];
  const pixels = new ImageData(width, height);
  for (let y = 0; y < height; y += 1) {
    for (let x = 0; x < width; x += 1) {
      const value = near.map(([dx, dy]) => known(x + dx, y + dy)).find((one) => one !== null);
      if (value !== undefined) pixels.data.set([...color(value), 255], 4 * ((height - 1 - y) * width + x));
    }
  }
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [width, height];
  canvas.getContext("2d").putImageData(pixels, 0, 0);
  const clip = element("clipPath", { id: name });
  clip.append(element("path", { d: paths(border), "clip-rule": "evenodd" }));
  // From the upper left corner, as pictures go.
  const place = [across[0], -across[1], -up[0], up[1], corner[0] + up[0], -(corner[1] + up[1])];
  const image = element("image", { width: 1, height: 1, preserveAspectRatio: "none", href: canvas.toDataURL(), transform: `matrix(${place})` });
  const group = element("g", { "clip-path": `url(#${name})` });
  group.append(image);
  return { clip, group };
}

export const sectionView = {
  whole: false,
  // While a corner is dragged the scale is kept.
  isHeld: false,

  show(newer) {
    section = newer;
    sectionView.draw();
  },

  draw() {
    if (!section) return;
    const color = colorer();
    const [drawn, clips, indices] = [[], [], []];
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
        const area = element("path", { d: paths(region.border), class: "cell", "fill-rule": "evenodd" });
        if (region.index?.rows) {
          const { clip, group } = graded(region, `clip-${clips.length}`, color);
          clips.push(clip);
          drawn.push(group);
          area.style.fill = "none";
          indices.push(...region.index.range.filter((index) => index !== null));
        } else if (typeof region.index === "number") {
          area.style.fill = `rgb(${color(region.index).join(" ")})`;
          indices.push(region.index);
        }
        drawn.push(area);
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
    $("clips").replaceChildren(...clips);
    // The key to the colors.
    $("legend-index").hidden = indices.length === 0;
    if (indices.length > 0) {
      const [low, high] = [Math.min(...indices), Math.max(...indices)];
      $("index-low").textContent = number(low, 2);
      $("index-high").textContent = high - low < 0.005 ? "" : number(high, 2);
      const stops = Array.from({ length: 9 }, (_, i) => `rgb(${color(low + ((high - low) * i) / 8).join(" ")})`);
      document.querySelector(".indices").style.background = `linear-gradient(90deg, ${stops.join(", ")})`;
    }
    sectionView.fit();
  },

  // The part of the scene that is shown: the devices, or with camera and photograph.
  fit() {
    if (!section) return;
    const near = section.devices.flatMap((device) => [...device.outlines, ...device.metal.map((m) => m.points)]);
    if (sectionView.isHeld) return sectionView.moved?.();
    const points = near.flat().filter(([x, y]) => Math.abs(x) < 150 && Math.abs(y) < 150);
    if (sectionView.whole || points.length === 0) {
      points.push(...section.photograph);
      if (Math.hypot(...section.camera.position) < 1000) points.push(section.camera.position);
    }
    const range = (i) => [Math.min(...points.map((p) => p[i])), Math.max(...points.map((p) => p[i]))];
    const [[left, right], [bottom, top]] = [range(0), range(1)];
    const [wide, high] = [svg.clientWidth || 5, svg.clientHeight || 3];
    const scale = 1.25 * Math.max((right - left) / wide, (top - bottom) / high, 0.5 / wide);
    const [w, h] = [wide * scale, high * scale];
    box = [(left + right - w) / 2, (top + bottom + h) / 2, w, h];
    svg.setAttribute("viewBox", `${box[0]} ${-box[1]} ${w} ${h}`);
    // A length to measure by.
    const about = w / 5;
    const ten = 10 ** Math.floor(Math.log10(about));
    const length = [5, 2, 1].map((one) => one * ten).find((one) => one <= about) ?? ten;
    $("ruler").style.width = `${(length / w) * wide}px`;
    $("ruler-words").textContent = `${number(length, 3)} cm`;
    sectionView.drawRays();
    sectionView.moved?.();
  },

  // Where a point of the scene is on the drawing, as shares, and back.
  shareOf: ([x, y]) => [(x - box[0]) / box[2], (box[1] - y) / box[3]],
  pointOf: ([across, down]) => [box[0] + across * box[2], box[1] - down * box[3]],

  rays(newer) {
    tree = newer;
    sectionView.drawRays();
    sectionView.say();
  },

  drawRays() {
    if (!tree) return;
    const size = box[2];
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
    title.textContent = say("section.says");
    if (!tree?.pulses) {
      words.textContent = say("point");
      return;
    }
    const { pulses, pixel, lines } = tree;
    const leaves = lines.filter((line) => line.leaves);
    const strongest = leaves.slice(0, 4).map((line) => percent(line.power));
    const delays = pulses.pulses.filter((pulse) => pulse.delay_ns !== null);
    const late = delays.reduce((sum, pulse) => sum + pulse.delay_ns * pulse.power, 0);
    const power = delays.reduce((sum, pulse) => sum + pulse.power, 0);
    const [x, y] = pixel;
    const shares = { d: percent(pulses.delivered), e: percent(pulses.escaped), a: percent(pulses.absorbed), p: percent(pulses.pruned) };
    const said = [say("ray.power", { x, y, ...shares })];
    if (leaves.length > 0) said.push(say(leaves.length === 1 ? "ray.one" : "ray.branches", { n: leaves.length, s: strongest.join(", ") }));
    if (power > 0) {
      const t = time(Math.abs(late / power));
      said.push(t === "0" ? say("ray.same") : say(late > 0 ? "ray.delay" : "ray.early", { t }));
    }
    write(words, said.join(" "));
    title.textContent = plain("section.pixel", { x, y });
  },

  clear() {
    tree = null;
    rays.replaceChildren();
    sectionView.say();
  },
};

new ResizeObserver(() => sectionView.fit()).observe(svg);
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => sectionView.draw());
