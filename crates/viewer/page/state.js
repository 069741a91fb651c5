// What the page shows: a scene as the tables of a scene file, and how it is looked at. All of it fits into the address.

export const copy = (value) => JSON.parse(JSON.stringify(value));

const BESIDE = ["bare", "empty", "mirror"];

export class State {
  constructor() {
    this.exhibit = "";
    this.scene = {};
    this.beside = "nothing";
    this.divider = 0.5;
    this.width = 640;
    this.samples = 16;
    this.which = 0;
    // Light in flight: the moment, as a share of the time in which it arrives; null for the picture.
    this.moment = null;
    // The one key that an embedded view lets one change; none on the whole page.
    this.embed = null;
    // The parts of the address that was read last that say nothing.
    this.unread = [];
  }

  // The scene's devices.
  get devices() {
    return Array.isArray(this.scene.device) ? this.scene.device : [];
  }

  // The device whose parameters are shown.
  get device() {
    return this.devices[Math.min(this.which, this.devices.length - 1)];
  }

  table(name) {
    this.scene[name] ??= {};
    return this.scene[name];
  }

  // Sets a key of a table, or leaves it out.
  set(table, key, value) {
    const entries = this.table(table);
    if (value === undefined) delete entries[key];
    else entries[key] = value;
    if (Object.keys(entries).length === 0) delete this.scene[table];
  }

  open(exhibit, scene) {
    this.exhibit = exhibit;
    this.scene = copy(scene);
    const picked = this.devices.findIndex((device) => device.kind !== "body");
    this.which = Math.max(0, picked);
  }

  // Width and height of the full picture: the scene's ratio, the chosen width.
  get size() {
    const [w, h] = this.scene.camera?.resolution ?? [4, 3];
    return [this.width, Math.max(1, Math.min(2048, Math.round((this.width * h) / w)))];
  }

  toFragment() {
    const { exhibit, scene, beside, divider, width, samples, which, moment } = this;
    const text = JSON.stringify({ exhibit, scene, beside, divider, width, samples, which, moment });
    const bytes = new TextEncoder().encode(text);
    const binary = Array.from(bytes, (byte) => String.fromCharCode(byte)).join("");
    return btoa(binary).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
  }

  // The fragment of the address, with what is said beside the state.
  address(embed = this.embed) {
    return `#${this.toFragment()}${embed ? `&embed=${embed}` : ""}`;
  }

  // Reads the fragment of an address: the name of an exhibit or a state, and, each after `&`, what is changed in it. Returns whether
  // it says what to show; one that changes the scene that is open does.
  read(fragment, hello) {
    const parts = fragment.split("&");
    const said = new URLSearchParams(parts.filter((part) => part.includes("=")).join("&"));
    const shown = parts.find((part) => !part.includes("="));
    const exhibit = hello.exhibits.find(({ name }) => name === shown);
    this.embed = /^\w+$/.exec(said.get("embed") ?? "")?.[0] ?? null;
    if (exhibit) {
      this.beside = "nothing";
      this.moment = null;
      this.open(exhibit.name, exhibit.scene);
    } else if (!shown) {
      if (!this.exhibit) this.open(hello.first, hello.scene);
    } else if (!this.fromFragment(shown)) {
      return false;
    }
    // Takes a part of the address, if its value fits.
    const take = (key, fits, put) => {
      const value = said.get(key);
      if (value !== null && fits(value)) said.delete(key), put(value);
    };
    const within = (low, high) => (value) => value && Number(value) >= low && Number(value) <= high;
    take("rotation", (value) => this.device && within(-1e6, 1e6)(value), (value) => (this.device.rotation = Number(value)));
    take("polarizer", Boolean, (value) => this.set("camera", "polarizer", Number.isFinite(Number(value)) ? Number(value) : value));
    take("split", (value) => BESIDE.includes(value), (value) => (this.beside = value));
    take("moment", within(0, 1), (value) => (this.moment = Number(value)));
    const showing = (value) => this.devices.filter(({ kind }) => hello.kinds[kind]?.shows.includes(value));
    take("show", (value) => showing(value).length, (value) => showing(value).forEach((device) => (device.show = value)));
    ["embed", "lang"].forEach((key) => said.delete(key));
    this.unread = Array.from(said, (part) => part.join("="));
    return true;
  }

  // Reads an address; whether it says a state.
  fromFragment(fragment) {
    try {
      const binary = atob(fragment.replaceAll("-", "+").replaceAll("_", "/"));
      const bytes = Uint8Array.from(binary, (character) => character.charCodeAt(0));
      const said = JSON.parse(new TextDecoder().decode(bytes));
      const table = (value) => typeof value === "object" && value !== null && !Array.isArray(value);
      if (![said.scene, said.scene.camera ?? {}, ...(said.scene.device ?? [])].every(table)) return false;
      const number = (value, low, high, fallback) =>
        Number.isFinite(value) ? Math.min(high, Math.max(low, value)) : fallback;
      this.scene = said.scene;
      this.exhibit = String(said.exhibit ?? "");
      this.beside = BESIDE.includes(said.beside) ? said.beside : "nothing";
      this.divider = number(said.divider, 0, 1, 0.5);
      this.width = Math.round(number(said.width, 16, 2048, 640));
      this.samples = Math.round(number(said.samples, 1, 64, 16));
      this.which = Math.round(number(said.which, 0, 1000, 0));
      this.moment = Number.isFinite(said.moment) ? number(said.moment, 0, 1, 0) : null;
      return true;
    } catch {
      return false;
    }
  }
}
