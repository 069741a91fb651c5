// Numbers for people, and the tables of them.

import { number, say, write } from "./words.js";

const tables = { plain: document.getElementById("plain-numbers"), expert: document.getElementById("numbers") };
const note = document.getElementById("numbers-note");

const NONE = "–";

// Below this, ns or shares of all light, a number is what rounding leaves of nothing.
const NOTHING = 1e-9;

const isNone = (value) => value === null || value === undefined;

export function percent(share) {
  if (isNone(share)) return NONE;
  const value = 100 * share;
  if (Math.abs(share) < NOTHING) return "0 %";
  if (Math.abs(value) < 0.01) return `< ${number(0.01, 2)} %`;
  // All is said of what is all: 99.97 % are not.
  const shown = value < 100 && value > 99.9 ? Math.floor(value * 100) / 100 : value;
  return `${number(shown, value < 1 || (value > 99.9 && value < 99.995) ? 2 : 1)} %`;
}

const UNITS = [[1, "ns"], [1e-3, "ps"], [1e-6, "fs"], [1e-9, "as"]];

// A time in ns, in a unit that suits it.
export function time(ns, signed = false) {
  if (isNone(ns)) return NONE;
  if (Math.abs(ns) < NOTHING) return "0";
  const [size, unit] = UNITS.find(([size]) => Math.abs(ns) >= size);
  const sign = ns < 0 ? "−" : signed ? "+" : "";
  return `${sign}${number(Number((Math.abs(ns) / size).toPrecision(3)), 3)} ${unit}`;
}

const fixed = (value, digits) => (isNone(value) ? NONE : number(Number(value.toFixed(digits)), digits));

// The numbers that are shown, and whether something has changed since they came.
let shown = null;
let isOld = false;

export function ageNumbers() {
  if (!shown || isOld) return;
  isOld = true;
  writeNumbers();
}

export function showNumbers(numbers) {
  shown = numbers;
  isOld = false;
  writeNumbers();
}

function fill(table, rows) {
  table.classList.toggle("old", isOld);
  table.tBodies[0].replaceChildren(
    ...rows.map(([name, value]) => {
      const row = document.createElement("tr");
      const head = document.createElement("th");
      head.scope = "row";
      write(head, say(name));
      const cell = document.createElement("td");
      cell.textContent = value;
      row.append(head, cell);
      return row;
    }),
  );
}

export function writeNumbers() {
  if (!shown) return;
  const misses = shown.displacement_rms_cm;
  fill(tables.plain, [
    ["n.place", percent(shown.in_place_share)],
    ...(isNone(shown.bare_in_place_share) ? [] : [["n.bare", percent(shown.bare_in_place_share)]]),
    ["n.late", time(shown.time_of_flight_difference_mean_ns, true)],
  ]);
  fill(tables.expert, [
    ["n.delivered", percent(shown.delivered)],
    ["n.escaped", percent(shown.escaped)],
    ["n.absorbed", percent(shown.absorbed)],
    ["n.pruned", percent(shown.pruned)],
    ["n.most", time(shown.time_of_flight_difference_maximum_ns, true)],
    ["n.misses", isNone(misses) ? NONE : `${fixed(misses, 2)} cm`],
    ["n.ideal", fixed(shown.to_ideal.structural_similarity, 3)],
    ["n.empty", fixed(shown.to_empty.structural_similarity, 3)],
    ["n.bare.empty", fixed(shown.bare_to_empty?.structural_similarity, 3)],
  ]);
  note.textContent = isOld ? say("n.old") : say("n.note", { s: percent(shown.silhouette_share), w: shown.width_pixels, h: shown.height_pixels });
}
