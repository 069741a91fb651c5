// The WebSocket to the server. What moves is asked for one picture at a time; what stands still at once, which cancels
// all that is under way.

// A picture that moves and does not come within this time, ms, is given up.
const PATIENCE = 3000;

export class Connection {
  // `heard` has a function for each kind of message; `closed` is told when the server is gone.
  constructor(heard, closed) {
    this.heard = heard;
    this.closed = closed;
    this.id = 0;
    this.ray = 0;
    this.waiting = null;
    this.next = null;
    this.open();
  }

  open() {
    const socket = new WebSocket(`ws://${location.host}/session`);
    socket.binaryType = "arraybuffer";
    socket.onmessage = (event) => {
      if (typeof event.data === "string") {
        for (const [kind, content] of Object.entries(JSON.parse(event.data))) this.heard[kind]?.(content);
      } else {
        this.#receive(event.data);
      }
    };
    socket.onclose = () => {
      if (this.socket === socket) this.closed();
    };
    this.socket = socket;
    this.waiting = null;
    this.next = null;
  }

  get isOpen() {
    return this.socket.readyState === WebSocket.OPEN;
  }

  #receive(buffer) {
    const length = new DataView(buffer).getUint32(0, true);
    const caption = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
    const pixels = new Uint8ClampedArray(buffer.slice(4 + length));
    this.heard.picture?.(caption, new ImageData(pixels, caption.width, caption.height));
    if (this.waiting && caption.id === this.waiting.id && caption.last) this.#arrived();
  }

  #arrived() {
    this.waiting = null;
    const next = this.next;
    this.next = null;
    if (next) this.look(next.look, true);
  }

  // Asks for a picture of what `look` says; `moving` if another will follow at once. Returns its number, if it was asked for now.
  look(look, moving) {
    if (!this.isOpen) return undefined;
    if (moving && this.waiting && performance.now() - this.waiting.since < PATIENCE) {
      this.next = { look };
      return undefined;
    }
    this.next = null;
    const id = ++this.id;
    this.waiting = moving ? { id, since: performance.now() } : null;
    this.#say({ look: { id, moving, ...look() } });
    return id;
  }

  // An error has come instead of a picture.
  failed(id) {
    if (this.waiting && id === this.waiting.id) this.#arrived();
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
    this.socket.send(bytes);
  }

  #say(message) {
    this.socket.send(JSON.stringify(message));
  }
}
