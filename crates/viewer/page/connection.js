// What is said to the end of the line, the server or a worker, and heard from it. What moves is asked for two pictures at a time, so that one is made while the other is
// shown; what stands still at once, which cancels all that is under way.

import { openLine } from "./line.js";

// How many pictures of what moves are under way.
const AHEAD = 2;

// One that does not come within this time, ms, is given up.
const PATIENCE = 3000;

export class Connection {
  // `heard` has a function for each kind of message; `closed` is told when nobody is at the other end.
  constructor(heard, closed) {
    this.heard = heard;
    this.closed = closed;
    this.id = 0;
    this.ray = 0;
    this.open();
  }

  open() {
    const line = openLine();
    line.onmessage = (event) => {
      if (typeof event.data === "string") {
        for (const [kind, content] of Object.entries(JSON.parse(event.data))) this.heard[kind]?.(content);
      } else {
        this.#receive(event.data);
      }
    };
    line.onclose = () => {
      if (this.line === line) this.closed();
    };
    this.line = line;
    // Pictures under way, and the look that comes next.
    this.waiting = [];
    this.next = null;
  }

  get isOpen() {
    return this.line.readyState === WebSocket.OPEN;
  }

  // Whether a picture of what moves would be asked for now.
  get hasRoom() {
    this.#giveUp();
    return this.waiting.length < AHEAD;
  }

  // Those that do not come.
  #giveUp() {
    const now = performance.now();
    this.waiting = this.waiting.filter(({ since }) => now - since < PATIENCE);
  }

  #receive(buffer) {
    const length = new DataView(buffer).getUint32(0, true);
    const caption = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
    const pixels = new Uint8ClampedArray(buffer, 4 + length);
    this.heard.picture?.(caption, new ImageData(pixels, caption.width, caption.height));
    if (caption.last) this.#arrived(caption.id);
  }

  // A picture has come, or never will; those that were asked for before it have been passed over.
  #arrived(id) {
    this.waiting = this.waiting.filter((one) => one.id > id);
    const next = this.next;
    this.next = null;
    if (next) this.look(next, true);
  }

  // Asks for a picture of what `look` says; `moving` if another will follow at once. Returns its number, if it was asked for now.
  look(look, moving) {
    if (!this.isOpen) return undefined;
    if (!moving) this.waiting = [];
    this.next = null;
    if (!this.hasRoom) {
      this.next = look;
      return undefined;
    }
    const id = ++this.id;
    if (moving) this.waiting.push({ id, since: performance.now() });
    this.#say({ look: { id, moving, ...look() } });
    return id;
  }

  // An error has come instead of a picture.
  failed(id) {
    if (id !== null) this.#arrived(id);
  }

  // Says that a picture of a look is on the screen.
  seen(id) {
    if (this.isOpen) this.#say({ seen: { id } });
  }

  // Asks for the ray of a point of the picture.
  follow(at) {
    if (this.isOpen) this.#say({ ray: { id: ++this.ray, at } });
  }

  save(scene) {
    if (this.isOpen) this.#say({ save: { scene } });
  }

  async photograph(name, file) {
    if (!this.isOpen) return;
    const bytes = await file.arrayBuffer();
    this.#say({ photograph: { name } });
    this.line.send(bytes);
  }

  #say(message) {
    this.line.send(JSON.stringify(message));
  }
}
