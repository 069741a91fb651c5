// The guided tour: five steps from nothing to a cloak that needs a polarizer.

import { say, write } from "./words.js";

const $ = (id) => document.getElementById(id);

// What each step shows: an exhibit, and what is changed in it.
const STEPS = [
  { exhibit: "square-cloak", device: { show: "empty", rotation: 0 } },
  { exhibit: "square-cloak", device: { show: "bare", rotation: 0 } },
  { exhibit: "square-cloak", device: { rotation: 0 }, beside: "bare" },
  { exhibit: "square-cloak", device: { rotation: 10 } },
  { exhibit: "square-cloak-positive-uniaxial", device: { rotation: 0 }, polarizer: "horizontal" },
];

let step = -1;

export const guide = {
  get isOpen() {
    return step >= 0;
  },

  // Writes the step that is shown.
  write() {
    $("guide").hidden = step < 0;
    if (step < 0) return;
    $("guide-number").textContent = say("tour.of", { n: step + 1, all: STEPS.length });
    write($("guide-text"), say(`tour.${step + 1}`));
    $("guide-back").disabled = step === 0;
    $("guide-next").hidden = step === STEPS.length - 1;
    $("guide-polarizer").hidden = step < STEPS.length - 1;
  },

  close() {
    step = -1;
    guide.write();
  },
};

// `show` is told what each step shows, `polarize` to put the polarizer or take it away.
export function watchTour(show, polarize) {
  const go = (to) => {
    step = to;
    guide.write();
    show(STEPS[step]);
  };
  $("tour").addEventListener("click", () => {
    go(0);
    $("guide-next").focus();
  });
  $("guide-back").addEventListener("click", () => {
    go(step - 1);
    if (step === 0) $("guide-next").focus();
  });
  $("guide-next").addEventListener("click", () => {
    go(step + 1);
    if (step === STEPS.length - 1) $("guide-polarizer").focus();
  });
  $("guide-polarizer").addEventListener("click", polarize);
  $("guide-close").addEventListener("click", () => {
    guide.close();
    $("tour").focus();
  });
}
