// The line to a worker of the page that does what the server of `cloakroom view` does. It is used as a WebSocket is.

// What is said when it has ended, and of links, which are good wherever the page can be reached.
export const words = { lost: "lost.worker", refused: "refused.worker", copied: "copied" };

class Line {
  readyState = WebSocket.CONNECTING;
  onmessage = null;
  onclose = null;

  constructor(worker) {
    this.worker = worker;
    worker.onmessage = ({ data }) => {
      if (data === null) return this.#close();
      this.readyState = WebSocket.OPEN;
      this.onmessage?.({ data });
    };
    worker.onerror = () => this.#close();
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

export function openLine() {
  const text = document.getElementById("worker")?.textContent;
  address ??= text ? URL.createObjectURL(new Blob([text], { type: "text/javascript" })) : new URL("worker.js", document.baseURI);
  const worker = new Worker(address, { name: "lead" });
  const packed = document.getElementById("compiled")?.textContent;
  worker.postMessage(packed ? { packed, text } : { address: new URL("cloakroom_bg.wasm", document.baseURI).href });
  return new Line(worker);
}
