// Pages of `ninebit inspect` in Chromium. Arguments: the folder of pages, what they must show as JSON, and perhaps a folder for pictures of them.
import { readFileSync, writeFileSync } from "node:fs";
import { strict as assert } from "node:assert";
import { pathToFileURL } from "node:url";
import { join } from "node:path";
import { Browser } from "./browser.mjs";

const [, , folder, wanted, pictures] = process.argv;
const expected = JSON.parse(readFileSync(wanted, "utf8"));
const address = (name) => pathToFileURL(join(folder, name)).href;
const ready = 'window.inspector?.times.first !== undefined || document.getElementById("message").textContent !== ""';
const browser = await Browser.start();
const median = (list) => list.sort((a, b) => a - b)[list.length >> 1];

async function opened(name, options = {}) {
  await browser.open(options.url ?? address(name), options);
  await browser.until(ready);
}

const sound = (name) => assert.deepEqual(browser.complaints(address(name)), [], name);
const digest = () => browser.value("inspector.times.digest");
const text = (id) => browser.value(`document.getElementById("${id}").textContent`);

async function tests() {
  // Open: the picture is the one that the program draws.
  await opened("stone.html");
  assert.equal(await digest(), expected.digest);
  const times = [await browser.value("inspector.times.opened")];
  const seen = [await browser.value("inspector.times.preview")];
  assert.ok(seen[0] === null || seen[0] <= times[0]);

  // Click: the chain ends with the stored word.
  const at = await browser.value(`(() => { const box = inspector.view.canvas.getBoundingClientRect(), v = inspector.view;
    return [box.left + v.left + (${expected.pixel[0]} + .5) * v.zoom, box.top + v.top + (${expected.pixel[1]} + .5) * v.zoom]; })()`);
  await browser.click(...at);
  assert.deepEqual(await browser.value("inspector.chain.trace.pixel"), expected.pixel);
  assert.equal(await browser.value("inspector.chain.trace.word"), expected.word);
  const chain = await text("chain");
  for (const part of ["rasteriser", "texture unit 0", "general stage 0 rgb", "final combiner", expected.shown]) assert.ok(chain.includes(part), `the chain has no ${part}`);
  await browser.press("ArrowRight");
  assert.deepEqual(await browser.value("inspector.at"), [expected.pixel[0] + 1, expected.pixel[1]]);
  await browser.press("ArrowLeft");

  // A slice: what a value depends on stays bright, the rest does not.
  const slice = await browser.value(`(() => { inspector.chain.fill(); const wires = [...document.querySelectorAll("#chain .wire")]; wires.at(-1).click();
    return [document.querySelectorAll("#chain .wire.bright").length, wires.length, document.getElementById("wire").hidden]; })()`);
  assert.ok(slice[0] > 20 && slice[0] < slice[1] && slice[2] === false, `${slice}`);

  // A rule leads to its text.
  await browser.value('document.querySelector("#chain .badge").click()');
  assert.ok((await text("rule-text")).includes("Formula") && (await browser.value('document.getElementById("rule").open')));
  await browser.value('document.getElementById("rule").close()');

  // Edit, undo, redo.
  const mapping = `document.querySelector('[aria-label="Mapping of stage 0 rgb"]')`;
  await browser.value(`(() => { const select = ${mapping}; select.dispatchEvent(new Event("focus")); select.value = "UnsignedIdentity"; select.dispatchEvent(new Event("change")); })()`);
  assert.equal(await digest(), expected.edited, "the edited scene is not what the program draws of it");
  const saved = await browser.value("inspector.text");
  assert.equal(saved, expected.text);
  await browser.value('document.getElementById("undo").click()');
  assert.deepEqual([await digest(), await browser.value("inspector.text === inspector.data.text")], [expected.digest, true]);
  await browser.value('document.getElementById("redo").click()');
  assert.equal(await digest(), expected.edited);

  // A link: this pixel, this change.
  const link = await browser.value("location.href");
  sound("stone.html");
  await opened("stone.html", { url: link });
  assert.deepEqual([await digest(), await browser.value("inspector.text"), await browser.value("inspector.at")], [expected.edited, saved, expected.pixel]);
  for (const hostile of ["#e30", "#####", `#${Buffer.from('{"p":[1e9,-1],"t":99,"e":[9,"x",{}],"v":{"a":[]}}').toString("base64url")}`]) {
    await opened("stone.html", { url: address("stone.html") + hostile });
    assert.equal(await browser.value("inspector.view.picture !== null"), true, hostile);
    sound("stone.html");
  }
  await browser.value('document.getElementById("reset").click()');

  // Policies: a value that changes the pixel does so when it is chosen.
  await browser.value('document.getElementById("tab-rules").click()');
  assert.ok((await text("rules")).includes("CMB-3"));
  await browser.value('inspector.policy("CMB-3", "literal")');
  assert.equal(await digest(), expected.literal);
  await browser.value('document.getElementById("undo").click()');

  // A picture dropped: it differs in one region, or nowhere.
  const drop = (bytes) => `(async () => { const bytes = Uint8Array.from(atob("${bytes}"), (c) => c.charCodeAt(0)); const data = new DataTransfer();
    data.items.add(new File([bytes], "capture.png")); document.body.dispatchEvent(new DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true })); })()`;
  await browser.value(drop(expected.same));
  await browser.until('document.getElementById("regions-sum").textContent !== ""');
  assert.equal(await text("regions-sum"), "0 pixels differ");
  await browser.value(drop(expected.other));
  await browser.until('document.getElementById("regions-sum").textContent !== "0 pixels differ"');
  assert.equal(await text("regions-sum"), expected.differing);
  await browser.value(drop(Buffer.from("no picture").toString("base64")));
  await browser.until('document.getElementById("message").textContent.includes("NB0513")');

  // Scenes with errors: caret and help; the picture before stays.
  await browser.value('inspector.against = ""; inspector.refresh(); document.getElementById("tab-text").click()');
  for (const { name, text: broken, rendered } of expected.bad) {
    await browser.value(`(() => { const area = document.querySelector("#text textarea"); area.value = ${JSON.stringify(broken)}; area.dispatchEvent(new Event("change")); })()`);
    const found = await browser.value('[...document.querySelectorAll("#findings .finding")].map((each) => each.textContent).join("\\n\\n")');
    assert.equal(found.trim(), rendered.trim(), name);
    assert.equal(await browser.value("inspector.view.picture !== null"), true);
  }
  sound("stone.html");

  // A fault of the module ends its instance; the next one goes on with the scene.
  const fault = await browser.value(`(() => { try { inspector.model.ask({ do: "outline" }, { length: 2 ** 31 }); } catch (error) { return error.message; } })()`);
  assert.ok(fault.includes("NB0801"), fault);
  await browser.value("inspector.redraw()");
  assert.equal(await digest(), expected.digest);

  // The page's policy: no inline script but its own, no handler, no evaluation.
  await browser.value(`(() => { const script = document.createElement("script"); script.textContent = "window.ran = 1"; document.body.append(script);
    const image = document.createElement("div"); image.innerHTML = "<img src=x onerror='window.ran = 2'>"; document.body.append(image); setTimeout("window.ran = 3"); })()`).catch(() => {});
  await new Promise((resolve) => setTimeout(resolve, 200));
  assert.equal(await browser.value("window.ran"), undefined);

  // Names with markup are text.
  await opened("markup.html");
  assert.ok((await text("draws")).includes("<img src=x onerror=alert(1)>") && (await browser.value('document.querySelectorAll("img").length')) === 0);
  sound("markup.html");

  // Nothing is wider than the window; nothing has no name for those who cannot see it.
  for (const width of [1280, 1920]) {
    for (const dark of [false, true]) {
      await opened("stone.html", { width, height: 1000, dark });
      for (const tab of ["chain", "rules", "change", "program", "text"]) {
        await browser.value(`document.getElementById("tab-${tab}").click()`);
        assert.ok((await browser.value("document.documentElement.scrollWidth - innerWidth")) <= 0, `${tab} is wider than ${width}`);
        const nameless = await browser.value(`[...document.querySelectorAll("button, select, input, textarea")].filter((each) => each.offsetParent &&
          !(each.textContent.trim() || each.getAttribute("aria-label") || each.closest("label"))).map((each) => each.outerHTML)`);
        assert.deepEqual(nameless, []);
      }
      if (pictures) {
        await browser.value('document.getElementById("tab-chain").click()');
        writeFileSync(join(pictures, `${width}-${dark ? "dark" : "light"}.png`), await browser.picture());
      }
    }
  }

  // What it takes, in milliseconds: printed, not judged, for machines differ.
  for (let n = 0; n < 4; n++) {
    await opened("stone.html");
    times.push(await browser.value("inspector.times.opened"));
    seen.push(await browser.value("inspector.times.preview"));
  }
  const again = (act, time) => browser.value(`(async () => { const times = []; for (let n = 0; n < 15; n++) { ${act}; times.push(inspector.times.${time}); await new Promise((done) => setTimeout(done, 5)); } return times; })()`);
  console.log(`first picture ${Math.round(median(seen))} ms, the module's ${Math.round(median(times))} ms`);
  console.log(`click to chain ${Math.round(median(await again("inspector.choose([100 + n, 90])", "chain")))} ms, of which the trace ${Math.round(median(await again("inspector.choose([100 + n, 80])", "trace")))} ms`);
  console.log(`redraw of 640 x 480 ${Math.round(median(await again("inspector.redraw()", "redraw")))} ms`);
  await opened("small.html");
  console.log(`redraw of 256 x 256 ${Math.round(median(await again("inspector.redraw()", "redraw")))} ms`);
}

try {
  await tests();
} finally {
  await browser.close();
}
