// How fast the page is: pictures a second while a device turns, and how soon the first one is there. `node speed.js`; of the
// page that computes by itself, `node speed.js folder`. A width, as in `node speed.js folder 320`, is that of the picture.

import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { setTimeout as sleep } from "node:timers/promises";
import { serveFolder } from "./folder.js";
import { browserArguments, browserPath, startServer } from "./session.js";

const SECONDS = 6;
const DEVICES = {
  "(iii)": { kind: "square-cloak" },
  "(iv)": { kind: "double-gaussian-cloak" },
  "(i)": { kind: "square-cloak", material: "positive-uniaxial" },
  "(ii)": { kind: "square-cloak", material: "negative-uniaxial" },
};

// A browser that is asked for nothing but the value of an expression now and then: one that is watched as the tests do copies
// each picture to who watches, which takes as long as to show it.
class Browser {
  constructor() {
    this.folder = mkdtempSync(join(tmpdir(), "cloakroom-browser-"));
    const options = ["--headless=new", "--remote-debugging-pipe", "--window-size=1280,900", `--user-data-dir=${this.folder}`];
    this.child = spawn(browserPath, [...options, ...browserArguments, "about:blank"], { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
    [, , , this.writer, this.reader] = this.child.stdio;
    this.asked = new Map();
    let said = "";
    this.reader.setEncoding("utf8").on("data", (data) => {
      const messages = (said + data).split("\0");
      said = messages.pop();
      for (const { id, result, error } of messages.map((message) => JSON.parse(message))) {
        const asked = this.asked.get(id);
        this.asked.delete(id);
        if (error) asked?.reject(new Error(error.message));
        else asked?.resolve(result);
      }
    });
    this.child.on("exit", () => this.asked.forEach(({ reject }) => reject(new Error("the browser has ended"))));
    this.count = 0;
  }

  say(method, params, sessionId) {
    const id = ++this.count;
    return new Promise((resolve, reject) => {
      this.asked.set(id, { resolve, reject });
      this.writer.write(`${JSON.stringify({ id, method, params, sessionId })}\0`);
    });
  }

  async open(url) {
    const { targetId } = await this.say("Target.createTarget", { url });
    const { sessionId } = await this.say("Target.attachToTarget", { targetId, flatten: true });
    const value = async (expression) => {
      const { result, exceptionDetails } = await this.say("Runtime.evaluate", { expression, returnByValue: true }, sessionId);
      if (exceptionDetails) throw new Error(exceptionDetails.text);
      return result.value;
    };
    return { value, close: () => this.say("Target.closeTarget", { targetId }) };
  }

  async end() {
    const ended = new Promise((resolve) => this.child.on("exit", resolve));
    this.say("Browser.close", {}).catch(() => {});
    await ended;
    rmSync(this.folder, { recursive: true, force: true });
  }
}

const server = await (process.argv[2] === "folder" ? serveFolder() : startServer());
const width = Number(process.argv[3] ?? 640);
const browser = new Browser();
const link = (device) => {
  const scene = { device: [{ ...device, rotation: 5 }] };
  return `#${Buffer.from(JSON.stringify({ scene, samples: 1, width })).toString("base64url")}`;
};

for (const [name, device] of Object.entries(DEVICES)) {
  const page = await browser.open(server.address + link(device));
  let first = false;
  while (!first) {
    // Before there is a page there is nothing to ask.
    first = await page.value("document.body.dataset.pictures ? performance.now() : false").catch(() => false);
    await sleep(10);
  }
  await sleep(3000);
  await page.value('document.getElementById("play").click()');
  await sleep(1500);
  const count = () => page.value("[Number(document.body.dataset.pictures), performance.now()]");
  const [from, start] = await count();
  await sleep(1000 * SECONDS);
  const [to, end] = await count();
  const rate = (1000 * (to - from)) / (end - start);
  const quality = await page.value('document.getElementById("quality").textContent');
  process.stdout.write(`${name}: ${rate.toFixed(1)} pictures a second; first after ${Math.round(first)} ms; ${quality}\n`);
  await page.close();
}
await browser.end();
await server.end();
