// The page that computes by itself, from the folder that `web/build.sh` makes: in Node its pictures, in a browser the rest.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { createServer } from "node:http";
import { mkdtempSync, readFileSync, readdirSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { folder, serveFolder } from "./folder.js";
import { decoded, difference, finished, openPage, pixels, program, small, startBrowser, unfold } from "./session.js";

const out = mkdtempSync(join(tmpdir(), "cloakroom-folder-"));
const scenes = new URL("../../../scenes/", import.meta.url).pathname;
let server;
let browser;

before(async () => {
  server = await serveFolder();
  browser = await startBrowser();
});

after(async () => {
  await browser?.end();
  await server?.end();
  rmSync(out, { recursive: true, force: true });
});

// The compiled part, without a browser.
function compiled() {
  const glue = readFileSync(join(folder, "cloakroom.js"), "utf8");
  const part = new Function(`${glue}; return wasm_bindgen;`)();
  part.initSync({ module: readFileSync(join(folder, "cloakroom_bg.wasm")) });
  return part;
}

// The page has the built-in images at half the size: the command line is given the same ones.
const reduced = new URL("../../cloakroom/assets/reduced/", import.meta.url).pathname;
const room = `surroundings.image=${reduced}room.jpg`;

function withImages(text, set) {
  const images = [`photograph.image=${reduced}bookshelf.jpg`, "photograph.width=110"];
  if (text.includes("builtin:room")) images.push(room);
  return [...images, ...set];
}

function rendered(scene, set) {
  const file = join(out, "picture.png");
  const all = withImages(readFileSync(scene, "utf8"), set);
  execFileSync(program, ["render", scene, ...all.flatMap((one) => ["--set", one]), "-o", file]);
  return readFileSync(file);
}

// Sums are not rounded everywhere alike: at most 1 step of 255, and that in few pixels.
function assertAlike(one, other, name) {
  const { bytes, most } = difference(one, other);
  assert.ok(most <= 1, `${name}: ${most} steps`);
  assert.ok(bytes <= 0.0005 * one.width * one.height, `${name}: ${bytes} bytes of ${one.width} x ${one.height} pixels`);
}

const ten = [
  "paper/fig7b", "paper/fig7d", "paper/fig3c", "paper/fig4c", "gallery/sphere-cloak", "gallery/cylinder-cloak",
  "gallery/luneburg-lens", "gallery/gaussian-carpet", "gallery/prisms", "gallery/bodies",
];
const tiny = ["camera.resolution=[320, 240]", "camera.samples=1"];

test("pictures in Node are those of the command line", async () => {
  const part = compiled();
  const page = await browser.context.newPage();
  for (const name of ten) {
    const scene = join(scenes, `${name}.toml`);
    const own = await decoded(page, Buffer.from(part.picture(readFileSync(scene, "utf8"), tiny)));
    assertAlike(own, await decoded(page, rendered(scene, tiny)), name);
  }
  assert.throws(() => part.picture("[[device]]\nkind = 'nothing'", []), /nothing/);
  assert.throws(() => part.picture("[photograph]\nimage = '/etc/passwd'", []));
  await page.close();
});

// The program of web/portable, where it has been built.
const portable = process.env.PORTABLE;

test("pictures in Node are to the last bit those of a portable program", { skip: !portable }, async () => {
  const part = compiled();
  const page = await browser.context.newPage();
  for (const name of ten) {
    const scene = join(scenes, `${name}.toml`);
    const text = readFileSync(scene, "utf8");
    const own = await decoded(page, Buffer.from(part.picture(text, tiny)));
    const other = await decoded(page, execFileSync(portable, [scene, ...withImages(text, tiny)]));
    const { bytes, most } = difference(own, other);
    assert.equal(bytes, 0, `${name}: ${bytes} bytes, ${most} steps`);
  }
  await page.close();
});

test("the page in a browser is that of the server, and asks for nothing outside its folder", async () => {
  const { page, complaints } = await openPage(browser.context, server.address);
  await finished(page);
  await page.waitForFunction(() => document.querySelectorAll("#plain-numbers tr, #numbers tr").length === 12);
  assert.ok((await page.locator("#section path").count()) >= 5);
  await small(page);
  const set = ["camera.resolution=[320, 240]", "camera.samples=4", room];
  assertAlike(await pixels(page), await decoded(page, rendered(join(scenes, "paper/fig7d.toml"), set)), "the first scene");
  assert.deepEqual(complaints, []);
  await page.close();
});

test("it turns, shows other devices, maps and what is beside, and says what is wrong", async () => {
  const { page, complaints } = await openPage(browser.context, server.address);
  await finished(page);
  await unfold(page);
  await small(page, "1");
  const before = await pixels(page);
  const count = () => page.evaluate(() => Number(document.body.dataset.pictures));
  await page.locator("#play").click();
  const first = await count();
  await page.waitForFunction((n) => Number(document.body.dataset.pictures) > n + 5, first);
  await page.locator("#play").click();
  await finished(page);
  assert.ok(difference(before, await pixels(page)).most > 20);
  await page.locator("#flight").check();
  await finished(page);
  assert.match(await page.textContent("#moment-words"), /^\d\S* ns$/);
  await page.locator("#flight").uncheck();
  await page.selectOption("#beside", "bare");
  await finished(page);
  await page.selectOption("#map", "time_of_flight_difference");
  await finished(page);
  assert.ok(await page.locator("#scale").isVisible());
  await page.selectOption("#exhibit", "luneburg-lens");
  await finished(page);
  await page.fill("#keys input[aria-label='radius, exactly']", "-5");
  await page.keyboard.press("Tab");
  await page.waitForSelector("#banner:not([hidden])");
  assert.match(await page.textContent("#banner-text"), /radius/);
  const saved = page.waitForEvent("download");
  await page.selectOption("#exhibit", "sphere-cloak");
  await finished(page);
  await page.locator("#save-scene").click();
  assert.match(readFileSync(await (await saved).path(), "utf8"), /sphere-cloak/);
  assert.deepEqual(complaints, []);
  await page.close();
});

test("a photograph that is brought hangs behind the device", async () => {
  const { page, complaints } = await openPage(browser.context, server.address);
  await finished(page);
  const before = await pixels(page);
  const picture = rendered(join(scenes, "gallery/lens.toml"), ["camera.resolution=[64, 80]", "camera.samples=1"]);
  await page.setInputFiles("#photograph", { name: "mine.png", mimeType: "image/png", buffer: picture });
  await page.waitForFunction(() => document.getElementById("toast-text").textContent.includes("mine.png"));
  await finished(page);
  assert.ok(difference(before, await pixels(page)).most > 20);
  await page.setInputFiles("#photograph", { name: "mine.png", mimeType: "image/png", buffer: Buffer.from("no image") });
  await page.waitForSelector("#banner:not([hidden])");
  assert.match(await page.textContent("#banner-text"), /not an image/);
  // What reads EXR is not loaded.
  const exr = Buffer.concat([Buffer.from([0x76, 0x2f, 0x31, 0x01]), Buffer.alloc(64)]);
  await page.setInputFiles("#photograph", { name: "mine.exr", mimeType: "image/x-exr", buffer: exr });
  await page.waitForFunction(() => /save it as PNG or JPEG/.test(document.getElementById("banner-text").textContent));
  assert.deepEqual(complaints, []);
  await page.close();
});

test("as one file it needs no server", async () => {
  const { page, complaints } = await openPage(browser.context, pathToFileURL(`${resolve(folder)}.html`).href);
  await finished(page);
  await small(page);
  const set = ["camera.resolution=[320, 240]", "camera.samples=4", room];
  assertAlike(await pixels(page), await decoded(page, rendered(join(scenes, "paper/fig7d.toml"), set)), "the first scene");
  assert.deepEqual(complaints, []);
  await page.close();
});

test("a link shows the same from the folder and from the one file, and in a page of another", async () => {
  const { page, complaints } = await openPage(browser.context, server.address, "#square-cloak-positive-uniaxial&rotation=12&polarizer=horizontal");
  // A whole picture of two rays for one: a machine that does something else, too, needs more than a minute.
  await finished(page, 180000);
  await small(page, "1");
  const shown = await pixels(page);
  const { hash } = new URL(page.url());
  assert.ok(hash.length > 100);
  const file = await openPage(browser.context, pathToFileURL(`${resolve(folder)}.html`).href, hash);
  await finished(file.page);
  assert.equal(difference(shown, await pixels(file.page)).bytes, 0);
  assert.equal(await file.page.textContent("#caption"), await page.textContent("#caption"));
  // Another host's page has it in a frame.
  const other = createServer((_, response) => {
    response.writeHead(200, { "content-type": "text/html" });
    response.end(`<!doctype html><title>A lesson</title><iframe src="${server.address}${hash}&embed=rotation&lang=de" width="480" height="520"></iframe>`);
  });
  await new Promise((ready) => other.listen(0, "127.0.0.1", ready));
  const lesson = await browser.context.newPage();
  await lesson.goto(`http://localhost:${other.address().port}/`);
  const frame = lesson.frames()[1];
  await frame.waitForFunction(() => document.body?.dataset.finished === "true", undefined, { timeout: 60000 });
  assert.match(await frame.textContent("#caption"), /um 12° gedreht/);
  assert.equal(await frame.locator("#exhibit").isVisible(), false);
  assert.ok(await frame.locator("#rotation").isVisible());
  other.close();
  assert.deepEqual([...complaints, ...file.complaints], []);
  for (const one of [lesson, file.page, page]) await one.close();
});

test("it is small", () => {
  let [all, loaded] = [0, 0];
  for (const name of readdirSync(folder)) {
    const bytes = readFileSync(join(folder, name));
    all += bytes.length;
    // Node's own zlib is quicker, and makes it a hundredth larger.
    loaded += execFileSync("gzip", ["-9"], { input: bytes, maxBuffer: 1e8 }).length;
  }
  const images = readdirSync(reduced).reduce((sum, name) => sum + readFileSync(join(reduced, name)).length, 0);
  assert.ok(all <= 6e6, `${all} bytes`);
  assert.ok(loaded <= 3e6, `${loaded} bytes compressed`);
  // Code, fonts and page.
  assert.ok(loaded - images <= 1.2e6, `${loaded - images} bytes compressed without images`);
});
