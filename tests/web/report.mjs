// The report of `ninebit replay` in Chromium. Arguments: the folder of `report.html`, and perhaps a folder for pictures of it.
import { writeFileSync } from "node:fs";
import { strict as assert } from "node:assert";
import { pathToFileURL } from "node:url";
import { join } from "node:path";
import { faint, overlapping, unnamed } from "./audit.mjs";
import { Browser } from "./browser.mjs";

const [, , folder, pictures] = process.argv;
const address = pathToFileURL(join(folder, "report.html")).href;
const browser = await Browser.start();

async function opened(options) {
  await browser.open(address, options);
  await browser.until('document.querySelectorAll("figure.live").length === 2');
}

// The colour in a place of the first canvas, as fractions of its width and height.
const color = (x, y) => browser.value(`(() => { const canvas = document.querySelector("figure canvas"); return [...canvas.getContext("2d").getImageData(Math.floor(canvas.width * ${x}), Math.floor(canvas.height * ${y}), 1, 1).data]; })()`);
const press = (name) => browser.value(`[...document.querySelectorAll("figure button")].find((each) => (each.getAttribute("aria-label") ?? each.textContent) === ${JSON.stringify(name)}).click()`);
const said = () => browser.value('document.querySelector("figure .said").textContent');
// A pixel of the picture as the report holds it.
const panel = (number, x, y) => browser.value(`(() => { const image = document.querySelector("figure img"), sheet = document.createElement("canvas"); [sheet.width, sheet.height] = [image.naturalWidth, image.naturalHeight];
  const context = sheet.getContext("2d"); context.drawImage(image, 0, 0); return [...context.getImageData(${number} * ((image.naturalWidth - 16) / 3 + 8) + ${x}, ${y}, 1, 1).data]; })()`);

async function tests() {
  for (const width of [1280, 390]) {
    for (const dark of [false, true]) {
      await opened({ width, height: 900, dark });
      const where = `${width}, ${dark ? "dark" : "light"}`;
      assert.ok((await browser.value("document.documentElement.scrollWidth - innerWidth")) <= 0, `${where} is wider`);
      const told = unnamed(await browser.told());
      const [contrast, overlaps] = [await browser.value(`(${faint})()`), await browser.value(`(${overlapping})()`)];
      assert.deepEqual({ where, faint: contrast.found, overlaps: overlaps.found, unnamed: told.found }, { where, faint: [], overlaps: [], unnamed: [] });
      const ground = await browser.value("getComputedStyle(document.body).backgroundColor.match(/\\d+/g).slice(0, 3).map(Number)");
      assert.equal(ground.every((part) => (dark ? part < 64 : part > 192)), true, `${where}: ${ground}`);
      assert.deepEqual(browser.complaints(address), [], where);
      if (pictures) writeFileSync(join(pictures, `report-${width}-${dark ? "dark" : "light"}.png`), await browser.picture());
    }
  }
  await opened({});
  // What is said of a scene is said once.
  const text = await browser.value("document.body.innerText");
  assert.equal(text.match(/CMB-8=each draws what is expected/g).length, 1);
  assert.ok((await browser.value('document.querySelectorAll("tr.other").length')) > 0, "no line of the traces is marked");

  // Enlarged, a pixel is a block of one colour: that of the panel.
  const at = (await browser.value("document.querySelector('figure').dataset.first")).split(",").map(Number);
  const [expected, drawn] = [await panel(0, ...at), await panel(1, ...at)];
  assert.notDeepEqual(expected, drawn);
  await press("First difference");
  assert.ok((await browser.value('document.querySelector("figure .zoom").textContent')).startsWith("16"));
  for (const part of [0.16, 0.164]) assert.deepEqual(await color(part, 0.5), expected, "side by side, the left view is the expected picture");
  assert.deepEqual(await color(0.5, 0.5), drawn);
  await press("Zoom in");
  assert.ok((await browser.value('document.querySelector("figure .zoom").textContent')).startsWith("32"));

  // In turns.
  await press("Blink");
  const seen = new Set();
  for (let tries = 0; tries < 100 && seen.size < 2; tries++) {
    const [name, shown] = await browser.value('[document.querySelector("figure .said").textContent, [...document.querySelector("figure canvas").getContext("2d").getImageData(document.querySelector("figure canvas").width / 2, document.querySelector("figure canvas").height / 2, 1, 1).data]]');
    assert.deepEqual(shown, { expected, drawn }[name], name);
    seen.add(name);
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
  assert.equal(seen.size, 2, "the pictures do not take turns");
  // By hand they stand.
  await browser.value('document.querySelector("figure canvas").focus()');
  const before = await said();
  await browser.press(" ");
  const after = await said();
  assert.notEqual(before, after);
  await new Promise((resolve) => setTimeout(resolve, 1000));
  assert.equal(await said(), after);

  // Parted by a line.
  await press("Swipe");
  const swiped = (value) => browser.value(`(() => { const field = document.querySelector("figure input"); field.value = ${value}; field.dispatchEvent(new Event("input")); return field.hidden; })()`);
  assert.equal(await swiped(900), false);
  assert.deepEqual(await color(0.5, 0.5), expected);
  await swiped(100);
  assert.deepEqual(await color(0.5, 0.5), drawn);

  await press("All");
  assert.equal(await browser.value('document.querySelectorAll("figure")[1].querySelectorAll("[aria-label=View]").length'), 0, "one picture alone is not compared");
  assert.deepEqual(browser.complaints(address), []);
}

try {
  await tests();
} finally {
  await browser.close();
}
