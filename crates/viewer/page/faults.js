// What the program says of mistakes. It speaks English: on a German page, the sentences to which the page's own controls lead are said in
// German, and any other comes with a word that it is English.

import { language, nameOfKey, number, say } from "./words.js";

// `{key}` and `{by}` are names of keys, `{one}` and `{other}` devices; `{value}`, `{low}` and `{high}` numbers, maybe with a unit.
const SENTENCES = [
  ["{key} is {value}; it must be above {low} and below {high}", "{key} ist {value}; erlaubt ist, was zwischen {low} und {high} liegt"],
  ["{key} is {value}; it must be from {low} to {high}", "{key} ist {value}; erlaubt ist {low} bis {high}"],
  ["{key} is {value}; it must be from {low} to {high}, {least} to {most} times {by}", "{key} ist {value}; erlaubt ist {low} bis {high}, das {least}- bis {most}-Fache von {by}"],
  ["{key} is {value}; it must be above {low}", "{key} ist {value}; erlaubt ist, was größer als {low} ist"],
  ["{key} is {value}; it must be {low} or above", "{key} ist {value}; erlaubt ist {low} und mehr"],
  ["{key} is {value}; it must be at least {low}", "{key} ist {value}; erlaubt ist {low} und mehr"],
  ["{key} is {value}; it must be at most {high}", "{key} ist {value}; erlaubt ist höchstens {high}"],
  ["{key} is {value}; it must be smaller than {high}", "{key} ist {value}; erlaubt ist, was kleiner als {high} ist"],
  ["{key} is {value}; it must be at least as wide as the device, {low}, or 0 for none", "{key} ist {value}; nötig ist die Breite des Geräts, {low}, oder 0 für keinen"],
  ["a Gaussian map needs h/w < sqrt(pi)/2 = 0.886, not {value}; a lower or a wider bump would do", "h/w muss hier kleiner als 0,886 sein und ist {value}; die Kuppe muss niedriger oder breiter sein"],
  ["a grating needs 2 pi h/period < 1, not {value}; a lower or a wider bump would do", "2 pi h/Periode muss hier kleiner als 1 sein und ist {value}; die Kuppen müssen niedriger oder breiter sein"],
  ["prism {value} overlaps prism {low} (counted from 0); cut one of them", "Prisma {value} und Prisma {low} überlappen sich (gezählt wird ab 0)"],
  ["{other} overlaps {one}; move one of them (devices are counted from 0)", "{other} und {one} überlappen sich; eines von beiden muss woandershin (gezählt wird ab 0)."],
  ["{other} overlaps {one}, and both bodies have the same priority; give the one that is to be there the larger one (devices are counted from 0)",
    "{other} und {one} überlappen sich und haben denselben Vorrang; was dort sein soll, braucht den größeren (gezählt wird ab 0)."],
  ["the camera stands inside {one} (counted from 0), in metal or an opaque body; it must stand in air or in another medium",
    "Die Kamera steht in {one} (gezählt wird ab 0), in Metall oder einem undurchsichtigen Körper; sie muss in Luft oder einem anderen Medium stehen."],
  ["{one} (counted from 0) cuts through the photograph in the plane {plane}; move one of them",
    "{one} (gezählt wird ab 0) ragt durch das Foto in der Ebene {plane}; eines von beiden muss woandershin."],
  ["the photograph is too large: at most {n} million pixels", "Das Foto ist zu groß: Es darf {n} Millionen Bildpunkte haben."],
  ["this is not an image that can be read (PNG, JPEG or EXR)", "Das ist kein Bild, das hier gelesen werden kann (PNG, JPEG oder EXR)."],
  ["this is a {kind} image; only PNG, JPEG and EXR can be read", "Das ist ein Bild als {kind}; gelesen werden PNG, JPEG und EXR."],
  ["this is an EXR image, which this page cannot read; save it as PNG or JPEG, or open it with `cloakroom view`",
    "Das ist ein Bild als EXR, das diese Seite nicht lesen kann; sichere es als PNG oder JPEG, oder öffne es mit „cloakroom view“."],
  ["this image is damaged or cut short", "Dieses Bild ist beschädigt oder abgeschnitten."],
  ["a page can show the images, and take the grids, that came with the program or with the scene that was opened, and a photograph dropped onto it; it can open no file",
    "Diese Szene nennt eine Datei, und eine Seite kann keine öffnen: nur Bilder und Gitter des Programms und der Szene, die geöffnet wurde, und ein Foto, das auf sie gezogen wird."],
  ["a picture of {size} pixels needs {needed} MB of memory, but only {free} MB are free; make `camera.resolution` smaller",
    "Ein Bild mit {size} Bildpunkten braucht {needed} MB Speicher, frei sind nur {free} MB; wähle ein kleineres."],
  ["this scene could not be rendered: a mistake in the program", "Diese Szene konnte nicht berechnet werden: ein Fehler im Programm."],
  ["this scene could not be rendered: a mistake in the program, or no memory left", "Diese Szene konnte nicht berechnet werden: ein Fehler im Programm, oder kein Speicher mehr."],
];

const NUMBER = "-?[\\d.e-]+(?: [^\\s,]+)?";
const FORMS = { key: "\\S+", by: "\\S+", value: NUMBER, low: NUMBER, high: NUMBER, least: NUMBER, most: NUMBER };
const PATTERNS = SENTENCES.map(([english, german]) => {
  const escaped = english.replaceAll(/[.*+?^$()|[\]\\]/g, "\\$&");
  return [new RegExp(`^${escaped.replaceAll(/\{(\w+)\}/g, (_, name) => `(?<${name}>${FORMS[name] ?? ".+?"})`)}$`), german];
});

// Numbers without a power of ten, and what else is said as it is.
const decimal = (words) => words.replace(/^-?\d+\.\d+(?![\d.e])/, (digits) => number(Number(Number(digits).toPrecision(6)), 20));

const device = (words) => words.replace(/^device (\d+)/, "Gerät $1");

function inGerman(message) {
  for (const [pattern, german] of PATTERNS) {
    const found = pattern.exec(message);
    if (!found) continue;
    const put = { key: nameOfKey, by: nameOfKey, one: device, other: device };
    return german.replaceAll(/\{(\w+)\}/g, (_, name) => (put[name] ?? decimal)(found.groups[name]));
  }
  return undefined;
}

// Writes into an element what is wrong, and with which key of the scene.
export function writeFault(element, message, key) {
  const own = language === "de" ? inGerman(message) : undefined;
  const before = [language === "de" && !own ? say("fault.english") : "", key ? `${key}: ` : ""].join("");
  const words = document.createElement("span");
  words.textContent = own ?? message;
  if (!own) words.lang = "en";
  element.replaceChildren(before, words);
}
