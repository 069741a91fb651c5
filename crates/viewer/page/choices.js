// The controls that say what is shown, and how they follow the state.

import { groups, nameOf } from "./caption.js";
import { buildControls } from "./controls.js";
import { showCorners } from "./corners.js";
import { picture } from "./picture.js";
import { has, number, say } from "./words.js";

const $ = (id) => document.getElementById(id);

// Fills the lists of devices and maps. The scene that was opened is listed where it is another than the exhibit it is from.
export function fillLists(hello) {
  const opened = hello.first ? [] : [new Option(hello.name || say("opened"), "opened")];
  const lists = groups(hello).map(([group, names]) => {
    const list = document.createElement("optgroup");
    list.label = say(`group.${group}`);
    list.append(...names.map((name) => new Option(nameOf(name), name)));
    return list;
  });
  $("exhibit").replaceChildren(...opened, ...lists);
  const word = (map) => (has(`map.${map}`) ? say(`map.${map}`) : map.replaceAll("_", " "));
  $("map").replaceChildren(...hello.maps.map((map) => new Option(word(map), map)));
}

// Brings every control to the state; `changed` and `setShow` are told what is done with them.
export function showState(state, hello, { changed, setShow }) {
  const device = state.device;
  const kind = hello.kinds[device?.kind];
  const exhibit = hello.exhibits.find(({ name }) => name === state.exhibit);
  $("exhibit").value = exhibit ? exhibit.name : "opened";
  $("about").textContent = [kind?.summary, exhibit?.words].filter(Boolean).join(" ");
  $("which-label").hidden = state.devices.length < 2;
  $("which").replaceChildren(...state.devices.map(({ kind, name }, i) => new Option(`${i + 1}: ${name ? `${name}, ` : ""}${kind}`, i)));
  $("which").value = String(Math.min(state.which, state.devices.length - 1));
  const { polarizer = "none" } = state.scene.camera ?? {};
  $("polarizer").value = typeof polarizer === "number" ? "angle" : polarizer;
  $("guide-polarizer").textContent = say(polarizer === "none" ? "tour.no_polarizer" : "tour.polarizer");
  $("angle-label").hidden = typeof polarizer !== "number";
  if (typeof polarizer === "number") $("angle").value = polarizer;
  $("bandwidth").value = state.scene.light?.bandwidth_nm ?? "";
  showSpectrum(state.scene.light?.spectrum);
  $("map").value = state.scene.picture?.map ?? "none";
  $("border").value = state.scene.photograph?.border ?? "none";
  $("beside").value = state.beside;
  $("width").value = String(state.width);
  $("samples").value = String(state.samples);
  $("min-power").value = String(state.scene.trace?.min_power ?? 0.0001);
  $("exact").value = String(state.scene.trace?.exact ?? false);
  buildControls(device, kind, changed, state.embed);
  showCorners(device, changed);
  showShows(state, hello, setShow);
  showRotation(state);
  showMoment(state);
  showSplit(state, hello);
}

// The lamps of the page that a scene has no word for.
export const LAMPS = { lamp: { black_body_k: 2856 } };

// What makes the colors: a word, a lamp or one wavelength.
export function showSpectrum(spectrum = "auto") {
  const isOne = typeof spectrum === "number";
  const isLamp = JSON.stringify(spectrum) === JSON.stringify(LAMPS.lamp);
  const shown = isOne ? "wavelength" : isLamp ? "lamp" : typeof spectrum === "string" ? spectrum : "own";
  $("spectrum").value = shown;
  $("spectrum").querySelector('[value="own"]').hidden = shown !== "own";
  $("wavelength-label").hidden = !isOne;
  if (!isOne) return;
  $("wavelength").value = String(spectrum);
  $("wavelength-words").textContent = `${spectrum} nm`;
}

// The ways in which the scene's devices can be shown: each those that can.
function showShows(state, hello, setShow) {
  // Bare metal and mirrors have no core that could be open.
  const isOpen = state.devices.some(({ core }) => core === "open");
  const can = (show) => state.devices.some(({ kind }) => hello.kinds[kind]?.shows.includes(show)) && (show === "empty" || !isOpen);
  const segments = document.createElement("div");
  segments.className = "segments";
  const shown = state.devices.find(({ kind }) => hello.kinds[kind]?.shows.length > 1)?.show ?? "cloak";
  for (const show of ["cloak", "bare", "mirror", "empty"]) {
    if (show !== "cloak" && !can(show)) continue;
    const label = document.createElement("label");
    const radio = document.createElement("input");
    radio.type = "radio";
    radio.name = "show";
    radio.value = show;
    radio.checked = show === shown;
    radio.addEventListener("change", () => setShow(show));
    const word = document.createElement("span");
    word.textContent = say(`show.${show}`);
    label.append(radio, word);
    segments.append(label);
  }
  const legend = $("shows").querySelector("legend");
  const focused = $("shows").contains(document.activeElement);
  $("shows").replaceChildren(legend, segments);
  // What cannot be shown otherwise asks for no choice.
  $("shows").hidden = segments.childElementCount < 2;
  if (focused) segments.querySelector("input:checked")?.focus();
}

export function showRotation(state) {
  const degrees = state.device?.rotation ?? 0;
  const wrapped = ((((degrees + 180) % 360) + 360) % 360) - 180;
  $("rotation").value = String(wrapped);
  $("rotation").setAttribute("aria-valuetext", say("rotation.says", { r: number(wrapped) }));
  $("rotation-number").value = String(Number(wrapped.toFixed(2)));
  $("rotation").disabled = $("rotation-number").disabled = $("play").disabled = !state.device;
}

export function showMoment(state) {
  const isShown = state.moment !== null;
  $("flight").checked = isShown;
  document.querySelector(".moment").hidden = !isShown;
  if (isShown) $("moment").value = String(state.moment);
  // It has no false colors.
  $("map").disabled = isShown;
}

// The moment of the picture that is shown: as many digits as its length has.
export function showTime(time, open) {
  const digits = Math.max(0, Math.ceil(-Math.log10(open)) + 1);
  const words = `${number(Number(time.toFixed(digits)), digits)} ns`;
  $("moment-words").textContent = words;
  $("moment").setAttribute("aria-valuetext", words);
}

export function showSplit(state, hello) {
  const cloak = state.devices.find(({ kind }) => hello.kinds[kind]?.shows.length > 1);
  picture.layOut(state, say(cloak ? `side.${cloak.show ?? "cloak"}` : "side.scene"));
}
