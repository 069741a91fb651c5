// The page: what is done with it becomes a look, and what comes back is shown.

import { caption, isOwn, plainCaption } from "./caption.js";
import { LAMPS, fillLists, showMoment, showRotation, showSpectrum, showSplit, showState, showTime } from "./choices.js";
import { Connection } from "./connection.js";
import { writeFault } from "./faults.js";
import { animated, canRecord, recorded } from "./film.js";
import { gallery } from "./gallery.js";
import { watchDrops, watchKeys, watchPointer } from "./gestures.js";
import { words } from "./line.js";
import { tell, watchTerms } from "./notes.js";
import { ageNumbers, showNumbers, writeNumbers } from "./numbers.js";
import { picture, watchDivider } from "./picture.js";
import { sectionView } from "./section.js";
import { State, copy } from "./state.js";
import { guide, watchTour } from "./tour.js";
import { has, language, number, plain, say, setLanguage, write, writeAll } from "./words.js";

const $ = (id) => document.getElementById(id);

const state = new State();
let hello = null;
let playing = false;
// The point whose ray is followed: at first one before which most devices stand, whichever way they are turned.
let probing = [0.5, 0.51];
let wanted = 0;
let settle = 0;
// Whether the link was none, which is said until something else is wished.
let damaged = false;
// The film that is being made: what waits for its next picture, and whether something else has been wished since.
let filming = null;

// How fast the device turns, degrees a second; how long after the last change the picture is finished, ms.
const SPEED = 12;
const REST = 180;
// The moment at which light in flight is seen first: when some has come, and more is to come.
const EARLY = 0.15;

const connection = new Connection({ hello: greeted, picture: received, section, rays, numbers, progress, error: failed, saved, photograph: hung }, gone);

// --- What is asked for -------------------------------------------------------------------------------------------

const look = () => ({ scene: state.scene, size: state.size, samples: state.samples, beside: state.beside, moment: state.moment });

// Something has changed: a coarse picture now if it goes on, else the finished one.
function changed(moving = false) {
  clearTimeout(settle);
  damaged = false;
  filming?.stop();
  document.body.dataset.finished = "false";
  document.body.dataset.old = "true";
  ageNumbers();
  showCaption();
  if (gallery.isOpen) return;
  if (moving) {
    connection.look(look, true);
    settle = setTimeout(() => changed(false), REST);
    return;
  }
  if (playing) {
    connection.look(look, true);
    return;
  }
  wanted = connection.look(look, false) ?? wanted;
  history.replaceState(null, "", state.address());
  document.querySelector("#whole-page a").href = state.address(null);
}

function showCaption() {
  const text = caption(state, hello);
  if ($("caption").dataset.text === text) return;
  $("caption").dataset.text = text;
  write($("caption"), text);
}

function greeted(content) {
  hello = content;
  const same = hello.exhibits.find(({ scene }) => JSON.stringify(scene) === JSON.stringify(hello.scene));
  hello.first = hello.name ? null : (same?.name ?? null);
  follow(probing);
  enter();
}

// Shows what the address says.
function enter() {
  const asked = new URLSearchParams(location.hash.slice(1)).get("lang");
  if (asked) setLanguage(asked, false);
  if (/^#gallery(&|$)/.test(location.hash)) {
    if (!state.exhibit) state.open(hello.first ?? "opened", hello.scene);
    writePage();
    gallery.open(hello);
    connection.seen(wanted);
    nextCard();
    return;
  }
  gallery.close();
  const named = location.hash.length > 1;
  const before = state.embed;
  const linked = named && state.read(location.hash.slice(1), hello);
  const { image } = state.scene.photograph ?? {};
  // One that was brought, by its plain name, is gone with the page that it was brought to.
  const isLost = isOwn(image) && !/[\\/]/.test(image) && image !== hello.scene.photograph?.image;
  if (linked && isLost && !document.body.dataset.pictures) {
    delete state.scene.photograph;
    tell(say("copied.photograph"));
  }
  if (linked && state.unread.length) tell(say("unread", { parts: state.unread.join(", ") }));
  if (named ? !linked : !state.exhibit) state.open(hello.first ?? "opened", hello.scene);
  if (state.embed !== before && document.body.dataset.pictures) return location.reload();
  embed();
  $("banner").hidden = true;
  writePage();
  picture.mark(probing);
  changed();
  if (named && !linked) {
    damaged = true;
    $("banner-text").textContent = say("damaged");
    showBanner();
  }
}

// All words, in the language that is chosen.
function writePage() {
  writeAll();
  $("language").value = language;
  for (const option of $("min-power").options) option.textContent = `${number(100 * option.value, 4)} %`;
  if (!hello) return;
  fillLists(hello);
  showControls();
  $("play-word").textContent = say(playing ? "stop" : "turn");
  guide.write();
  showCaption();
  writeNumbers();
  sectionView.say();
}

// A view for a page of another: the picture, its caption, and one control.
function embed() {
  if (!state.embed) return;
  const key = state.embed;
  document.body.dataset.embed = key;
  if (key === "rotation") return;
  document.querySelector(".rotation").hidden = true;
  if (key === "moment") {
    state.moment ??= EARLY;
  } else if (key === "wavelength") {
    if (typeof state.scene.light?.spectrum !== "number") state.set("light", "spectrum", 550);
    $("caption").after($("wavelength-label"));
  } else {
    $("caption").after($("keys"));
  }
}

// --- What comes back ---------------------------------------------------------------------------------------------

function received(about, image) {
  if (gallery.isOpen) {
    if (gallery.show(about, image)) nextCard();
    else connection.seen(about.id);
    return;
  }
  picture.show(about, image, state);
  if (about.id >= wanted || playing) document.body.dataset.old = "false";
  document.body.dataset.pictures = String(Number(document.body.dataset.pictures ?? 0) + 1);
  // Finer ones are made from then on.
  if (about.last && about.id === wanted && !about.finished) requestAnimationFrame(() => setTimeout(() => connection.seen(about.id)));
  if (about.last && about.finished && filming && about.id === wanted) {
    filming.shown();
    return;
  }
  if (about.last && about.finished) {
    $("progress").hidden = true;
    document.body.dataset.finished = String(about.id === wanted);
  }
  if (about.view !== "scene") return;
  clearError();
  const { width: w, height: h, samples: n, min_power: power, finished } = about;
  const coarse = w < state.size[0] || power > 0.001;
  $("quality").textContent = plain(coarse ? "preview" : finished ? "done" : "state", { w, h, n, all: state.samples });
  if (!finished) $("progress").hidden = false;
  if (!finished && !coarse) $("progress").value = n / state.samples;
  // What one sees, for those who do not see it.
  if (finished && !playing) $("live").textContent = `${plain("finished", { n })}. ${plainCaption(state, hello)}`;
  showScale(about.scale);
  if (about.time_ns !== null) showTime(about.time_ns, about.open_ns);
  if (probing && (playing || finished || coarse)) connection.follow(probing);
}

function nextCard() {
  const look = gallery.next();
  if (look) connection.look(() => look, false);
}

function showScale(scale) {
  $("scale").hidden = !scale;
  if (!scale) return;
  // What rounding leaves of nothing is nothing.
  const least = 1e-4 * Math.max(Math.abs(scale.low), Math.abs(scale.high));
  const end = (value) => (value === null ? "–" : number(Number((Math.abs(value) < least ? 0 : value).toPrecision(3)), 9).replace("-", "−"));
  const [low, high] = [end(scale.low), end(scale.high)];
  const map = `map.${state.scene.picture?.map}`;
  const title = has(map) ? plain(map) : scale.title;
  const unit = scale.unit && scale.low !== scale.high ? `, ${scale.unit}` : "";
  // One number has no range of colors.
  const isOne = low === high;
  $("scale").classList.toggle("one", isOne);
  $("scale-low").textContent = low;
  $("scale-high").textContent = isOne ? "" : high;
  $("scale-title").textContent = isOne ? `${scale.unit && low !== "0" ? scale.unit : ""} ${say("same")}: ${title}`.trim() : `${title}${unit}`;
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

function showBanner(isOver = false) {
  $("retry").hidden = !isOver;
  $("banner").hidden = false;
}

function failed({ id, message, key }) {
  connection.failed(id);
  if (gallery.isOpen) return nextCard();
  filming?.stop();
  if (id !== null && id < wanted) return;
  writeFault($("banner-text"), message, key);
  showBanner();
  if (id === null) return;
  // What would be seen, if it could be, is not what is shown.
  delete $("caption").dataset.text;
  write($("caption"), say("see.fault"));
  $("progress").hidden = true;
}

function clearError() {
  if ($("retry").hidden && !damaged) $("banner").hidden = true;
}

function gone() {
  stop();
  filming?.stop();
  $("banner-text").textContent = say(hello ? words.lost : words.refused);
  showBanner(true);
}
$("retry").addEventListener("click", () => connection.open());

function saved({ text }) {
  download(new Blob([text], { type: "application/toml" }), "scene.toml");
}

function hung({ name }) {
  const photograph = state.table("photograph");
  photograph.image = name;
  delete photograph.width;
  changed();
  tell(say("hangs", { name }));
}

// --- What is chosen ----------------------------------------------------------------------------------------------

const showControls = () => showState(state, hello, { changed, setShow });

function setShow(show) {
  for (const device of state.devices) {
    if (!hello.kinds[device.kind]?.shows.includes(show)) continue;
    device.show = show;
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
  $("play-word").textContent = say("turn");
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
  $("play-word").textContent = say("stop");
  let before = performance.now();
  const turn = (now) => {
    if (!playing) return;
    requestAnimationFrame(turn);
    // No more often than there are pictures: all that says how it stands takes time from them.
    if (!connection.hasRoom) return;
    const seconds = Math.min(0.5, (now - before) / 1000);
    before = now;
    rotate((state.device?.rotation ?? 0) + SPEED * seconds, true);
    clearTimeout(settle);
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
    $("banner-text").textContent = say("too_large", { n: hello.largest_photograph_bytes >> 20 });
    showBanner();
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
  guide.close();
  gallery.close();
  const name = $("exhibit").value;
  // The way back is to what was shown before.
  history.pushState(null, "", location.href);
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
$("rotation-number").addEventListener("change", () => {
  const degrees = $("rotation-number").valueAsNumber;
  if (Number.isFinite(degrees)) rotate(degrees, false);
  else showRotation(state);
});
$("play").addEventListener("click", play);
$("beside").addEventListener("change", () => setBeside($("beside").value));
$("polarizer").addEventListener("change", () => {
  const word = $("polarizer").value;
  state.set("camera", "polarizer", word === "angle" ? $("angle").valueAsNumber || 0 : word);
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
function setMoment(moment, moving) {
  state.moment = moment;
  showMoment(state);
  changed(moving);
}
$("flight").addEventListener("change", () => setMoment($("flight").checked ? EARLY : null, false));
$("moment").addEventListener("input", () => setMoment($("moment").valueAsNumber, true));
$("moment").addEventListener("change", () => setMoment($("moment").valueAsNumber, false));
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
// Copies a text, and says so.
async function copyText(text, said) {
  try {
    await navigator.clipboard.writeText(text);
    tell(said);
  } catch {
    tell(say("copied.not"));
  }
}
$("copy-link").addEventListener("click", () => {
  history.replaceState(null, "", state.address());
  copyText(location.href, say(words.copied) + (isOwn(state.scene.photograph?.image) ? say("copied.photograph") : ""));
});
$("copy-embed").hidden = words.copied !== "copied" || location.protocol === "file:";
$("copy-embed").addEventListener("click", () => {
  const source = `${location.href.split("#")[0]}${state.address(state.moment === null ? "rotation" : "moment")}&lang=${language}`;
  copyText(`<iframe src="${source}" width="480" height="520" style="border: 0" allow="fullscreen" title="cloakroom"></iframe>`, say("embedded"));
});
// `make` is a way to make a film.
async function film(make) {
  if (filming || !state.device) return;
  stop();
  const before = state.device.rotation ?? 0;
  // Twice the pixels, which the canvas makes smaller, are four samples a pixel.
  const size = state.size.map((side) => Math.min(2048, 2 * side));
  const turn = (degrees) =>
    new Promise((resolve, reject) => {
      filming.shown = resolve;
      filming.stop = () => reject(new Error("stopped"));
      state.device.rotation = degrees;
      showRotation(state);
      wanted = connection.look(() => ({ ...look(), size, samples: 1 }), false) ?? wanted;
    });
  filming = { shown: () => {}, stop: () => {} };
  document.body.dataset.finished = "false";
  try {
    const blob = await make(picture.canvas, before, turn, (share) => tell(say("filming", { p: Math.round(100 * share) }), true));
    download(blob, `cloakroom.${blob.type.split("/")[1]}`);
    tell(say("filmed"));
  } catch (error) {
    $("toast").hidden = true;
    if (error.message !== "stopped") tell(String(error.message));
  }
  filming = null;
  state.device.rotation = before;
  showRotation(state);
  changed();
}
$("save-film").addEventListener("click", () => (canRecord() ? film(recorded) : tell(say("filmed.not"))));
$("save-gif").addEventListener("click", () => film(animated));
function fullScreen() {
  const view = document.querySelector(".view");
  if (document.fullscreenElement) document.exitFullscreen();
  else view.requestFullscreen?.();
}
$("full").addEventListener("click", fullScreen);
$("gallery").addEventListener("click", () => {
  guide.close();
  stop();
  if (gallery.isOpen) leaveGallery();
  else location.hash = "gallery";
});
function leaveGallery() {
  gallery.close();
  history.replaceState(null, "", state.address());
  changed();
}
function closeGallery() {
  leaveGallery();
  $("gallery").focus();
}
$("cards-close").addEventListener("click", closeGallery);
document.addEventListener("keydown", (event) => {
  if (event.key === "Escape" && gallery.isOpen) closeGallery();
});
$("language").addEventListener("change", () => {
  setLanguage($("language").value);
  writePage();
  if (gallery.isOpen) gallery.open(hello);
});
watchTour(
  ({ exhibit, device, beside = "nothing", polarizer }) => {
    stop();
    gallery.close();
    state.moment = null;
    const scene = copy(hello.exhibits.find(({ name }) => name === exhibit).scene);
    Object.assign(scene.device[0], { show: "cloak", ...device });
    state.open(exhibit, scene);
    state.set("camera", "polarizer", polarizer);
    setBeside(beside);
    showControls();
  },
  () => {
    state.set("camera", "polarizer", (state.scene.camera?.polarizer ?? "none") === "none" ? "horizontal" : "none");
    showControls();
    changed();
  },
);
watchTerms();
$("reset-camera").addEventListener("click", resetCamera);
watchDivider(state, () => {
  showSplit(state, hello);
  picture.draw(state);
});

watchPointer(state, { changed, follow, resetCamera, say: (word) => tell(say(word)) });
watchKeys({
  ready: () => hello !== null && !gallery.isOpen,
  play,
  rotate: (by) => rotate((state.device?.rotation ?? 0) + by, true),
  show: (show) => $("shows").querySelector(`input[value="${show}"]`)?.click(),
  split: () => setBeside(state.beside === "nothing" ? "bare" : "nothing"),
  full: fullScreen,
});
watchDrops(bring);
addEventListener("hashchange", () => {
  if (hello) enter();
});
writePage();
