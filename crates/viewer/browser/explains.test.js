// What the page says of what it shows, and how one finds one's way on it.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { networkInterfaces, tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { difference, finished, openPage, pixels, program, small, startBrowser, startServer, unfold, violations } from "./session.js";

const folder = mkdtempSync(join(tmpdir(), "cloakroom-explains-"));
let server;
let browser;

before(async () => {
  server = await startServer();
  browser = await startBrowser();
});

after(async () => {
  await browser?.end();
  await server?.end();
  rmSync(folder, { recursive: true, force: true });
});

async function open(fragment = "") {
  const opened = await openPage(browser.context, server.address, fragment);
  await finished(opened.page);
  return opened;
}

const says = (page) => page.textContent("#caption");

// Sets a field or a list at once, folded or not.
const choose = (page, id, value) =>
  page.locator(`#${id}`).evaluate((control, to) => {
    control.value = to;
    control.dispatchEvent(new Event("change"));
  }, value);

test("the caption says what one sees, of the scene as it is", async () => {
  const { page, complaints } = await open();
  await small(page, "1");
  // The rhombus is kappa = tan 30 degrees times as high as wide: 14.1 cm times the root of 2 times that.
  assert.match(await says(page), /A metal bar 11\.5 cm high stands in front of the person\..*turned by 10° it looks like a mirror/);
  await page.fill("#keys input[aria-label='side, exactly']", "28.2");
  await page.keyboard.press("Tab");
  assert.match(await says(page), /23 cm high/);
  await page.fill("#rotation-number", "0");
  await page.keyboard.press("Tab");
  assert.match(await says(page), /as if nothing were there/);
  await page.keyboard.press("b");
  assert.match(await says(page), /no cloak: it hides/);
  await page.keyboard.press("m");
  assert.match(await says(page), /edge-on/);
  await page.keyboard.press("c");
  await choose(page, "beside", "bare");
  assert.match(await says(page), /Left of the divider: bare metal/);
  // The description follows the material, and this the polarizer.
  await page.selectOption("#keys select", "negative-uniaxial");
  assert.match(await says(page), /one polarization only.*A horizontal polarizer/);
  await choose(page, "polarizer", "horizontal");
  assert.match(await says(page), /horizontal polarizer lets only that polarization pass that is led around/);
  await choose(page, "polarizer", "vertical");
  assert.match(await says(page), /that is not led around/);
  await choose(page, "exhibit", "sphere-cloak");
  assert.match(await says(page), /metal ball 8 cm across.*whichever way it comes/);
  assert.deepEqual(complaints, []);
  await page.close();
});

test("everything is said in English and German, from the browser's language or the one that was chosen", async () => {
  const page = await browser.context.newPage();
  await page.addInitScript(() => Object.defineProperty(navigator, "language", { get: () => "de-AT" }));
  await page.goto(server.address);
  await finished(page);
  await small(page, "1");
  assert.equal(await page.getAttribute("html", "lang"), "de");
  assert.match(await says(page), /Ein 11,5 cm hoher Metallstab steht vor der Person\..*um 10° gedreht/);
  assert.equal(await page.locator("#keys select option:checked").first().textContent(), "impedanzangepasst");
  assert.deepEqual(await violations(page), []);
  const said = { en: [], de: [] };
  for (const language of ["en", "de"]) {
    await page.selectOption("#language", language);
    for (const name of await page.locator("#exhibit option").evaluateAll((all) => all.map(({ value }) => value))) {
      await choose(page, "exhibit", name);
      const title = await page.locator("#exhibit option:checked").textContent();
      said[language].push(`${title}: ${await says(page)}`);
    }
    // What has no words shows its key.
    const shown = `${said[language].join("\n")}\n${await page.evaluate(() => document.body.innerText)}`;
    assert.doesNotMatch(shown, /\b(name|thing|see|cloak|photo|map|group|key|tour|n)\.[a-z]|\[\[|\{\w+\}|undefined|NaN/);
  }
  assert.ok(said.en.length > 35);
  assert.equal(new Set([...said.en, ...said.de]).size, 2 * said.en.length);
  await page.selectOption("#language", "en");
  await choose(page, "exhibit", "square-cloak");
  await small(page, "1");
  await page.reload();
  await finished(page);
  assert.equal(await page.getAttribute("html", "lang"), "en");
  assert.equal(await page.textContent("#tour"), "Tour");
  await page.evaluate(() => localStorage.clear());
  await page.close();
});

test("the tour goes from nothing to the polarizer", async () => {
  const { page, complaints } = await open();
  await small(page, "1");
  await page.click("#tour");
  const steps = [];
  for (let step = 1; step <= 5; step += 1) {
    assert.match(await page.textContent("#guide-number"), new RegExp(`Step ${step} of 5`));
    await finished(page);
    steps.push({ caption: await says(page), pixels: await pixels(page) });
    if (step === 1) assert.deepEqual(await violations(page), []);
    if (step < 5) await page.click("#guide-next");
  }
  assert.match(steps[0].caption, /^Nothing/);
  assert.match(steps[1].caption, /no cloak/);
  assert.match(steps[2].caption, /as if nothing were there/);
  assert.match(steps[3].caption, /turned by 10°/);
  assert.match(steps[4].caption, /horizontal polarizer/);
  assert.ok(difference(steps[0].pixels, steps[1].pixels).most > 50);
  assert.ok(difference(steps[0].pixels, steps[3].pixels).most > 50);
  assert.equal(await page.textContent("#guide-polarizer"), "Take the polarizer away");
  await page.click("#guide-polarizer");
  assert.equal(await page.textContent("#guide-polarizer"), "Put the polarizer back");
  await finished(page);
  assert.match(await says(page), /one polarization only/);
  assert.ok(difference(steps[4].pixels, await pixels(page)).most > 20);
  await page.click("#guide-close");
  assert.ok(await page.locator("#guide").isHidden());
  assert.deepEqual(complaints, []);
  await page.close();
});

test("words are explained where one points at them, and for the keyboard", async () => {
  const { page, complaints } = await open();
  const gloss = page.locator("#gloss");
  assert.ok(await gloss.isHidden());
  await page.hover("#caption .term[data-term=cloak]");
  assert.match(await gloss.textContent(), /leads light around what it hides/);
  await page.mouse.move(5, 5);
  assert.ok(await gloss.isHidden());
  await page.focus("#caption .term[data-term=sheet]");
  assert.match(await gloss.textContent(), /without thickness/);
  assert.equal(await page.getAttribute("#caption .term[data-term=sheet]", "aria-describedby"), "gloss");
  assert.deepEqual(await violations(page), []);
  await page.keyboard.press("Escape");
  assert.ok(await gloss.isHidden());
  // Each term there is has words.
  const terms = await page.locator(".term").evaluateAll((all) => all.map(({ dataset }) => dataset.term));
  for (const term of new Set(terms)) {
    await page.locator(`.term[data-term=${term}]`).first().evaluate((one) => one.dispatchEvent(new MouseEvent("click", { bubbles: true })));
    assert.doesNotMatch(await gloss.textContent(), /^term\./);
  }
  assert.deepEqual(complaints, []);
  await page.close();
});

test("the first numbers are the share of light in its place, of the metal, too; nothing is 0", async () => {
  const { page, complaints } = await open();
  await small(page, "1");
  await page.waitForFunction(() => document.querySelectorAll("#plain-numbers:not(.old) tr").length === 3);
  const cells = () => page.locator("#plain-numbers td").allTextContents();
  const share = (text) => Number(text.replace("< ", "").replace(" %", "")) / 100;
  // As the command line counts it.
  const scene = join(folder, "cloak.toml");
  writeFileSync(scene, "[camera]\nresolution = [160, 120]\nsamples = 1\n[[device]]\nkind = 'square-cloak'\nrotation = 10\n");
  const { rows } = JSON.parse(execFileSync(program, ["quality", scene, "--json", "--sweep", "device.0.show=cloak,bare"]));
  const wanted = rows.map(({ figures }) => figures.in_place_share);
  const shown = (await cells()).slice(0, 2).map(share);
  for (const i of [0, 1]) assert.ok(Math.abs(shown[i] - wanted[i]) < 0.001, `${shown} for ${wanted}`);
  assert.ok(shown[0] > shown[1] + 0.5);
  assert.match(await page.textContent("#numbers-note"), /What counts is the first number/);
  // On its axis the perfect cloak delays nothing: not even by rounding.
  await page.fill("#rotation-number", "0");
  await page.keyboard.press("Tab");
  await page.waitForFunction(() => document.querySelector("#plain-numbers:not(.old) tr:last-child td")?.textContent === "0");
  await choose(page, "map", "time_of_flight_difference");
  await finished(page);
  assert.equal(await page.textContent("#scale-low"), "0");
  assert.match(await page.textContent("#scale-title"), /everywhere the same/);
  const { data } = await pixels(page);
  assert.equal(new Set(data.filter((_, i) => i % 4 === 0)).size, 1);
  assert.deepEqual(complaints, []);
  await page.close();
});

test("links say what they show, and an embedded view has one control", async () => {
  const { page, complaints } = await open("#square-cloak&rotation=30&show=bare&split=mirror");
  assert.equal(await page.inputValue("#rotation-number"), "30");
  assert.ok(await page.isChecked("#shows input[value=bare]"));
  assert.equal(await page.inputValue("#beside"), "mirror");
  assert.ok(!(await page.locator("#toast").isVisible()));
  // What is wrong in one is left out, and said.
  await follow(page, "#sphere-cloak&rotation=left&split=half&moment=2&show=nothing&colour=red&polarizer=30");
  assert.match(await page.textContent("#toast"), /says nothing here: rotation=left, split=half, moment=2, show=nothing, colour=red/);
  assert.match(await says(page), /polarizer/);
  await page.setViewportSize({ width: 480, height: 520 });
  const embedded = await open("#sphere-cloak&embed=inner&lang=de");
  await embedded.page.setViewportSize({ width: 480, height: 560 });
  const fields = await embedded.page.locator("input:visible, select:visible").evaluateAll((all) => all.map((one) => one.getAttribute("aria-label")));
  assert.deepEqual(fields, ["innen", "innen, genau"]);
  await embedded.page.fill("input[type=number]:visible", "6");
  await embedded.page.keyboard.press("Tab");
  assert.match(await says(embedded.page), /Eine 12 cm große Metallkugel/);
  assert.match(embedded.page.url(), /&embed=inner$/);
  await finished(embedded.page);
  assert.deepEqual(await violations(embedded.page), []);
  // Where there is little room, what is moved is in sight, and nothing is beside it.
  await embedded.page.setViewportSize({ width: 300, height: 250 });
  const slider = await embedded.page.locator("input[type=range]:visible").boundingBox();
  assert.ok(slider.y + slider.height <= 250 && slider.x + slider.width <= 300);
  assert.ok((await embedded.page.evaluate(() => document.documentElement.scrollWidth)) <= 300);
  // The language of a link is not remembered.
  assert.equal(await embedded.page.evaluate(() => localStorage.length), 0);
  const whole = await embedded.page.getAttribute("#whole-page a", "href");
  const other = await open(whole);
  assert.ok(await other.page.locator("#exhibit").isVisible());
  assert.match(await says(other.page), /A metal ball 12 cm across/);
  assert.deepEqual([...complaints, ...embedded.complaints, ...other.complaints], []);
  for (const one of [other, embedded, { page }]) await one.page.close();
});

test("all devices are a page of pictures, each opening live", async () => {
  const german = await openPage(browser.context, server.address, "#gallery&lang=de");
  await german.page.locator("#cards").waitFor();
  assert.equal(await german.page.getAttribute("html", "lang"), "de");
  assert.ok((await german.page.locator("#min-power option").allTextContents()).includes("0,1 %"));
  await german.page.close();
  const { page, complaints } = await open();
  await page.click("#gallery");
  await page.locator(".cards a").first().waitFor();
  const cards = await page.locator(".cards a").count();
  assert.equal(cards, await page.locator("#exhibit option").count());
  await page.waitForFunction((n) => document.querySelectorAll(".cards canvas[data-made]").length === n, cards, { timeout: 240000 });
  const blank = await page.locator(".cards canvas").evaluateAll(
    (all) => all.filter((one) => !one.getContext("2d").getImageData(0, 0, one.width, one.height).data.some((byte, i) => i % 4 < 3 && byte > 60)).length,
  );
  assert.equal(blank, 0);
  assert.deepEqual(await violations(page), []);
  await page.click(".cards a[href='#luneburg-lens']");
  await finished(page);
  assert.ok(await page.locator("main").isVisible());
  assert.equal(await page.inputValue("#exhibit"), "luneburg-lens");
  await page.goBack();
  assert.ok(await page.locator("#cards").isVisible());
  await page.click("#cards-close");
  await finished(page);
  assert.deepEqual(complaints.filter((one) => !one.includes("willReadFrequently")), []);
  await page.close();
});

test("what one needs first is in sight, and the picture stays so", async () => {
  const { page, complaints } = await open();
  const box = async (selector) => {
    const { x, y, width, height } = await page.locator(selector).boundingBox();
    return { left: x, top: y, right: x + width, bottom: y + height };
  };
  for (const [width, height] of [[1280, 720], [1366, 768], [1920, 1080]]) {
    await page.setViewportSize({ width, height });
    for (const id of ["exhibit", "stage", "caption", "rotation", "play", "shows", "beside", "polarizer", "quality", "section"]) {
      assert.ok((await box(`#${id}`)).bottom <= height, `${id} at ${width} x ${height}`);
    }
    const [stage, parameters] = [await box("#stage"), await box("#parameters-title")];
    assert.ok(parameters.left > stage.right && parameters.bottom < height);
    assert.ok(stage.right - stage.left > (width >= 1920 ? 900 : 500));
    await page.evaluate(() => scrollTo(0, document.documentElement.scrollHeight));
    assert.ok((await box("#stage")).top >= 0, String(width));
    await page.evaluate(() => scrollTo(0, 0));
  }
  await page.setViewportSize({ width: 390, height: 844 });
  await page.locator("#copy-link").scrollIntoViewIfNeeded();
  const [stage, link] = [await box("#stage"), await box("#copy-link")];
  assert.ok(stage.top >= 0 && stage.bottom < link.top);
  for (const colorScheme of ["light", "dark"]) {
    await page.emulateMedia({ colorScheme });
    assert.deepEqual(await violations(page), [], colorScheme);
  }
  assert.deepEqual(complaints, []);
  await page.close();
});

test("Space turns whatever was clicked, toasts stay until they are closed", async () => {
  const { page, complaints } = await open();
  await small(page, "1");
  const turns = () => page.getAttribute("#play", "aria-pressed");
  for (const selector of ["#whole", "#copy-link", "#rotation", "#shows input[value=bare]", "#polarizer", "#rotation-number"]) {
    await page.locator(selector).click({ force: true });
    await page.keyboard.press("Escape");
    const whole = await page.isChecked("#whole");
    await page.keyboard.press("Space");
    assert.equal(await turns(), "true", selector);
    assert.equal(await page.isChecked("#whole"), whole);
    await page.keyboard.press("Space");
    assert.equal(await turns(), "false", selector);
  }
  // Where the keyboard has gone to, Space presses.
  await page.focus("#gallery");
  await page.keyboard.press("Tab");
  await page.keyboard.press("Shift+Tab");
  await page.keyboard.press("Space");
  await page.locator("#cards").waitFor({ timeout: 5000 });
  await page.click("#cards-close");
  await page.click("#copy-link");
  assert.match(await page.textContent("#toast-text"), /link/);
  assert.deepEqual(await violations(page), []);
  await page.waitForTimeout(4000);
  assert.ok(await page.locator("#toast").isVisible());
  await page.click("#toast-close");
  assert.ok(await page.locator("#toast").isHidden());
  assert.deepEqual(complaints, []);
  await page.close();
});

test("one turn is saved as a film", async () => {
  const { page, complaints } = await open();
  await small(page, "1");
  const download = page.waitForEvent("download", { timeout: 240000 });
  await page.click("#save-film");
  const file = readFileSync(await (await download).path());
  // The mark of Matroska, of which WebM is a kind.
  assert.deepEqual([...file.subarray(0, 4)], [0x1a, 0x45, 0xdf, 0xa3]);
  assert.ok(file.length > 20000, String(file.length));
  await finished(page);
  assert.equal(await page.inputValue("#rotation-number"), "10");
  assert.deepEqual(complaints, []);
  await page.close();
});

test("a German page says in German what is wrong, and of sentences that it does not know that they are English", async () => {
  // A scene as an address, and what is said of it in either language.
  const opened = async (scene) => {
    const fragment = `#${Buffer.from(JSON.stringify({ scene, samples: 1, width: 320 })).toString("base64url")}`;
    const { page } = await openPage(browser.context, server.address, fragment);
    await page.waitForSelector("#banner:not([hidden])");
    const [said, foreign] = await page.locator("#banner-text").evaluate((element) => [element.textContent, Boolean(element.querySelector("[lang=en]"))]);
    await page.close();
    return { said, foreign };
  };
  const cloak = { kind: "square-cloak" };
  const scenes = [
    { device: [{ kind: "luneburg-lens", radius: -5 }] },
    { device: [{ ...cloak, kappa: 7 }] },
    { device: [cloak, { ...cloak, position: [5, 0, 0], name: "left" }] },
    { device: [{ kind: "body", shape: "box" }, { kind: "body", shape: "box" }] },
    { device: [cloak], camera: { position: [1, 0, 0] } },
    { device: [{ ...cloak, position: [50, 0, 0] }] },
    { device: [cloak], photograph: { image: "/etc/passwd" } },
    { device: [{ kind: "cylinder-cloak", inner: 9, outer: 5 }] },
    { device: [{ kind: "double-gaussian-cloak", h: 15 }] },
    { device: [{ kind: "grating-carpet", floor: 5 }] },
    { device: [{ kind: "prisms", prism: [0, 1].map((by) => ({ index: 1.5, corners: [[by, by], [5, 0], [0, 5]] })) }] },
    { device: [{ kind: "body", colour: 1 }] },
  ];
  const known = [/Radius ist -5 cm; erlaubt ist/, /Kappa ist 7; erlaubt ist/, /Gerät 1 \("left"\) und Gerät 0 überlappen sich; eines/, /denselben Vorrang/, /Die Kamera steht in Gerät 0/,
    /Gerät 0 .* ragt durch das Foto/, /kann keine öffnen/,
    /erlaubt ist 0,005 bis 4,995 cm, das 0,001- bis 0,999-Fache von außen/, /kleiner als 0,886 sein und ist 1,497/, /Boden ist 5 cm; nötig ist die Breite des Geräts, 60 cm/, /Prisma 1 und Prisma 0 überlappen/, /sagt auf Englisch, warum: unknown key `colour`/];
  const { page } = await open();
  await choose(page, "language", "de");
  for (const [i, scene] of scenes.entries()) {
    const { said, foreign } = await opened(scene);
    assert.match(said, known[i]);
    assert.equal(foreign, i === scenes.length - 1, said);
  }
  await choose(page, "language", "en");
  for (const scene of scenes) {
    const { said, foreign } = await opened(scene);
    assert.ok(foreign && !/ist|Gerät|Englisch/.test(said.replaceAll(/exist|list/g, "")), said);
  }
  await page.close();
});

// Of each frame of a GIF, as the browser decodes it: its size, how long it stays, in seconds, and how far it is from each of some pictures, the
// mean over its bytes.
function framesOf(page, bytes, pictures) {
  return page.evaluate(async ([base64, pictures]) => {
    const data = Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
    const decoder = new ImageDecoder({ data, type: "image/gif" });
    await decoder.completed;
    await decoder.tracks.ready;
    const frames = [];
    for (let frameIndex = 0; frameIndex < decoder.tracks.selectedTrack.frameCount; frameIndex += 1) {
      const { image } = await decoder.decode({ frameIndex });
      const [width, height] = [image.displayWidth, image.displayHeight];
      const context = new OffscreenCanvas(width, height).getContext("2d", { willReadFrequently: true });
      context.drawImage(image, 0, 0);
      const { data } = context.getImageData(0, 0, width, height);
      const apart = pictures.map((picture) => data.reduce((sum, value, i) => sum + Math.abs(value - picture[i]), 0) / data.length);
      frames.push({ width, height, seconds: image.duration / 1e6, apart });
      image.close();
    }
    return frames;
  }, [bytes.toString("base64"), pictures]);
}

test("one turn is saved as a GIF", async () => {
  const { page, complaints } = await open();
  await small(page, "1");
  const shown = await pixels(page);
  const download = page.waitForEvent("download", { timeout: 240000 });
  await page.click("#save-gif");
  const saved = await download;
  assert.equal(saved.suggestedFilename(), "cloakroom.gif");
  const frames = await framesOf(page, readFileSync(await saved.path()), [shown.data]);
  assert.equal(frames.length, 45);
  for (const frame of frames) assert.deepEqual([frame.width, frame.height], [320, 240]);
  assert.ok(Math.abs(frames.reduce((sum, { seconds }) => sum + seconds, 0) - 3) < 0.02);
  // It begins as the page does; a quarter of a turn shows something else.
  const [first, quarter] = [frames[0], frames[11]].map(({ apart }) => apart[0]);
  assert.ok(first < 6 && quarter > 2 * first, `${first} ${quarter}`);
  await finished(page);
  assert.equal(await page.inputValue("#rotation-number"), "10");
  assert.deepEqual(complaints, []);
  await page.close();
});

test("a GIF has every pixel, however its codes run", async () => {
  const { page, complaints } = await open();
  // Few colors far apart, so that neither palette nor dither changes them: noise, for all codes are used up, and pictures of one color or pixel.
  const films = await page.evaluate(async () => {
    const { gif } = await import("./gif.js");
    const colors = [[0, 0, 0], [255, 0, 0], [0, 255, 0], [255, 255, 255]];
    let seed = 1;
    const random = () => (seed = (seed * 48271) % 2147483647) / 2147483647;
    const films = [];
    for (const [width, height, count, frames] of [[150, 120, 4, 3], [150, 100, 2, 2], [120, 120, 1, 2], [1, 1, 1, 1], [258, 1, 3, 1]]) {
      const images = Array.from({ length: frames }, () => {
        const image = new ImageData(width, height);
        for (let i = 0; i < image.data.length; i += 4) image.data.set([...colors[Math.floor(count * random())], 255], i);
        return image;
      });
      const bytes = new Uint8Array(await (await gif(images, 15, async () => {})).arrayBuffer());
      films.push({ bytes: Array.from(bytes), images: images.map(({ data }) => Array.from(data)) });
    }
    return films;
  });
  for (const { bytes, images } of films) {
    const frames = await framesOf(page, Buffer.from(bytes), images);
    assert.equal(frames.length, images.length);
    frames.forEach(({ apart }, i) => assert.equal(apart[i], 0));
  }
  assert.deepEqual(complaints, []);
  await page.close();
});

test("corners of one's own prisms are moved, all prisms that share one together", async () => {
  const { page, complaints } = await open("#prisms");
  await small(page, "1");
  assert.equal(await page.locator(".corner").count(), 6);
  const before = await pixels(page);
  const prisms = () => page.evaluate(() => JSON.parse(atob(location.hash.slice(1).replaceAll("-", "+").replaceAll("_", "/"))).scene.device[0].prism);
  const corners = (list) => list.flatMap((one) => one.corners.map((corner) => corner.join()));
  const was = corners(await prisms());
  // The upper one, of two prisms.
  const upper = page.locator(".corner").nth(1);
  const { x, y, width } = await upper.boundingBox();
  await page.mouse.move(x + width / 2, y + width / 2);
  await page.mouse.down();
  await page.mouse.move(x + width / 2, y + width / 2 - 15, { steps: 3 });
  await page.mouse.up();
  await finished(page);
  const is = corners(await prisms());
  assert.equal(is.filter((one, i) => one !== was[i]).length, 2);
  assert.ok(difference(before, await pixels(page)).most > 20);
  await upper.focus();
  await page.keyboard.press("ArrowUp");
  await finished(page);
  assert.equal(corners(await prisms()).filter((one, i) => one !== is[i]).length, 2);
  assert.deepEqual(await violations(page), []);
  assert.deepEqual(complaints, []);
  await page.close();
});

test("a graded index is seen in the cross-section, with its key", async () => {
  const { page, complaints } = await open("#luneburg-lens");
  // From the root of 2 in the middle to 1 at the border.
  assert.ok(Math.abs(Number(await page.textContent("#index-high")) - Math.SQRT2) < 0.01);
  assert.equal(await page.textContent("#index-low"), "1");
  assert.equal(await page.locator("#shapes image").count(), 1);
  assert.match(await page.textContent("#ruler-words"), /^\d+ cm$/);
  await unfold(page);
  assert.deepEqual(await violations(page), []);
  assert.deepEqual(complaints, []);
  await page.close();
});

const network = Object.values(networkInterfaces()).flat().find(({ family, internal }) => family === "IPv4" && !internal)?.address;

test("a class on one network opens the link, and nobody without it", { skip: !network }, async () => {
  const shared = await startServer("--host", network);
  assert.ok(shared.address.startsWith(`http://${network}:`));
  const { page, complaints } = await openPage(browser.context, shared.address);
  await finished(page);
  assert.deepEqual(complaints, []);
  const { origin, port } = new URL(shared.address);
  assert.equal((await fetch(`${origin}/`)).status, 403);
  await assert.rejects(fetch(`http://127.0.0.1:${port}/`));
  await page.close();
  await shared.end();
});

// Follows a link on the same page, whose address is written anew as soon as it has been read.
async function follow(page, link) {
  await page.goto(`${server.address}${link}`);
  await page.waitForFunction((link) => location.hash !== link, link);
  await finished(page);
}

test("a cloak that is hollow is no metal, and what is in it stays when it is taken away", async () => {
  const { page, complaints } = await open("#open-core");
  await small(page, "1");
  const shows = () => page.locator("#shows input").evaluateAll((all) => all.map(({ value }) => value));
  assert.deepEqual(await shows(), ["cloak", "empty"]);
  assert.match(await says(page), /A hollow cloak and 1 more stand in front of the person\. Its core is open/);
  await page.keyboard.press("b");
  await page.locator("#shows input[value=empty]").check({ force: true });
  await finished(page);
  assert.match(await says(page), /^A ball 8 cm across stands in front/);
  await page.locator("#shows input[value=cloak]").check({ force: true });
  await finished(page);
  assert.match(await says(page), /hollow/);
  assert.ok(!(await page.locator("#banner").isVisible()));
  // What is led around follows the axis of the cloak, and a polarizer half a turn on is the same.
  await follow(page, "#square-cloak-negative-uniaxial&polarizer=180");
  assert.match(await says(page), /horizontal polarizer lets only that polarization pass that is led around/);
  await follow(page, "#standing-cylinder-cloak");
  assert.match(await says(page), /Its ends are not cloaked/);
  // What light is followed through in closed form has no controls of how it is made.
  assert.equal(await page.locator("#keys details[data-name=imperfection]").count(), 0);
  await follow(page, "#double-gaussian-cloak");
  assert.equal(await page.locator("#keys details[data-name=imperfection]").count(), 1);
  assert.ok(!(await says(page)).includes("ends"));
  await follow(page, "#sphere-cloak&show=mirror");
  assert.match(await says(page), /a point or a thread, so nothing/);
  assert.deepEqual(complaints, []);
  await page.close();
});

test("an embedded view of one wavelength has its slider, and a tour begins without light in flight", async () => {
  const embedded = await open("#bodies&embed=wavelength");
  const fields = await embedded.page.locator("input:visible, select:visible").evaluateAll((all) => all.map(({ id }) => id));
  assert.deepEqual(fields, ["wavelength"]);
  assert.match(await says(embedded.page), /of 550 nm/);
  assert.deepEqual(embedded.complaints, []);
  await embedded.page.close();
  const { page, complaints } = await open("#square-cloak&moment=0.5");
  await small(page, "1");
  await page.click("#tour");
  await finished(page);
  assert.ok(!(await page.isChecked("#flight")));
  assert.ok(!(await says(page)).includes("flashes"));
  // The menu leads out of the page of all devices, whose keys turn nothing.
  await page.goto(`${server.address}#gallery`);
  await page.waitForSelector("#cards:not([hidden])");
  await page.keyboard.press("b");
  await page.selectOption("#exhibit", "luneburg-lens");
  await finished(page);
  assert.ok(await page.locator("main").isVisible());
  assert.match(await says(page), /gathers parallel light/);
  await page.selectOption("#exhibit", "eaton-lens");
  await finished(page);
  assert.match(await says(page), /sends all light back/);
  await page.goBack();
  await finished(page);
  assert.match(await says(page), /gathers parallel light/);
  assert.deepEqual(complaints, []);
  await page.close();
  // A photograph that was brought to another page is not to be had.
  const scene = { device: [{ kind: "square-cloak" }], photograph: { image: "holiday.png" } };
  const lost = await open(`#${Buffer.from(JSON.stringify({ scene, samples: 1, width: 320 })).toString("base64url")}`);
  assert.match(await lost.page.textContent("#toast-text"), /of one’s own is not in a link/);
  assert.match(await says(lost.page), /in front of the person/);
  assert.deepEqual(lost.complaints, []);
  await lost.page.close();
});

test("a body has the controls of its shape", async () => {
  const scene = { device: [{ kind: "body", shape: "sphere", radius: 9, index: 1.5 }] };
  const { page, complaints } = await open(`#${Buffer.from(JSON.stringify({ scene, samples: 1, width: 320 })).toString("base64url")}`);
  const sizes = async () => {
    const labels = await page.locator("#keys input[type=number]").evaluateAll((all) => all.map((one) => one.getAttribute("aria-label")));
    return labels.filter((label) => /^(radius|size|thickness|length)/.test(label)).map((label) => label.split(",")[0]);
  };
  assert.deepEqual(await sizes(), ["radius"]);
  for (const [shape, has, caption] of [
    ["box", ["size x", "size y", "size z"], /^A block/],
    ["cylinder", ["radius", "length"], /^A rod 10 cm thick/],
    ["slab", ["thickness"], /^A block/],
    ["sphere", ["radius"], /^A ball 10 cm across/],
  ]) {
    await page.selectOption("#keys select", shape);
    await finished(page);
    assert.deepEqual(await sizes(), has);
    assert.match(await says(page), caption);
    assert.ok(!(await page.locator("#banner").isVisible()), shape);
    assert.equal(await page.evaluate(() => document.activeElement.value), shape);
  }
  assert.deepEqual(complaints, []);
  await page.close();
});

test("the outermost corner goes where the pointer goes", async () => {
  const { page, complaints } = await open("#prisms");
  await small(page, "1");
  const boxes = await page.locator(".corner").evaluateAll((all) => all.map((one) => one.getBoundingClientRect().top));
  const number = boxes.indexOf(Math.min(...boxes));
  const highest = page.locator(".corner").nth(number);
  const { x, y, width, height } = await highest.boundingBox();
  const at = [x + width / 2, y + height / 2];
  await page.mouse.move(...at);
  await page.mouse.down();
  for (let step = 1; step <= 8; step += 1) {
    await page.mouse.move(at[0], at[1] - 3 * step);
    const isThere = ([number, down]) => {
      const { top, height } = document.querySelectorAll(".corner")[number].getBoundingClientRect();
      return Math.abs(top + height / 2 - down) < 2;
    };
    await page.waitForFunction(isThere, [number, at[1] - 3 * step], { timeout: 10000 });
  }
  await page.mouse.up();
  await finished(page);
  assert.deepEqual(complaints, []);
  await page.close();
});
