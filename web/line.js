// The line to a worker of the page that does what the server of `cloakroom view` does. It is used as a WebSocket is.

// What is said when it has ended, and of links, which are good wherever the page can be reached.
export const words = { lost: "lost.worker", refused: "refused.worker", copied: "copied" };

class Line {
  readyState = WebSocket.CONNECTING;
  onclose = null;
  #listener = null;
  // What has come before there was a listener.
  #unheard = [];

  constructor(worker) {
    this.worker = worker;
    worker.onmessage = ({ data }) => {
      if (data === null) return this.#close();
      this.readyState = WebSocket.OPEN;
      if (this.#listener) this.#listener({ data });
      else this.#unheard.push(data);
    };
    worker.onerror = () => this.#close();
  }

  set onmessage(listener) {
    this.#listener = listener;
    for (const data of this.#unheard.splice(0)) listener({ data });
  }

  send(data) {
    this.worker.postMessage(data);
  }

  #close() {
    if (this.readyState === WebSocket.CLOSED) return;
    this.readyState = WebSocket.CLOSED;
    // Its hands end with it.
    this.worker.terminate();
    this.onclose?.();
  }
}

// A page that is one file has its worker, and what is compiled, as texts.
let address = null;

function begin() {
  const text = document.getElementById("worker")?.textContent;
  address ??= text ? URL.createObjectURL(new Blob([text], { type: "text/javascript" })) : new URL("worker.js", document.baseURI);
  const worker = new Worker(address, { name: "lead" });
  const packed = document.getElementById("compiled")?.textContent;
  worker.postMessage(packed ? { packed, text } : { address: new URL("cloakroom_bg.wasm", document.baseURI).href });
  return new Line(worker);
}

// The first begins before the rest of the page is there: it is compiled meanwhile. If it has ended by then, another takes its place.
let first = begin();

export function openLine() {
  const line = first?.readyState === WebSocket.CLOSED ? begin() : (first ?? begin());
  first = null;
  return line;
}
