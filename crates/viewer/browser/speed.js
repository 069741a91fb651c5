// How fast the page is: pictures a second while a device turns, and how soon the first one is there. `node speed.js`; of the
// page that computes by itself, `node speed.js folder`. A width, as in `node speed.js folder 320`, is that of the picture.

import { serveFolder } from "./folder.js";
import { openPage, startBrowser, startServer } from "./session.js";

const SECONDS = 6;
const DEVICES = {
  "(iii)": { kind: "square-cloak" },
  "(iv)": { kind: "double-gaussian-cloak" },
  "(i)": { kind: "square-cloak", material: "positive-uniaxial" },
  "(ii)": { kind: "square-cloak", material: "negative-uniaxial" },
};

const server = await (process.argv[2] === "folder" ? serveFolder() : startServer());
const width = Number(process.argv[3] ?? 640);
const browser = await startBrowser();
const link = (device) => {
  const scene = { device: [{ ...device, rotation: 5 }] };
  return `#${Buffer.from(JSON.stringify({ scene, samples: 1, width })).toString("base64url")}`;
};

for (const [name, device] of Object.entries(DEVICES)) {
  const { page } = await openPage(browser.context, server.address, link(device));
  const first = await page.waitForFunction(() => (document.body.dataset.pictures ? performance.now() : false), undefined, { polling: 10 });
  const milliseconds = Math.round(await first.jsonValue());
  await page.waitForTimeout(3000);
  await page.locator("#play").click();
  await page.waitForTimeout(1500);
  const count = () => page.evaluate(() => [Number(document.body.dataset.pictures), performance.now()]);
  const [from, start] = await count();
  await page.waitForTimeout(1000 * SECONDS);
  const [to, end] = await count();
  const rate = (1000 * (to - from)) / (end - start);
  const quality = await page.textContent("#quality");
  process.stdout.write(`${name}: ${rate.toFixed(1)} pictures a second; first after ${milliseconds} ms; ${quality}\n`);
  await page.close();
}
await browser.end();
await server.end();
