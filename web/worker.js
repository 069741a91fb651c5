// A worker of the page: the one who leads, or a hand. The first says what the page says and hears; it starts the hands, which
// share no memory with it: they get orders, and send bytes. `tell`, `show`, `order`, `giveToHands`, `pause` and `handOver` are
// what the compiled part calls.

/* global wasm_bindgen */

// Each has the photograph in a memory of its own: 30 MB, and 300 MB if the page has brought the largest.
const MOST_HANDS = 8;

// Where hands are found, and they themselves.
let address = self.location.href;
const hands = [];
let tickets = 0;

const tell = (text) => postMessage(text);
const show = (bytes) => postMessage(bytes.buffer, [bytes.buffer]);
const pause = (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds));
const handOver = (ticket, bytes) => postMessage({ ticket, bytes }, [bytes.buffer]);

const order = (hand, about, work) =>
  new Promise((resolve, reject) => {
    const { worker, waiting } = hands[hand];
    const ticket = (tickets += 1);
    waiting.set(ticket, { resolve, reject });
    worker.postMessage({ ticket, about, work });
  });

const giveToHands = (name, bytes) => {
  photograph = { name, bytes: bytes.slice() };
  for (const { worker } of hands) worker.postMessage({ photograph });
};
let photograph = null;

// Starts a hand; who ends by a mistake breaks the promises it has given, and another takes its place, if it could begin at
// all.
function start(module, place) {
  let hasBegun = false;
  const worker = new Worker(address, { name: "hand" });
  const waiting = new Map();
  const fail = () => {
    // It may say so twice.
    worker.onmessage = worker.onerror = null;
    worker.terminate();
    if (hasBegun) start(module, place);
    else postMessage(null);
    for (const { reject } of waiting.values()) reject(new Error("a hand has ended"));
  };
  worker.onmessage = ({ data }) => {
    if (data === null) return fail();
    hasBegun = true;
    waiting.get(data.ticket)?.resolve(data.bytes);
    waiting.delete(data.ticket);
  };
  worker.onerror = (event) => {
    event.preventDefault();
    fail();
  };
  worker.postMessage({ module });
  if (photograph) worker.postMessage({ photograph });
  hands[place] = { worker, waiting };
}

// What is compiled: from an address, or from text in which it is packed. Not every web server knows the type that a browser asks
// for to compile while it loads.
async function loaded({ address, packed }) {
  if (!packed) {
    const response = await fetch(address);
    const typed = response.headers.get("content-type") === "application/wasm";
    return typed ? WebAssembly.compileStreaming(response) : WebAssembly.compile(await response.arrayBuffer());
  }
  const bytes = Uint8Array.from(atob(packed), (character) => character.charCodeAt(0));
  const unpacked = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return WebAssembly.compile(await new Response(unpacked).arrayBuffer());
}

async function lead(source) {
  // From a file, a worker may start those alone whose text it has itself.
  if (source.text) address = URL.createObjectURL(new Blob([source.text], { type: "text/javascript" }));
  const module = await loaded(source);
  const count = Math.min(navigator.hardwareConcurrency || 2, MOST_HANDS);
  for (let place = 0; place < count; place += 1) start(module, place);
  wasm_bindgen.initSync({ module });
  const lead = new wasm_bindgen.Lead(count);
  self.onmessage = ({ data }) => {
    if (typeof data === "string") lead.hear(data);
    else lead.takePhotograph(new Uint8Array(data));
  };
}

function work(module) {
  wasm_bindgen.initSync({ module });
  const hand = new wasm_bindgen.Hand();
  postMessage({});
  self.onmessage = ({ data }) => {
    if (data.photograph) hand.hang(data.photograph.name, data.photograph.bytes);
    else hand.order(data.ticket, data.about, data.work);
  };
}

// A mistake in the compiled part may come to light in a promise.
self.onunhandledrejection = (event) => {
  console.error(event.reason);
  postMessage(null);
};

// In a page that is one file it stands above.
if (typeof wasm_bindgen === "undefined") importScripts("cloakroom.js");
self.onmessage = ({ data }) => (self.name === "hand" ? work(data.module) : lead(data));
