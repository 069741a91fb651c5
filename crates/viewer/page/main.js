// The page: what is done with it becomes a look, and what comes back is shown.

import { LAMPS, fillLists, showRotation, showSpectrum, showSplit, showState } from "./choices.js";
import { Connection } from "./connection.js";
import { watchDrops, watchKeys, watchPointer } from "./gestures.js";
import { words } from "./line.js";
import { ageNumbers, percent, showNumbers } from "./numbers.js";
import { picture, watchDivider } from "./picture.js";
import { sectionView } from "./section.js";
import { State, copy } from "./state.js";

const $ = (id) => document.getElementById(id);

const state = new State();
let hello = null;
let playing = false;
// The point whose ray is followed: at first one that most devices stand before.
let probing = [0.5, 0.47];
let wanted = 0;
let settle = 0;
// Whether the link was none, which is said until something else is wished.
let damaged = false;

// How fast the device turns, degrees a second; how long after the last change the picture is finished, ms.
const SPEED = 12;
const REST = 180;

const connection = new Connection({ hello: greeted, picture: received, section, rays, numbers, progress, error: failed, saved, photograph: hung }, gone);

// --- What is asked for -------------------------------------------------------------------------------------------

const look = () => ({ scene: state.scene, size: state.size, samples: state.samples, beside: state.beside });

// Something has changed: a coarse picture now if it goes on, else the finished one.
function changed(moving = false) {
  clearTimeout(settle);
  damaged = false;
  document.body.dataset.finished = "false";
  ageNumbers();
  if (moving) {
    connection.look(look, true);
    settle = setTimeout(() => changed(false), REST);
    return;
  }
  if (playing) return connection.look(look, true);
  wanted = connection.look(look, false) ?? wanted;
  history.replaceState(null, "", `#${state.toFragment()}`);
}

function greeted(content) {
  hello = content;
  fillLists(hello);
  const named = location.hash.length > 1;
  const linked = named && state.fromFragment(location.hash.slice(1));
  if (named ? !linked : !state.exhibit) state.open("opened", hello.scene);
  $("banner").hidden = true;
  showControls();
  picture.mark(probing);
  changed();
  if (named && !linked) {
    damaged = true;
    $("banner-text").textContent = "This link is damaged: it holds no scene. Here is the one that was opened.";
    $("retry").hidden = true;
    $("banner").hidden = false;
  }
}

// --- What comes back ---------------------------------------------------------------------------------------------

function received(caption, image) {
  picture.show(caption, image, state);
  document.body.dataset.pictures = String(Number(document.body.dataset.pictures ?? 0) + 1);
  // Finer ones are made from then on.
  if (caption.last && caption.id === wanted && !caption.finished) requestAnimationFrame(() => setTimeout(() => connection.seen(caption.id)));
  if (caption.last && caption.finished) {
    $("progress").hidden = true;
    document.body.dataset.finished = String(caption.id === wanted);
  }
  if (caption.view !== "scene") return;
  clearError();
  const { width, height, samples, min_power: power, finished } = caption;
  const each = samples === 1 ? "1 sample" : `${samples} samples`;
  const coarse = width < state.size[0];
  $("quality").textContent = coarse || power > 0.001
    ? `Preview: ${width} × ${height}, ${each} a pixel, branches above ${percent(power)}`
    : `${width} × ${height}, ${each} a pixel${finished ? "" : ` of ${state.samples}`}`;
  if (!finished) $("progress").hidden = false;
  if (!finished && !coarse) $("progress").value = samples / state.samples;
  if (finished && !playing) $("live").textContent = `Finished: ${each} a pixel`;
  showScale(caption.scale);
  if (probing && (playing || finished || coarse)) connection.follow(probing);
}

function showScale(scale) {
  $("scale").hidden = !scale;
  if (!scale) return;
  // What rounding leaves of nothing is nothing.
  const least = 1e-4 * Math.max(Math.abs(scale.low), Math.abs(scale.high));
  const number = (value) =>
    value === null ? "–" : Number((Math.abs(value) < least ? 0 : value).toPrecision(3)).toString().replace("-", "−");
  $("scale-low").textContent = number(scale.low);
  $("scale-high").textContent = number(scale.high);
  $("scale-title").textContent = scale.unit ? `${scale.title}, ${scale.unit}` : scale.title;
}

function section(content) {
  sectionView.show(content);
}

function rays(content) {
  if (probing) sectionView.rays(content);
}

function numbers(content) {
  if (content.id >= wanted) showNumbers(content);
}

function progress({ id, samples, share }) {
  if (id < wanted) return;
  $("progress").hidden = false;
  $("progress").value = (samples * share) / state.samples;
}

function failed({ id, message, key }) {
  connection.failed(id);
  if (id !== null && id < wanted) return;
  $("banner-text").textContent = key ? `${key}: ${message}` : message;
  $("retry").hidden = true;
  $("banner").hidden = false;
  $("progress").hidden = true;
}

function clearError() {
  if ($("retry").hidden && !damaged) $("banner").hidden = true;
}

function gone() {
  stop();
  $("banner-text").textContent = hello ? words.lost : words.refused;
  $("banner").hidden = false;
  $("retry").hidden = false;
}
$("retry").addEventListener("click", () => connection.open());

function saved({ text }) {
  download(new Blob([text], { type: "application/toml" }), "scene.toml");
}

function hung({ name }) {
  const photograph = state.table("photograph");
  photograph.image = name;
  delete photograph.width;
  $("live").textContent = `The photograph ${name} hangs behind the device`;
  changed();
}

// --- What is chosen ----------------------------------------------------------------------------------------------

const showControls = () => showState(state, hello, { changed, setShow });

function setShow(show) {
  for (const device of state.devices) {
    if (!hello.kinds[device.kind]?.shows.includes(show)) continue;
    device.show = show;
    // Bare metal and mirrors have no core that could be open.
    if (show !== "cloak") delete device.core;
  }
  showControls();
  changed();
}

function rotate(degrees, moving) {
  if (!state.device || !Number.isFinite(degrees)) return;
  state.device.rotation = Math.round((((((degrees + 180) % 360) + 360) % 360) - 180) * 1e3) / 1e3;
  showRotation(state);
  changed(moving);
}

function setBeside(beside) {
  state.beside = beside;
  $("beside").value = beside;
  picture.forget();
  showSplit(state, hello);
  changed();
}

function stop() {
  if (!playing) return;
  playing = false;
  $("play").setAttribute("aria-pressed", "false");
  $("play-word").textContent = "Turn";
}

function play() {
  if (playing) {
    stop();
    changed();
    return;
  }
  if (!state.device || !connection.isOpen) return;
  playing = true;
  $("play").setAttribute("aria-pressed", "true");
  $("play-word").textContent = "Stop";
  let before = performance.now();
  const turn = (now) => {
    if (!playing) return;
    const seconds = Math.min(0.2, (now - before) / 1000);
    before = now;
    rotate((state.device?.rotation ?? 0) + SPEED * seconds, true);
    clearTimeout(settle);
    requestAnimationFrame(turn);
  };
  requestAnimationFrame(turn);
}

function download(blob, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

function bring(file) {
  if (!file) return;
  if (hello && file.size > hello.largest_photograph_bytes) {
    failed({ id: null, message: `a photograph may have ${hello.largest_photograph_bytes >> 20} MiB` });
    return;
  }
  // The server takes plain names of 200 bytes: the end, with what kind of file it is.
  const end = Array.from(file.name.replaceAll(/[\\/:\p{Cc}\p{Cs}]/gu, "_")).slice(-50).join("");
  const name = end.replace(/^[.\-]+/, "") || "photograph";
  connection.photograph(name, file);
}

function resetCamera() {
  const exhibit = hello.exhibits.find(({ name }) => name === state.exhibit);
  const camera = copy((exhibit?.scene ?? hello.scene).camera ?? {});
  const { polarizer } = state.scene.camera ?? {};
  if (polarizer !== undefined) camera.polarizer = polarizer;
  state.scene.camera = camera;
  changed();
}

function follow(at) {
  probing = at;
  picture.mark(at);
  // The first picture asks for its rays itself.
  if (at && document.body.dataset.pictures) connection.follow(at);
  else sectionView.clear();
}

$("exhibit").addEventListener("change", () => {
  const name = $("exhibit").value;
  const exhibit = hello.exhibits.find((one) => one.name === name);
  state.open(name, exhibit?.scene ?? hello.scene);
  showControls();
  changed();
});
$("which").addEventListener("change", () => {
  state.which = Number($("which").value);
  showControls();
});
$("rotation").addEventListener("input", () => rotate($("rotation").valueAsNumber, true));
$("rotation").addEventListener("change", () => rotate($("rotation").valueAsNumber, false));
$("rotation-number").addEventListener("change", () => rotate($("rotation-number").valueAsNumber, false));
$("play").addEventListener("click", play);
$("beside").addEventListener("change", () => setBeside($("beside").value));
$("polarizer").addEventListener("change", () => {
  const word = $("polarizer").value;
  state.set("camera", "polarizer", word === "angle" ? $("angle").valueAsNumber : word);
  showControls();
  changed();
});
$("angle").addEventListener("change", () => {
  if (!Number.isFinite($("angle").valueAsNumber)) return;
  state.set("camera", "polarizer", $("angle").valueAsNumber);
  changed();
});
$("bandwidth").addEventListener("change", () => {
  const given = $("bandwidth").value !== "";
  if (given && !Number.isFinite($("bandwidth").valueAsNumber)) return;
  state.set("light", "bandwidth_nm", given ? $("bandwidth").valueAsNumber : undefined);
  changed();
});
function setSpectrum(spectrum, moving) {
  state.set("light", "spectrum", spectrum);
  showSpectrum(spectrum);
  changed(moving);
}
$("spectrum").addEventListener("change", () => {
  const word = $("spectrum").value;
  if (word === "own") return showSpectrum(state.scene.light?.spectrum);
  const lit = word === "wavelength" ? $("wavelength").valueAsNumber : (LAMPS[word] ?? word);
  return setSpectrum(lit === "auto" ? undefined : copy(lit), false);
});
$("wavelength").addEventListener("input", () => setSpectrum($("wavelength").valueAsNumber, true));
$("wavelength").addEventListener("change", () => setSpectrum($("wavelength").valueAsNumber, false));
$("map").addEventListener("change", () => {
  const map = $("map").value;
  state.set("picture", "map", map === "none" ? undefined : map);
  changed();
});
$("border").addEventListener("change", () => {
  const border = $("border").value;
  state.set("photograph", "border", border === "none" ? undefined : border);
  changed();
});
$("width").addEventListener("change", () => {
  state.width = Number($("width").value);
  changed();
});
$("samples").addEventListener("change", () => {
  state.samples = Number($("samples").value);
  changed();
});
$("min-power").addEventListener("change", () => {
  state.set("trace", "min_power", Number($("min-power").value));
  changed();
});
$("exact").addEventListener("change", () => {
  state.set("trace", "exact", $("exact").value === "true" ? true : undefined);
  changed();
});
$("whole").addEventListener("change", () => {
  sectionView.whole = $("whole").checked;
  sectionView.fit();
});
$("photograph").addEventListener("change", () => {
  bring($("photograph").files[0]);
  $("photograph").value = "";
});
$("save-picture").addEventListener("click", async () => download(await picture.toBlob(), "cloakroom.png"));
$("save-scene").addEventListener("click", () => {
  const scene = copy(state.scene);
  scene.camera = { ...scene.camera, resolution: state.size, samples: state.samples };
  connection.save(scene);
});
$("copy-link").addEventListener("click", async () => {
  history.replaceState(null, "", `#${state.toFragment()}`);
  try {
    await navigator.clipboard.writeText(location.href);
    $("live").textContent = "The link is copied";
    $("quality").textContent = "The link is copied";
  } catch {
    $("quality").textContent = "The link is in the address bar";
  }
});
$("reset-camera").addEventListener("click", resetCamera);
watchDivider(state, () => {
  showSplit(state, hello);
  picture.draw(state);
});

watchPointer(state, { changed, follow, resetCamera, say: (words) => ($("live").textContent = words) });
watchKeys({
  ready: () => hello !== null,
  play,
  rotate: (by) => rotate((state.device?.rotation ?? 0) + by, true),
  show: (show) => $("shows").querySelector(`input[value="${show}"]`)?.click(),
  split: () => setBeside(state.beside === "nothing" ? "bare" : "nothing"),
});
watchDrops(bring);
addEventListener("hashchange", () => {
  if (hello) greeted(hello);
});
