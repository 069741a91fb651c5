// What is said beside the page: toasts that stay until they are read, and the glossary.

import { plain } from "./words.js";

const toast = document.getElementById("toast");
const words = document.getElementById("toast-text");
const gloss = document.getElementById("gloss");

// How long a toast stays, ms; as long as one points at it, it stays.
const STAY = 10000;
let leaving = 0;

export function tell(text, stays = false) {
  clearTimeout(leaving);
  toast.hidden = false;
  words.textContent = text;
  if (!stays) leave();
}

const leave = () => {
  clearTimeout(leaving);
  leaving = setTimeout(() => (toast.hidden = true), STAY);
};
toast.addEventListener("pointerenter", () => clearTimeout(leaving));
toast.addEventListener("pointerleave", leave);
toast.addEventListener("focusin", () => clearTimeout(leaving));
toast.addEventListener("focusout", leave);
document.getElementById("toast-close").addEventListener("click", () => (toast.hidden = true));

// The term that is explained.
let explained = null;

function explain(term) {
  if (explained === term) return;
  explained?.removeAttribute("aria-describedby");
  explained = term;
  gloss.hidden = !term;
  if (!term) return;
  gloss.textContent = plain(`term.${term.dataset.term}`);
  term.setAttribute("aria-describedby", "gloss");
  const [at, width] = [term.getBoundingClientRect(), document.documentElement.clientWidth];
  const size = gloss.getBoundingClientRect();
  const left = Math.max(8, Math.min(at.left, width - size.width - 8));
  const above = at.bottom + size.height + 8 > innerHeight;
  gloss.style.left = `${left}px`;
  gloss.style.top = `${above ? at.top - size.height - 4 : at.bottom + 4}px`;
}

// Over a term, or the words about it, these stay.
export function watchTerms() {
  const at = (event) => (event.target instanceof Element ? event.target.closest(".term") : null);
  document.addEventListener("pointerover", (event) => {
    if (event.target === gloss) return;
    if (at(event)) explain(at(event));
    else if (document.activeElement !== explained) explain(null);
  });
  document.addEventListener("focusin", (event) => explain(at(event)));
  document.addEventListener("click", (event) => {
    if (at(event)) explain(at(event));
  });
  document.addEventListener("keydown", (event) => {
    if (event.key === "Escape") explain(null);
  });
  addEventListener("scroll", () => explain(null), true);
}
