// A server and a browser for the tests. CLOAKROOM names the program, CHROMIUM the browser.

import { spawn } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";

export const program = process.env.CLOAKROOM ?? "../../../target/release/cloakroom";
export const browserPath = process.env.CHROMIUM ?? "/usr/bin/chromium";
export const browserArguments = [
  "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
  "--disable-component-update", "--disable-sync",
];

// A server with a scene of its own; `end` ends it as Ctrl-C does, and gives its exit status.
export async function startServer(...parameters) {
  const child = spawn(program, ["view", "--no-open", "--port", "0", ...parameters]);
  const address = await new Promise((resolve, reject) => {
    let said = "";
    child.stdout.on("data", (data) => {
      said += data;
      if (said.includes("\n")) resolve(said.trim());
    });
    child.on("exit", (status) => reject(new Error(`the server has ended with ${status}`)));
  });
  const end = () =>
    new Promise((resolve) => {
      child.on("exit", resolve);
      child.kill("SIGINT");
    });
  return { address, end };
}

export async function startBrowser() {
  const folder = mkdtempSync(join(tmpdir(), "cloakroom-browser-"));
  const context = await chromium.launchPersistentContext(folder, {
    executablePath: browserPath,
    headless: true,
    acceptDownloads: true,
    viewport: { width: 1280, height: 900 },
    args: browserArguments,
  });
  const end = async () => {
    await context.close();
    rmSync(folder, { recursive: true, force: true });
  };
  return { context, end };
}

// Opens the page; what it asks for elsewhere and what the console says goes into `complaints`.
export async function openPage(context, address, fragment = "") {
  const page = await context.newPage();
  const folder = new URL(".", address).href;
  const complaints = [];
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type())) complaints.push(message.text());
  });
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on("request", (request) => {
    const url = request.url();
    if (!url.startsWith(folder) && !url.startsWith("blob:") && !url.startsWith("data:")) complaints.push(url);
  });
  page.on("websocket", (socket) => {
    if (socket.url() !== `${folder.replace("http", "ws")}session`) complaints.push(socket.url());
  });
  await page.goto(address + fragment);
  return { page, complaints };
}

// Opens what is folded on the page, but for the tables among the parameters.
export async function unfold(page) {
  await page.locator("main section > details, #keys > details[data-name=place]").evaluateAll((all) => all.forEach((one) => (one.open = true)));
}

const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");

// What axe finds wrong with a page.
export async function violations(page) {
  // The policy of the page forbids foreign scripts; the browser's own evaluation does not ask it.
  await page.evaluate(axe);
  const result = await page.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
  return result.violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html).join("; ")}`);
}

// Waits until the finished picture of the last wish is there.
export async function finished(page, timeout = 60000) {
  await page.waitForFunction(() => document.body.dataset.finished === "true", undefined, { timeout });
}

// Lets the page make small pictures of few samples, and waits for one.
export async function small(page, samples = "4") {
  await page.evaluate((samples) => {
    for (const [id, value] of [["width", "320"], ["samples", samples]]) {
      const select = document.getElementById(id);
      select.value = value;
      select.dispatchEvent(new Event("change"));
    }
  }, samples);
  await finished(page);
}

// The canvas as RGBA.
export function pixels(page) {
  return page.evaluate(() => {
    const canvas = document.getElementById("picture");
    // From a copy: browsers complain of canvases that are read often.
    const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d", { willReadFrequently: true });
    copy.drawImage(canvas, 0, 0);
    const data = copy.getImageData(0, 0, canvas.width, canvas.height).data;
    return { width: canvas.width, height: canvas.height, data: Array.from(data) };
  });
}

// A PNG file as RGBA, decoded by the browser.
export function decoded(page, bytes) {
  return page.evaluate(async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
    const image = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
    const canvas = new OffscreenCanvas(image.width, image.height);
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    const data = context.getImageData(0, 0, image.width, image.height).data;
    return { width: image.width, height: image.height, data: Array.from(data) };
  }, bytes.toString("base64"));
}

// How many bytes of two pictures differ, and the largest difference.
export function difference(one, other) {
  if (one.width !== other.width || one.height !== other.height) return { bytes: Infinity, most: 255 };
  let [bytes, most] = [0, 0];
  for (let i = 0; i < one.data.length; i += 1) {
    const apart = Math.abs(one.data[i] - other.data[i]);
    if (apart > 0) bytes += 1;
    most = Math.max(most, apart);
  }
  return { bytes, most };
}
