// All devices as a page of pictures, each made by the page itself while one looks, and each opening live.

import { groups, nameOf } from "./caption.js";
import { say } from "./words.js";

const cards = document.getElementById("cards");
const list = document.getElementById("card-groups");
const opener = document.getElementById("gallery");

const WIDTH = 200;

// Exhibits without a picture yet, and the one that is being made.
let waiting = [];
let made = null;

export const gallery = {
  get isOpen() {
    return !cards.hidden;
  },

  open(hello) {
    cards.hidden = false;
    document.querySelector("main").hidden = true;
    opener.setAttribute("aria-expanded", "true");
    const pictures = new Map(Array.from(list.querySelectorAll("canvas"), (canvas) => [canvas.dataset.name, canvas]));
    waiting = [];
    list.replaceChildren(
      ...groups(hello).flatMap(([group, names]) => {
        const title = document.createElement("h3");
        title.textContent = say(`group.${group}`);
        const row = document.createElement("div");
        row.className = "cards";
        for (const name of names) {
          const card = document.createElement("a");
          card.href = `#${name}`;
          let canvas = pictures.get(name);
          if (!canvas) {
            canvas = document.createElement("canvas");
            canvas.dataset.name = name;
            [canvas.width, canvas.height] = [WIDTH, (WIDTH * 3) / 4];
          }
          if (!canvas.dataset.made) waiting.push({ canvas, scene: hello.exhibits.find((one) => one.name === name).scene });
          const words = document.createElement("span");
          words.textContent = nameOf(name);
          card.append(canvas, words);
          row.append(card);
        }
        return [title, row];
      }),
    );
  },

  close() {
    if (!cards.hidden) scrollTo(0, 0);
    cards.hidden = true;
    document.querySelector("main").hidden = false;
    opener.setAttribute("aria-expanded", "false");
    waiting = [];
    made = null;
  },

  // The look that is to be made next; none when all are made.
  next() {
    made = waiting.shift();
    if (!made) return null;
    const { scene } = made;
    const [w, h] = scene.camera?.resolution ?? [4, 3];
    const size = [WIDTH, Math.round((WIDTH * h) / w)];
    return { scene, size, samples: 1, beside: "nothing" };
  },

  // Takes a picture; whether it is the one that was waited for, finished.
  show(caption, image) {
    if (!made || caption.width !== WIDTH) return false;
    const { canvas } = made;
    [canvas.width, canvas.height] = [caption.width, caption.height];
    canvas.getContext("2d").putImageData(image, 0, 0);
    if (caption.finished) canvas.dataset.made = "true";
    return caption.finished;
  },
};
