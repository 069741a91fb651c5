// Numbers for people, and the table of them.

const body = document.querySelector("#numbers tbody");
const note = document.getElementById("numbers-note");

const NONE = "–";

const RAISED = { "+": "", "-": "⁻", ...Object.fromEntries([..."⁰¹²³⁴⁵⁶⁷⁸⁹"].map((c, i) => [i, c])) };

export function percent(share) {
  if (share === null || share === undefined) return NONE;
  const value = 100 * share;
  if (value !== 0 && Math.abs(value) < 0.01) {
    const [digits, exponent] = value.toExponential(0).split("e");
    return `${digits} × 10${exponent.replace(/./g, (c) => RAISED[c])} %`;
  }
  return `${value.toFixed(value >= 99.995 || value === 0 ? 0 : value < 1 ? 2 : 1)} %`;
}

const UNITS = [[1, "ns"], [1e-3, "ps"], [1e-6, "fs"], [1e-9, "as"], [1e-12, "zs"], [1e-15, "ys"]];

// A time in ns, in a unit that suits it.
export function time(ns, signed = false) {
  if (ns === null || ns === undefined) return NONE;
  if (ns === 0) return "0 ns";
  const [size, unit] = UNITS.find(([size]) => Math.abs(ns) >= size) ?? UNITS[UNITS.length - 1];
  const value = ns / size;
  const sign = value < 0 ? "−" : signed ? "+" : "";
  return `${sign}${Math.abs(value).toPrecision(3)} ${unit}`;
}

const plain = (value, digits) => (value === null || value === undefined ? NONE : value.toFixed(digits));

// Says that something has changed since the numbers came.
export function ageNumbers() {
  if (body.childElementCount === 0) return;
  body.parentElement.classList.add("old");
  note.textContent = "Of the view before; those of this one come when it rests.";
}

export function showNumbers(numbers) {
  body.parentElement.classList.remove("old");
  const rows = [
    ["Delivered from the photograph", percent(numbers.delivered)],
    ["Light from the surroundings", percent(numbers.escaped)],
    ["Absorbed", percent(numbers.absorbed)],
    ["Pruned, not followed", percent(numbers.pruned)],
    ["Time-of-flight difference, mean", time(numbers.time_of_flight_difference_mean_ns, true)],
    ["Time-of-flight difference, largest", time(numbers.time_of_flight_difference_maximum_ns, true)],
    ["Light misses its place by, rms", numbers.displacement_rms_cm === null ? NONE : `${plain(numbers.displacement_rms_cm, 2)} cm`],
    ["Likeness to what it should look like", plain(numbers.to_ideal.structural_similarity, 3)],
    ["Likeness to the empty view", plain(numbers.to_empty.structural_similarity, 3)],
    ["Bare metal’s likeness to the empty view", plain(numbers.bare_to_empty?.structural_similarity, 3)],
  ];
  body.replaceChildren(
    ...rows.map(([name, value]) => {
      const row = document.createElement("tr");
      const head = document.createElement("th");
      head.scope = "row";
      head.textContent = name;
      const cell = document.createElement("td");
      cell.textContent = value;
      row.append(head, cell);
      return row;
    }),
  );
  const share = percent(numbers.silhouette_share);
  note.textContent =
    `Means over the pixels that meet a device (${share} of ${numbers.width_pixels} × ${numbers.height_pixels}). ` +
    "Likeness is the structural similarity (SSIM): 1 is the same.";
}
