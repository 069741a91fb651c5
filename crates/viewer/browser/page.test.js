// The page of `cloakroom view` in a real browser.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { decoded, difference, finished, openPage, pixels, program, small, startBrowser, startServer, unfold, violations } from "./session.js";

const folder = mkdtempSync(join(tmpdir(), "cloakroom-page-"));
let server;
let browser;

before(async () => {
  // Small and quick: what is tested is the page.
  const scene = "[camera]\nresolution = [320, 240]\n[[device]]\nkind = 'square-cloak'\nrotation = 10\n";
  writeFileSync(join(folder, "mine.toml"), scene);
  server = await startServer(join(folder, "mine.toml"));
  browser = await startBrowser();
});

after(async () => {
  await browser?.end();
  const status = await server?.end();
  rmSync(folder, { recursive: true, force: true });
  assert.equal(status, 130, "Ctrl-C ends the server cleanly");
});

// Opens the page with small pictures of few samples.
async function open(fragment) {
  const opened = await openPage(browser.context, server.address, fragment);
  await finished(opened.page);
  await unfold(opened.page);
  return opened;
}

test("it opens, and its picture is the command line's", async () => {
  const { page, complaints } = await open();
  await small(page);
  const shown = await pixels(page);
  const file = join(folder, "picture.png");
  execFileSync(program, ["render", join(folder, "mine.toml"), "--set", "camera.samples=4", "-o", file]);
  const wanted = await decoded(page, readFileSync(file));
  assert.deepEqual(difference(shown, wanted), { bytes: 0, most: 0 });
  assert.match(await page.textContent("#quality"), /320 × 240, 4 samples a pixel/);
  assert.equal(await page.locator("#plain-numbers tr, #numbers tr").count(), 12);
  assert.ok((await page.locator("#section path").count()) >= 5);
  assert.deepEqual(complaints, []);
  await page.close();
});

test("it rotates, plays and stops", async () => {
  const { page, complaints } = await open();
  await small(page);
  const before = await pixels(page);
  await page.locator("#rotation").fill("25");
  await finished(page);
  assert.ok(difference(before, await pixels(page)).most > 20);
  assert.equal(await page.inputValue("#rotation-number"), "25");
  await page.locator("#play").click();
  const count = () => page.evaluate(() => Number(document.body.dataset.pictures));
  const first = await count();
  await page.waitForFunction((n) => Number(document.body.dataset.pictures) > n + 5, first);
  await page.locator("#play").click();
  await finished(page);
  assert.ok(Number(await page.inputValue("#rotation-number")) > 25);
  assert.deepEqual(complaints, []);
  await page.close();
});

test("light in flight has a slider of time", async () => {
  const { page, complaints } = await open();
  await small(page);
  const whole = await pixels(page);
  assert.equal(await page.locator("#moment").isVisible(), false);
  await page.locator("#flight").check();
  await finished(page);
  const shown = [];
  for (const share of ["0", "0.1", "0.9"]) {
    await page.locator("#moment").fill(share);
    await finished(page);
    shown.push([parseFloat(await page.textContent("#moment-words")), await pixels(page)]);
  }
  assert.ok(shown[0][0] < shown[1][0] && shown[1][0] < shown[2][0]);
  assert.ok(difference(shown[0][1], shown[1][1]).most > 20);
  assert.ok(difference(shown[1][1], shown[2][1]).most > 20);
  assert.match(await page.textContent("#caption"), /flashes once/);
  // The link carries it.
  const again = await open(new URL(page.url()).hash);
  assert.equal(await again.page.inputValue("#moment"), "0.9");
  assert.equal(difference(shown[2][1], await pixels(again.page)).bytes, 0);
  await again.page.close();
  await page.locator("#flight").uncheck();
  await finished(page);
  assert.equal(difference(whole, await pixels(page)).bytes, 0);
  assert.deepEqual(complaints, []);
  await page.close();
});

test("devices and their parameters are switched", async () => {
  const { page, complaints } = await open();
  await small(page);
  // The menu has every exhibit, that of every kind of device, the perfect cloak first.
  const kinds = JSON.parse(execFileSync(program, ["devices", "--json"])).devices;
  const listed = await page.locator("#exhibit option").evaluateAll((all) => all.map(({ value }) => value));
  assert.deepEqual(listed.slice(0, 2), ["opened", "square-cloak"]);
  for (const { kind } of kinds) {
    if (!listed.includes(kind)) assert.ok(["body", "mirror-detour", "polarizer"].includes(kind), kind);
  }
  await page.selectOption("#exhibit", "luneburg-lens");
  await finished(page);
  const lens = await pixels(page);
  // Sliders come from the catalogue.
  assert.equal(await page.inputValue("#keys input[aria-label='radius, exactly']"), "10");
  await page.fill("#keys input[aria-label='radius, exactly']", "5");
  await page.keyboard.press("Tab");
  await finished(page);
  assert.ok(difference(lens, await pixels(page)).most > 20);
  // A lens is no cloak: there is no bare metal to show.
  assert.equal(await page.locator("#shows input").count(), 1);
  await page.fill("#keys input[aria-label='radius, exactly']", "-5");
  await page.keyboard.press("Tab");
  await page.waitForSelector("#banner:not([hidden])");
  assert.match(await page.textContent("#banner-text"), /radius/);
  await page.selectOption("#exhibit", "sphere-cloak");
  await finished(page);
  assert.ok(await page.locator("#banner").isHidden());
  await page.locator("#shows input[value=bare]").check({ force: true });
  await finished(page);
  await page.selectOption("#map", "time_of_flight_difference");
  await finished(page);
  assert.ok(await page.locator("#scale").isVisible());
  assert.deepEqual(complaints, []);
  await page.close();
});

test("the bandwidth of the light has a control, and a link keeps it", async () => {
  const { page, complaints } = await open();
  await small(page);
  assert.equal(await page.inputValue("#bandwidth"), "");
  const set = async (value) => {
    await page.fill("#bandwidth", value);
    await page.keyboard.press("Tab");
    await finished(page);
  };
  const light = () =>
    page.evaluate(() => {
      const text = location.hash.slice(1).replaceAll("-", "+").replaceAll("_", "/");
      return JSON.parse(atob(text)).scene.light;
    });
  await set("0");
  assert.deepEqual(await light(), { bandwidth_nm: 0 });
  await set("");
  assert.equal(await light(), undefined);
  // What is no bandwidth is explained.
  await page.fill("#bandwidth", "-5");
  await page.keyboard.press("Tab");
  await page.waitForSelector("#banner:not([hidden])");
  assert.match(await page.textContent("#banner-text"), /bandwidth_nm/);
  assert.deepEqual(complaints, []);
  await page.close();
});

test("the light has a control, and one wavelength a slider", async () => {
  const { page, complaints } = await open();
  await small(page);
  const spectrum = () =>
    page.evaluate(() => {
      const text = location.hash.slice(1).replaceAll("-", "+").replaceAll("_", "/");
      return JSON.parse(atob(text)).scene.light?.spectrum;
    });
  const choose = async (word) => {
    await page.selectOption("#spectrum", word);
    await finished(page);
    return spectrum();
  };
  const white = await pixels(page);
  assert.ok(await page.locator("#wavelength").isHidden());
  assert.equal(await choose("wavelength"), 550);
  const green = await pixels(page);
  assert.ok(difference(white, green).most > 50);
  // The arrow keys move it by a nanometer.
  await page.focus("#wavelength");
  await page.keyboard.press("ArrowRight");
  await finished(page);
  assert.equal(await spectrum(), 551);
  assert.equal(await page.textContent("#wavelength-words"), "551 nm");
  await page.fill("#wavelength", "650");
  await finished(page);
  assert.equal(await spectrum(), 650);
  assert.ok(difference(green, await pixels(page)).most > 50);
  assert.deepEqual(await choose("lamp"), { black_body_k: 2856 });
  assert.ok(await page.locator("#wavelength").isHidden());
  // Daylight is the white of the page: nothing here disperses.
  assert.equal(await choose("D65"), "D65");
  assert.ok(difference(white, await pixels(page)).most <= 1);
  assert.equal(await choose("auto"), undefined);
  assert.deepEqual(complaints, []);
  await page.close();
});

test("rays may be traced one by one", async () => {
  const { page, complaints } = await open();
  await small(page);
  const trace = () =>
    page.evaluate(() => {
      const text = location.hash.slice(1).replaceAll("-", "+").replaceAll("_", "/");
      return JSON.parse(atob(text)).scene.trace;
    });
  // The control lies in a folded part of the page.
  const choose = async (value) => {
    await page.locator("#exact").evaluate((choice, to) => {
      choice.value = to;
      choice.dispatchEvent(new Event("change"));
    }, value);
    await finished(page);
  };
  await choose("true");
  assert.deepEqual(await trace(), { exact: true });
  await choose("false");
  assert.equal(await trace(), undefined);
  assert.deepEqual(complaints, []);
  await page.close();
});

test("vectors and tables among the parameters have controls, too", async () => {
  const { page, complaints } = await open();
  await small(page);
  const before = await pixels(page);
  const set = async (name, value) => {
    await page.fill(`#keys input[aria-label='${name}, exactly']`, value);
    await page.keyboard.press("Tab");
    await finished(page);
  };
  await page.locator("#keys details[data-name=imperfection] summary").click();
  // Light in a cloak that is not what it should be splits again and again: a coarse picture comes first, and is enough.
  const count = await page.evaluate(() => Number(document.body.dataset.pictures));
  await page.fill("#keys input[aria-label='error, exactly']", "0.1");
  await page.keyboard.press("Tab");
  await page.waitForFunction((n) => Number(document.body.dataset.pictures) > n, count);
  assert.match(await page.textContent("#quality"), /^Preview/);
  assert.ok(difference(before, await pixels(page)).most > 20);
  await set("error", "");
  assert.equal(difference(before, await pixels(page)).bytes, 0);
  // A coating has as many layers as one adds.
  await page.locator("#keys details[data-name=coating] summary").click();
  const uncoated = await page.evaluate(() => Number(document.body.dataset.pictures));
  await page.click("text=Add a layer");
  await page.waitForFunction((n) => Number(document.body.dataset.pictures) > n, uncoated);
  assert.equal(await page.inputValue("#keys details[data-name=coating] input[aria-label='index, n']"), "1.38");
  assert.ok(difference(before, await pixels(page)).most > 0);
  await page.click("text=Remove layer 1");
  await finished(page);
  assert.equal(difference(before, await pixels(page)).bytes, 0);
  const up = await page.inputValue("#keys input[aria-label='position y, exactly']");
  assert.equal(up, "0");
  await set("position y", "5");
  const moved = await pixels(page);
  assert.ok(difference(before, moved).most > 20);
  // What is saved has both as the scene file has them.
  const [download] = await Promise.all([page.waitForEvent("download"), page.locator("#save-scene").click()]);
  assert.match(readFileSync(await download.path(), "utf8"), /position = \[\s*0(\.0)?,\s*5(\.0)?,\s*0(\.0)?,?\s*\]/);
  assert.deepEqual(complaints, []);
  await page.close();
});

test("a photograph can be dropped, and is looked through", async () => {
  const { page, complaints } = await open();
  await small(page);
  const before = await pixels(page);
  await page.evaluate(async () => {
    const canvas = new OffscreenCanvas(64, 48);
    const context = canvas.getContext("2d");
    context.fillStyle = "rgb(0 200 0)";
    context.fillRect(0, 0, 64, 48);
    const blob = await canvas.convertToBlob({ type: "image/png" });
    const transfer = new DataTransfer();
    // A name that is cut, to what would begin with a hyphen.
    const name = `${"-".repeat(30)}${"green".repeat(8)}.png`;
    transfer.items.add(new File([blob], `holiday${name}`, { type: "image/png" }));
    document.body.dispatchEvent(new DragEvent("drop", { dataTransfer: transfer, bubbles: true, cancelable: true }));
  });
  await page.waitForFunction(() => document.getElementById("toast-text").textContent.includes("green.png"));
  await finished(page);
  const after = await pixels(page);
  assert.ok(difference(before, after).most > 50);
  assert.deepEqual(after.data.slice(0, 4), [0, 200, 0, 255]);
  // Something that is no photograph is refused, and the picture stays.
  await page.setInputFiles("#photograph", { name: "a.png", mimeType: "image/png", buffer: Buffer.from("no image") });
  await page.waitForSelector("#banner:not([hidden])");
  assert.match(await page.textContent("#banner-text"), /not an image/);
  assert.deepEqual(complaints, []);
  await page.close();
});

test("pointing at the picture shows the rays of that point", async () => {
  const { page, complaints } = await open();
  await page.hover("#picture", { position: { x: 300, y: 230 } });
  await page.waitForSelector("#lines path");
  assert.match(await page.textContent("#ray-words"), /^Pixel \d+, \d+: .* from the photograph/);
  const [x] = (await page.textContent("#ray-words")).match(/\d+/);
  assert.ok(Number(x) > 0);
  // Dragging orbits the camera, the wheel zooms.
  const address = page.url();
  await page.mouse.down();
  await page.mouse.move(400, 330, { steps: 4 });
  await page.mouse.up();
  await page.mouse.wheel(0, -200);
  await finished(page);
  assert.notEqual(page.url(), address);
  assert.deepEqual(complaints, []);
  await page.close();
});

test("the split view has a divider that moves", async () => {
  const { page, complaints } = await open();
  await small(page);
  const cloak = await pixels(page);
  await page.selectOption("#beside", "bare");
  await finished(page);
  await page.locator("#divider").focus();
  await page.keyboard.press("Home");
  assert.equal(difference(cloak, await pixels(page)).bytes, 0);
  await page.keyboard.press("End");
  assert.ok(difference(cloak, await pixels(page)).most > 20);
  const box = await page.locator("#picture").boundingBox();
  await page.mouse.move(box.x + box.width - 2, box.y + 30);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 4, box.y + 30, { steps: 3 });
  await page.mouse.up();
  assert.equal(await page.getAttribute("#divider", "aria-valuenow"), "25");
  assert.deepEqual(complaints, []);
  await page.close();
});

test("the keyboard alone is enough", async () => {
  const { page, complaints } = await open();
  await small(page);
  await page.keyboard.press("Tab");
  assert.equal(await page.evaluate(() => document.activeElement.id), "exhibit");
  for (const id of ["tour", "gallery", "language", "picture"]) {
    await page.keyboard.press("Tab");
    assert.equal(await page.evaluate(() => document.activeElement.id), id);
  }
  const rotation = () => page.inputValue("#rotation-number");
  await page.keyboard.press("]");
  await page.keyboard.press("]");
  assert.equal(await rotation(), "12");
  await page.keyboard.press("b");
  await finished(page);
  assert.ok(await page.isChecked("#shows input[value=bare]"));
  await page.keyboard.press("s");
  assert.equal(await page.inputValue("#beside"), "bare");
  const address = page.url();
  await page.keyboard.press("ArrowLeft");
  await finished(page);
  assert.notEqual(page.url(), address);
  await page.keyboard.press("Enter");
  await page.keyboard.press("ArrowDown");
  await page.waitForSelector("#lines path");
  await page.keyboard.press("Space");
  assert.equal(await page.getAttribute("#play", "aria-pressed"), "true");
  await page.keyboard.press("Space");
  assert.equal(await page.getAttribute("#play", "aria-pressed"), "false");
  // Every control can be reached, and shows it.
  const reached = new Set();
  for (let i = 0; i < 120; i += 1) {
    await page.keyboard.press("Tab");
    const outline = await page.evaluate(() => {
      const at = document.activeElement;
      return at === document.body ? "" : `${at.id}|${at.className}|${at.type}`;
    });
    if (outline) reached.add(outline.split("|")[0]);
  }
  for (const id of ["play", "rotation", "beside", "polarizer", "map", "photograph", "save-picture", "save-scene", "copy-link", "whole"]) {
    assert.ok(reached.has(id), `${id} of ${[...reached]}`);
  }
  assert.deepEqual(complaints, []);
  await page.close();
});

test("picture and scene are saved, and a link shows the same again", async () => {
  const { page, complaints } = await open();
  await small(page);
  await page.locator("#rotation").fill("15");
  await finished(page);
  const shown = await pixels(page);
  const saved = async (button) => {
    const [download] = await Promise.all([page.waitForEvent("download"), page.locator(button).click()]);
    return readFileSync(await download.path());
  };
  const picture = await decoded(page, await saved("#save-picture"));
  assert.equal(difference(shown, picture).bytes, 0);
  writeFileSync(join(folder, "saved.toml"), await saved("#save-scene"));
  const file = join(folder, "saved.png");
  execFileSync(program, ["render", join(folder, "saved.toml"), "-o", file]);
  assert.equal(difference(shown, await decoded(page, readFileSync(file))).bytes, 0);
  await page.locator("#copy-link").click();
  const other = await openPage(browser.context, page.url());
  await finished(other.page);
  assert.equal(difference(shown, await pixels(other.page)).bytes, 0);
  // One that says no scene opens the page as it is.
  const said = JSON.stringify({ scene: { device: [null] } });
  const nonsense = await openPage(browser.context, `${server.address}#${Buffer.from(said).toString("base64url")}`);
  await nonsense.page.waitForFunction(() => document.body.dataset.pictures);
  assert.match(await nonsense.page.locator("#banner-text").textContent(), /link is damaged/);
  assert.ok(await nonsense.page.locator("#banner").isVisible());
  assert.deepEqual([...complaints, ...other.complaints, ...nonsense.complaints], []);
  await nonsense.page.close();
  await other.page.close();
  await page.close();
});

test("it is accessible, in light and dark, on a phone too", async () => {
  const { page, complaints } = await open();
  await small(page);
  for (const colorScheme of ["light", "dark"]) {
    await page.emulateMedia({ colorScheme });
    assert.deepEqual(await violations(page), [], colorScheme);
  }
  await page.selectOption("#beside", "bare");
  await page.selectOption("#map", "delivered");
  await page.locator("details").evaluateAll((all) => all.forEach((one) => (one.open = true)));
  await finished(page);
  for (const width of [1280, 768, 360]) {
    await page.setViewportSize({ width, height: 740 });
    assert.deepEqual(await violations(page), [], String(width));
    const overflow = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    assert.ok(overflow <= 0, `${overflow} pixels too wide at ${width}`);
  }
  const canvas = await page.locator("#picture").boundingBox();
  assert.ok(canvas.width > 300 && canvas.width <= 360);
  assert.deepEqual(complaints, []);
  await page.close();
});
