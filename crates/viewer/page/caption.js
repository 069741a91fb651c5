// What one sees, in plain words, from the scene as it is.

import { has, number, plain, say } from "./words.js";

const CARPETS = ["gaussian-carpet", "quasi-conformal-carpet", "grating-carpet"];
const BALLS = ["bending-sphere", "eaton-lens", "luneburg-lens", "fisheye-lens", "fisheye-hemisphere"];
// Those whose cloak is seen as a flat mirror, edge-on or turned.
const SHEETS = ["square-cloak", "double-gaussian-cloak"];
// Those whose cloak is seen as a point or a thread.
const ROUND = ["sphere-cloak", "cylinder-cloak"];

// What a key of a device says, or else its default.
const valueOf = (device, hello, name) => device[name] ?? hello.kinds[device.kind]?.keys[name]?.default;

// The thing itself, with its size.
function thing(device, hello) {
  if (device.core === "open") return say("thing.open");
  const of = (name) => Number(valueOf(device, hello, name));
  const { kind } = device;
  const [word, size] = {
    "square-cloak": () => [kind, of("kappa") * of("side") * Math.SQRT2],
    "double-gaussian-cloak": () => [kind, 2 * of("h")],
    "cylinder-cloak": () => [kind, 2 * of("inner")],
    "sphere-cloak": () => [kind, 2 * of("inner")],
    "mirror-detour": () => [kind],
    prisms: () => [of("floor") > 0 ? "prisms-floor" : kind],
    "invisible-sphere": () => [kind, 2 * of("radius")],
    lens: () => [kind, of("diameter")],
    mirror: () => [kind, of("width")],
    polarizer: () => [kind, of("width")],
    polyhedron: () => [kind],
    graded: () => [kind, of("width")],
    "graded-box": () => ["graded", valueOf(device, hello, "sides")?.[2]],
    body: () => {
      const shape = valueOf(device, hello, "shape");
      if (shape === "sphere") return ["ball-body", 2 * of("radius")];
      return shape === "cylinder" ? ["rod-body", 2 * of("radius")] : ["body"];
    },
  }[kind]?.() ?? (CARPETS.includes(kind) ? ["carpet", of("h")] : BALLS.includes(kind) ? ["ball", 2 * of("radius")] : ["body"]);
  return say(`thing.${word}`, { h: number(size ?? 0) });
}

// How far, in degrees from 0 to 90, a device is seen beside its own axis: by its rotation, and by where the camera stands.
export function aside(device, camera = {}) {
  const upright = (device.axis ?? [0, 0, 1]).every((part, i) => Math.abs(part) < 1e-9 === i < 2);
  const [from, to] = [camera.position ?? [-100, 0, 0], camera.target ?? [50, 0, 0]];
  const sight = upright ? (Math.atan2(to[1] - from[1], to[0] - from[0]) * 180) / Math.PI : 0;
  const turned = (((((device.rotation ?? 0) - sight) % 180) + 270) % 180) - 90;
  const degrees = Math.abs(turned);
  return degrees < 0.05 ? 0 : degrees;
}

// What the polarizer of the camera does to a cloak that works for one polarization, along its axis or across; nothing is said where that
// is slanted.
function polarized(isAlong, device, polarizer = "none") {
  const [x, y, z] = (device.axis ?? [0, 0, 1]).map((part) => Math.abs(part) > 1e-9);
  if (x || y === z) return "";
  const words = ["horizontal", "vertical"];
  const angle = words.includes(polarizer) ? 90 * words.indexOf(polarizer) : polarizer;
  const wanted = Number(isAlong === y);
  const p = (number) => ({ p: say(`polarizer.${words[number]}`) });
  const turned = Math.abs(angle) % 180;
  if (turned === 90 * wanted) return ["cloak.through", p(wanted)];
  if (turned === 90 - 90 * wanted) return ["cloak.wrong", p(1 - wanted)];
  return ["cloak.half", p(wanted)];
}

// Why it looks as it does.
function reasons(device, scene, hello) {
  const { kind } = device;
  const { camera = {} } = scene;
  const material = valueOf(device, hello, "material");
  const said = [];
  if (device.core === "open") return ["cloak.open"];
  if (SHEETS.includes(kind)) {
    const degrees = aside(device, camera);
    const isTurned = Math.abs(degrees - Math.abs(device.rotation ?? 0)) < 0.06;
    const isHalf = kind === "square-cloak" && material !== "impedance-matched";
    const straight = kind === "square-cloak" ? "cloak.straight" : "cloak.almost";
    const [half, put] = isHalf ? polarized(true, device, camera.polarizer) : [];
    if (half !== "cloak.wrong") said.push(degrees === 0 ? (isHalf ? "" : straight) : [isTurned ? "cloak.turned" : "cloak.aside", { r: number(degrees) }]);
    if (half) said.push([half, put]);
  } else if (kind === "cylinder-cloak" && material !== "impedance-matched") {
    said.push(polarized(false, device, camera.polarizer));
  } else if (ROUND.includes(kind)) {
    said.push("cloak.round");
  } else if (CARPETS.includes(kind) || (kind === "prisms" && device.floor > 0)) {
    said.push("cloak.carpet");
  } else if (kind === "mirror-detour") {
    said.push(camera.projection === "orthographic" ? "cloak.detour" : "cloak.detour.eye");
  } else if (kind === "prisms") {
    said.push("cloak.prisms");
  } else {
    const word = kind === "invisible-sphere" && material !== "graded" ? "see.invisible-sphere-regularized" : `see.${kind}`;
    if (has(word)) said.push([word, { a: number(Number(valueOf(device, hello, "angle") ?? 0)) }]);
  }
  return said;
}

const PHOTOGRAPHS = { "builtin:bookshelf": "person", undefined: "person" };

// Whether a photograph is one that the page has brought.
export const isOwn = (image) => typeof image === "string" && !image.startsWith("builtin:");

// The caption of a state, with the marks of the glossary.
export function caption(state, hello) {
  const { scene } = state;
  const isShown = ({ show }) => show !== "empty";
  const device = [state.device, ...state.devices].filter(Boolean).find(isShown) ?? state.device;
  const image = scene.photograph?.image;
  const photo = say(`photo.${PHOTOGRAPHS[image] ?? (isOwn(image) ? "own" : "other")}`);
  const exhibit = hello.exhibits.find(({ name }) => name === state.exhibit)?.scene;
  const kinds = (devices = []) => devices.map(({ kind }) => kind).join();
  const isWhole = kinds(scene.device) === kinds(exhibit?.device);
  const said = [];
  if (!device) {
    said.push("nobody");
  } else if (!isShown(device)) {
    said.push(["nothing", { photo }]);
  } else if (device.kind === "body" && isWhole && has(`see.${state.exhibit}`)) {
    said.push(`see.${state.exhibit}`);
  } else {
    const more = state.devices.filter(isShown).length - 1;
    said.push([more > 0 ? "stands.more" : "stands", { thing: thing(device, hello), n: number(more), photo }]);
    const show = device.show ?? "cloak";
    if (show === "bare") said.push("bare");
    else if (show === "mirror") {
      const isEdge = SHEETS.includes(device.kind) && aside(device, scene.camera) === 0;
      said.push(isEdge ? "mirror.edge" : ROUND.includes(device.kind) ? "mirror.round" : "mirror");
    }
    else if (isWhole && has(`see.${state.exhibit}`)) said.push([`see.${state.exhibit}`, { a: number(Number(device.angle ?? 90)) }]);
    else said.push(...reasons(device, scene, hello));
    if (device.length && show === "cloak" && [...SHEETS, "cylinder-cloak"].includes(device.kind)) said.push("cloak.ends");
    if (Object.values(device.imperfection ?? {}).some(Boolean) && show === "cloak") said.push("see.imperfect");
  }
  const { polarizer = "none" } = scene.camera ?? {};
  const isSaid = said.some((one) => Array.isArray(one) && ["cloak.through", "cloak.wrong"].includes(one[0]));
  if (polarizer !== "none" && !isSaid) {
    said.push(["see.polarizer.camera", { p: typeof polarizer === "number" ? `${number(polarizer)}°` : say(`polarizer.${polarizer}`) }]);
  }
  const { spectrum } = scene.light ?? {};
  if (typeof spectrum === "number") said.push(["see.wavelength", { n: number(spectrum) }]);
  const map = scene.picture?.map ?? "none";
  if (state.moment !== null) said.push("see.flight");
  else if (map !== "none") said.push(["see.map", { map: say(`map.${map}`) }]);
  if (state.beside !== "nothing") said.push(["see.beside", { left: say(`beside.${state.beside}`) }]);
  return said.filter(Boolean).map((one) => (Array.isArray(one) ? say(...one) : say(one))).join(" ");
}

// The same without the marks.
export const plainCaption = (state, hello) => caption(state, hello).replace(/\[\[([^|\]]*)\|\w+\]\]/g, "$1");

// What a menu calls an exhibit.
export const nameOf = (name) => (has(`name.${name}`) ? plain(`name.${name}`) : name.replaceAll("-", " "));

// The menu: groups of exhibits, the perfect cloak first.
const GROUPS = {
  cloaks: ["square-cloak", "sphere-cloak", "cylinder-cloak", "double-gaussian-cloak", "square-cloak-positive-uniaxial", "square-cloak-negative-uniaxial",
    "open-core", "crossed-cloaks", "standing-cylinder-cloak", "cylinder-cloak-radial", "cylinder-cloak-azimuthal", "mirror-detour-orthographic",
    "mirror-detour-perspective"],
  carpets: ["gaussian-carpet", "quasi-conformal-carpet", "grating-carpet", "carpet-in-glass", "prisms-on-floor"],
  balls: ["invisible-sphere", "invisible-sphere-regularized", "bending-sphere", "eaton-lens", "luneburg-lens", "fisheye-lens", "fisheye-hemisphere"],
  things: ["lens", "mirror", "polyhedron", "rod-in-water", "rod-in-negative-water", "rod-in-matched-negative-water", "bodies", "tilted-box", "coated-panes",
    "quartz-wedge", "graded-box"],
  own: ["prisms", "graded", "graded-3d"],
};

export function groups(hello) {
  const there = hello.exhibits.map(({ name }) => name);
  const known = new Set(Object.values(GROUPS).flat());
  const all = { ...GROUPS, more: there.filter((name) => !known.has(name)) };
  return Object.entries(all)
    .map(([group, names]) => [group, names.filter((name) => there.includes(name))])
    .filter(([, names]) => names.length > 0);
}
