// Pages of `ninebit inspect` in a browser. Arguments: its name, the folder of pages, what they must show as JSON, and perhaps a folder for pictures of them.
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { strict as assert } from "node:assert";
import { pathToFileURL } from "node:url";
import { join } from "node:path";
import { faint, overlapping, unnamed } from "./audit.mjs";
import { Browser } from "./browser.mjs";

const [, , name, folder, wanted, pictures] = process.argv;
const expected = JSON.parse(readFileSync(wanted, "utf8"));
const address = (name) => pathToFileURL(join(folder, name)).href;
const ready = 'window.inspector?.times.first !== undefined || document.getElementById("message")?.textContent.startsWith("This page cannot be shown")';
const browser = await Browser.start(name);
const pause = (time) => new Promise((resolve) => setTimeout(resolve, time));
const median = (list) => list.sort((a, b) => a - b)[list.length >> 1];

async function opened(name, options = {}) {
  await browser.open(options.url ?? address(name), options);
  await browser.until(ready);
}

const sound = async (name) => assert.deepEqual(await browser.complaints(address(name)), [], name);
const digest = () => browser.value("inspector.times.digest");
// A choice in a field; a value of it that still moves.
const field = (label) => `[...document.querySelectorAll("select, input")].find((each) => each.getAttribute("aria-label") === ${JSON.stringify(label)})`;
const set = (label, value, event = "change") => browser.value(`(() => { inspector.chain.fill(); const field = ${field(label)}; field.dispatchEvent(new Event("focus")); field.value = ${JSON.stringify(value)}; field.dispatchEvent(new Event("${event}")); })()`);
const text = (id) => browser.value(`document.getElementById("${id}").textContent`);

async function tests() {
  // Open: the picture is the one that the program draws.
  await opened("stone.html");
  assert.equal(await digest(), expected.digest);
  const times = [await browser.value("inspector.times.opened")];
  const seen = [await browser.value("inspector.times.preview")];
  assert.ok(seen[0] === null || seen[0] <= times[0]);

  // Click: the chain ends with the stored word.
  // A pixel is larger than one of the screen, which some browsers round to.
  const at = await browser.value(`(() => { const box = inspector.view.canvas.getBoundingClientRect(), v = inspector.view; v.scale(2, box.width / 2, box.height / 2);
    return [box.left + v.left + (${expected.pixel[0]} + .5) * v.zoom, box.top + v.top + (${expected.pixel[1]} + .5) * v.zoom]; })()`);
  await browser.click(...at);
  await browser.value("inspector.view.fit()");
  assert.deepEqual(await browser.value("inspector.chain.trace.pixel"), expected.pixel);
  assert.equal(await browser.value("inspector.chain.trace.word"), expected.word);
  const chain = await text("chain");
  for (const part of ["rasteriser", "texture unit 0", "general stage 0 rgb", "final combiner", expected.shown]) assert.ok(chain.includes(part), `the chain has no ${part}`);
  await browser.press("ArrowRight");
  assert.deepEqual(await browser.value("inspector.at"), [expected.pixel[0] + 1, expected.pixel[1]]);
  await browser.press("ArrowLeft");

  // The strip: the pixel's way, which ends with what is stored; a cell leads to its unit. What carries there is folded.
  const way = await browser.value(`[...document.querySelectorAll("#chain .strip .cell")].map((cell) => [cell.querySelector(".title").textContent, cell.querySelector(".how").textContent, [...cell.querySelectorAll(".channel")].map((each) => +each.textContent)])`);
  assert.deepEqual([way[0][0], way.at(-1)[0]], ["texture 0", "stored"], JSON.stringify(way));
  assert.ok(way.some(([title, how]) => title === "stage 0, AB" && how === "texture 0 · constant 0 → spare 0"), JSON.stringify(way));
  const [red, green, blue] = expected.shown.match(/\d+/g).map(Number);
  assert.deepEqual(way.at(-1)[2], red === green && green === blue ? [red] : [red, green, blue]);
  await browser.value(`document.querySelector('#chain .strip .cell[data-block="texture unit 0"]').click()`);
  assert.equal(await browser.value(`document.activeElement.closest(".unit")?.getAttribute("aria-label")`), "texture unit 0");
  assert.deepEqual(await browser.value(`[...document.querySelectorAll("#chain details.folded")].map((each) => [each.open, each.querySelector(".unit").getAttribute("aria-label")]).filter(([open]) => open)`), []);

  // Marks of what other readings of rules would change: every rule that would change the pixel stands at the last cell, and its unit says what it would hold.
  await browser.value(`(delete inspector.times.marks, inspector.choose(${JSON.stringify(expected.pixel)}))`);
  await browser.until("inspector.times.marks !== undefined");
  const marks = await browser.value(`[...document.querySelectorAll("#chain .strip .cell")].map((cell) => [cell.querySelector(".reading").textContent, cell.title])`);
  for (const { name, shown } of expected.readings) {
    assert.ok(marks.at(-1)[0].includes(name.split("=")[0]), `${marks.at(-1)}`);
    assert.ok(marks.at(-1)[1].includes(`under ${name} (`) && marks.at(-1)[1].includes(`: ${shown} instead of `), `${name} ${shown}: ${marks.at(-1)[1]}`);
    assert.ok((await browser.value(`document.querySelector('#chain .unit[aria-label="store"] .readings').textContent`)).includes(`under ${name} (`));
  }
  assert.equal(marks[0][0], "", "a fetched texel depends on no reading");
  console.log(`marks of other readings ${Math.round(await browser.value("inspector.times.marks"))} ms after the strip`);

  // Help, by its key.
  await browser.value("inspector.view.canvas.focus()");
  await browser.press("?");
  assert.equal(await browser.value('document.getElementById("guide").open'), true);
  await browser.value('document.getElementById("guide").close()');

  // The program beside what its lines yield: it is changed as one types, and says what is wrong where.
  await browser.value('document.getElementById("tab-program").click()');
  const type = (from, to, event) => browser.value(`(async () => { const area = document.querySelector(".listing textarea"); area.value = area.value.replace(${JSON.stringify(from)}, ${JSON.stringify(to)}); area.dispatchEvent(new Event("${event}"));
    await new Promise((done) => requestAnimationFrame(() => setTimeout(done))); return [...document.querySelectorAll(".beside .row")].map((row) => row.textContent); })()`);
  const stage = way.find(([title]) => title === "stage 0, AB")[2];
  assert.ok((await type("", "", "input")).includes(stage.join("")), `${stage}`);
  assert.ok((await type("expand(tex0)", "expand(tex9)", "input")).some((row) => row.startsWith("✗ there is no register")));
  assert.equal(await digest(), expected.digest);
  await type("expand(tex9)", "unsigned(tex0)", "input");
  assert.equal(await digest(), expected.edited);
  await type("unsigned(tex0)", "expand(tex0)", "change");
  assert.equal(await digest(), expected.digest);
  if (await browser.value("inspector.past.length > 0")) await browser.value('document.getElementById("undo").click()');
  // As a function of other languages: the lines that a step names have its value.
  for (const [language, whole] of Object.entries(expected.lowered)) {
    const [code, beside] = await browser.value(`(() => { const select = document.querySelector('[aria-label="Language of the program"]'); select.value = "${language}"; select.dispatchEvent(new Event("change"));
      return [document.querySelector(".listing textarea").value, [...document.querySelectorAll(".beside .row")].map((row) => row.textContent)]; })()`);
    assert.equal(code, whole, language);
    const at = code.split("\n").findIndex((line) => line.includes("stage0_rgb_AB_r_output = "));
    assert.equal(beside[at], String(stage[0]), `${beside}`);
  }
  await browser.value(`(() => { const select = document.querySelector('[aria-label="Language of the program"]'); select.value = "combiners"; select.dispatchEvent(new Event("change")); })()`);

  // Fields are found by words of their path.
  await browser.value('document.getElementById("tab-change").click()');
  const seek = (words) => browser.value(`(() => { const field = document.querySelector("#change input[type=search]"); field.value = "${words}"; field.dispatchEvent(new Event("input")); return [...document.querySelectorAll("#change [role=status] .label")].map((each) => each.textContent); })()`);
  assert.ok((await seek("draws constants")).every((path) => path.includes("constants")) && (await seek("draws constants")).length === 2);
  assert.deepEqual([await seek("no such field"), await seek("")], [[], []]);
  await browser.value('document.getElementById("tab-chain").click()');

  // A slice: what a value depends on stays bright, the rest does not.
  const slice = await browser.value(`(() => { inspector.chain.fill(); const wires = [...document.querySelectorAll("#chain .wire")]; [...document.querySelectorAll('#chain .unit[aria-label="store"] .wire')].at(-1).click();
    return [document.querySelectorAll("#chain .wire.bright").length, wires.length, document.getElementById("wire").hidden]; })()`);
  assert.ok(slice[0] > 20 && slice[0] < slice[1] && slice[2] === false, `${slice}`);

  // A rule leads to its text.
  await browser.value('document.querySelector("#chain .badge").click()');
  assert.ok((await text("rule-text")).includes("Formula") && (await browser.value('document.getElementById("rule").open')));
  // Its window begins at its beginning, says each heading once, and shows code as code.
  const shown = await browser.value(`(() => { inspector.rule("CMB-3"); const box = document.getElementById("rule").getBoundingClientRect(), title = document.getElementById("rule-title").getBoundingClientRect();
    return { heads: [...document.querySelectorAll("#rule-text h3")].map((each) => each.textContent), codes: document.querySelectorAll("#rule-text p code").length, text: document.getElementById("rule").innerText,
      scrolled: document.getElementById("rule-text").scrollTop + document.getElementById("rule").scrollTop, whole: box.top >= 0 && box.bottom <= innerHeight && title.top >= box.top }; })()`);
  assert.ok(shown.scrolled === 0 && shown.whole, JSON.stringify(shown));
  assert.ok(shown.heads.includes("Commands") && !shown.heads.includes("Command") && new Set(shown.heads).size === shown.heads.length, `${shown.heads}`);
  assert.ok(shown.codes > 3 && !shown.text.includes("`"), shown.text);
  await browser.value('[...document.querySelectorAll("#rule-text button.rule")].at(-1).click()');
  assert.ok(!(await text("rule-title")).startsWith("CMB-3 ") && (await browser.value('document.getElementById("rule").open')));
  await browser.value('document.getElementById("rule").close()');

  // Edit, undo, redo.
  await set("Mapping of stage 0 rgb", "UnsignedIdentity");
  assert.equal(await digest(), expected.edited, "the edited scene is not what the program draws of it");
  const saved = await browser.value("inspector.text");
  assert.equal(saved, expected.text);
  await browser.value('document.getElementById("undo").click()');
  assert.deepEqual([await digest(), await browser.value("inspector.text === inspector.data.text")], [expected.digest, true]);
  await browser.value('document.getElementById("redo").click()');
  assert.equal(await digest(), expected.edited);

  // The changed scene is saved as it stands.
  await browser.downloads(folder);
  await browser.value('document.getElementById("save").click()');
  const file = join(folder, "lit-stone.ron");
  for (let tries = 0; tries < 200 && !(existsSync(file) && readFileSync(file, "utf8") === saved); tries++) await pause(20);
  assert.equal(readFileSync(file, "utf8"), saved);

  // A link: this pixel, this change.
  const link = await browser.value("location.href");
  await sound("stone.html");
  await opened("stone.html", { url: link });
  assert.deepEqual([await digest(), await browser.value("inspector.text"), await browser.value("inspector.at")], [expected.edited, saved, expected.pixel]);
  for (const hostile of ["#e30", "#####", `#${Buffer.from('{"p":[1e9,-1],"t":99,"e":[9,"x",{}],"v":{"a":[]}}').toString("base64url")}`]) {
    await opened("stone.html", { url: address("stone.html") + hostile });
    assert.equal(await browser.value("inspector.view.picture !== null"), true, hostile);
    if (hostile === "#####") assert.ok((await text("message")).startsWith("The address is not one of this page"), await text("message"));
    await sound("stone.html");
  }
  // A link of a long change holds it; one that would be too long is refused, and says nothing else.
  await browser.value('document.getElementById("reset").click()');
  const long = (length) => browser.value(`inspector.commit(inspector.data.text + "\\n// " + "\u00e9#".repeat(${length}))`);
  await long(150_000);
  await browser.value("inspector.address.write()");
  const [longLink, longText] = [await browser.value("location.href"), await browser.value("inspector.text")];
  await sound("stone.html");
  await opened("stone.html", { url: longLink });
  assert.equal((await browser.value("inspector.text")) === longText, true, "the link of a long change has another text");
  // What cannot be compressed.
  await browser.value(`inspector.commit(inspector.data.text + "\\n// " + Array.from({ length: 30 }, () => [...crypto.getRandomValues(new Uint8Array(60000))].map((n) => n.toString(36)).join("")).join(""))`);
  await browser.value("inspector.address.share()");
  assert.deepEqual([await browser.value("location.hash"), (await text("message")).startsWith("The changes are too long for a link")], ["", true]);
  await sound("stone.html");
  await browser.value('document.getElementById("reset").click()');

  // Policies: a value that changes the pixel does so when it is chosen.
  await browser.value('document.getElementById("tab-rules").click()');
  assert.ok((await text("rules")).includes("CMB-3"));
  await browser.value(`inspector.choose(${JSON.stringify(expected.pixel)})`);
  assert.equal(await browser.value('document.querySelector("#rules p").textContent'), expected.undecided);
  await browser.until(`document.querySelectorAll("#rules canvas.small").length > 0 && [...document.querySelectorAll("#rules canvas.small")].every((canvas) => canvas.width > 0)`);
  await browser.value('inspector.policy("CMB-3", "literal")');
  assert.equal(await digest(), expected.literal);
  await browser.value('document.getElementById("undo").click()');

  // Float64 is another thread's work: the page answers meanwhile, and what is asked for in its place is shown.
  const compare = (value) => browser.value(`(() => { const select = document.getElementById("against"); select.value = "${value}"; select.dispatchEvent(new Event("change")); })()`);
  await browser.value(`(() => { inspector.gaps = []; let last = performance.now(); const tick = () => { const now = performance.now(); inspector.gaps.push(now - last); last = now; requestAnimationFrame(tick); }; requestAnimationFrame(tick); })()`);
  await browser.value('document.getElementById("tab-chain").click()');
  await compare("ideal");
  await browser.value("inspector.gaps.length = 0");
  assert.equal(await text("regions-sum"), "Comparing with float64 …");
  await browser.value("inspector.choose([10, 10])");
  assert.deepEqual(await browser.value("inspector.chain.trace.pixel"), [10, 10]);
  await browser.until("inspector.times.heat !== undefined");
  assert.equal(await text("regions-sum"), expected.ideal);
  console.log(`float64 beside 640 x 480 ${Math.round(await browser.value("inspector.times.heat"))} ms; the page never stood for longer than ${Math.round(await browser.value("Math.max(...inspector.gaps)"))} ms`);
  await compare("ideal");
  await compare("CMB-3=literal");
  await pause(300);
  assert.equal(await text("regions-sum"), expected.against_literal);
  // Both pictures: beside each other, in turn, parted.
  const shownAs = (way) => browser.value(`(() => { const select = document.getElementById("way"); select.value = "${way}"; select.dispatchEvent(new Event("change"));
    const v = inspector.view, at = (sheet) => [...sheet.getContext("2d").getImageData(${expected.pixel[0]}, ${expected.pixel[1]}, 1, 1).data].slice(0, 3).join(", "); return [v.way, at(v.sheet), v.other ? at(v.other) : null]; })()`);
  const pixelUnder = await browser.value(`inspector.bytesAt(${JSON.stringify(expected.pixel)}, inspector.elsewhere({ policies: inspector.under("CMB-3=literal") })).slice(0, 3).join(", ")`);
  const own = expected.shown.split(", ").slice(0, 3).join(", ");
  assert.notEqual(pixelUnder, own);
  for (const way of ["side by side", "blink", "swipe"]) assert.deepEqual(await shownAs(way), [way, own, pixelUnder]);
  assert.equal((await shownAs("difference"))[2], null);
  assert.equal(await digest(), expected.digest);
  // The state before, and another scene.
  await set("Mapping of stage 0 rgb", "UnsignedIdentity");
  await compare("before");
  const changedPixels = await text("regions-sum");
  assert.ok(/^[1-9]\d* pixels differ/.test(changedPixels), changedPixels);
  assert.equal((await shownAs("swipe"))[2], own);
  await browser.value('document.getElementById("undo").click()');
  await browser.value(`inspector.dropped("other.ron", new TextEncoder().encode(${JSON.stringify(expected.text)}))`);
  assert.equal(await text("regions-sum"), changedPixels);
  assert.equal(await digest(), expected.digest);
  await browser.value(`inspector.dropped("broken.ron", new TextEncoder().encode("(version: 1, profil: Nv2a)"))`);
  assert.ok((await text("message")).startsWith("broken.ron cannot be drawn"), await text("message"));
  assert.equal(await digest(), expected.digest);
  await compare("");
  assert.equal(await text("regions-sum"), "", "what was compared before is still there to be read");

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
  await browser.value('(inspector.against = "", inspector.refresh(), document.getElementById("tab-text").click())');
  // The picture follows while somebody types.
  for (const [typed, drawn] of [[expected.text, expected.edited], [null, expected.digest]]) {
    await browser.value(`(async () => { const area = document.querySelector("#text textarea"); area.value = ${JSON.stringify(typed)} ?? inspector.text; area.dispatchEvent(new Event("input")); await new Promise((done) => requestAnimationFrame(() => setTimeout(done))); })()`);
    assert.equal(await digest(), drawn);
  }
  // A few as somebody would type them in, all as the page reads them.
  const findings = '[...document.querySelectorAll("#findings .finding")].map((each) => each.textContent).join("\\n\\n").trim()';
  for (const { name, text: broken, rendered } of expected.bad.filter((_, n) => n % 20 === 0)) {
    await browser.value(`(() => { const area = document.querySelector("#text textarea"); area.value = ${JSON.stringify(broken)}; area.dispatchEvent(new Event("change")); })()`);
    assert.equal(await browser.value(findings), rendered.trim(), name);
    assert.equal(await browser.value("inspector.view.picture !== null"), true);
  }
  const all = await browser.value(`${JSON.stringify(expected.bad.map((each) => each.text))}.map((text) => [inspector.open(text), ${findings}])`);
  expected.bad.forEach(({ name, rendered }, n) => assert.deepEqual(all[n], [false, rendered.trim()], name));
  console.log(`${all.length} broken scenes with their findings`);
  await sound("stone.html");

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
  await sound("markup.html");

  // Draws to step through: picture, pixel, depth buffer, stencils and comparison are those after the draw.
  await opened("steps.html");
  for (const { until, digest: after, word, depth, stencil, ideal } of expected.steps) {
    await browser.value(`document.querySelectorAll("#draws button")[${until}].click()`);
    assert.equal(await digest(), after, `after draw ${until}`);
    await browser.value("inspector.choose([20, 20])");
    assert.equal(await browser.value("inspector.chain.trace.word"), word);
    await browser.value(`(() => { const select = document.getElementById("channels"); select.value = "depth"; select.dispatchEvent(new Event("change")); inspector.choose([20, 20]); })()`);
    assert.ok((await text("here")).endsWith(` depth ${depth} stencil ${stencil}`), await text("here"));
    const shades = await browser.value(`[[20, 20], [60, 60]].map(([x, y]) => inspector.view.sheet.getContext("2d").getImageData(x, y, 1, 1).data[0])`);
    assert.ok(shades[0] < 255 && shades[1] === 255, `depths ${shades}`);
    await browser.value(`(() => { const select = document.getElementById("channels"); select.value = "stencil"; select.dispatchEvent(new Event("change")); })()`);
    assert.equal(await browser.value('inspector.view.sheet.getContext("2d").getImageData(20, 20, 1, 1).data[0]'), stencil);
    await browser.value(`(() => { const select = document.getElementById("channels"); select.value = "colour"; select.dispatchEvent(new Event("change")); delete inspector.times.heat; })()`);
    await compare("ideal");
    await browser.until("inspector.times.heat !== undefined");
    assert.equal(await text("regions-sum"), ideal);
    await compare("");
  }
  await browser.value("inspector.view.canvas.focus()");
  await browser.press(",");
  assert.equal(await browser.value("inspector.until"), expected.steps.length - 2);
  await sound("steps.html");

  // A gallery opened as a file: filters, and a scene that shares script and module with others, a second thread included.
  const only = async (page, asked) => assert.deepEqual((await browser.complaints(page)).filter((each) => each !== `asked for ${asked}` && !each.endsWith(".png")), [], page);
  const gallery = address("gallery/index.html");
  await browser.open(gallery);
  await browser.until('document.querySelectorAll(".scenes li").length === 4 && [...document.images].every((image) => image.complete && image.naturalWidth > 0)');
  await browser.value(`[...document.querySelectorAll("button.tag")].find((button) => button.dataset.tag === "fog").click()`);
  assert.deepEqual(await browser.value(`[document.getElementById("count").textContent, [...document.querySelectorAll(".scenes li")].filter((each) => each.getClientRects().length).length]`), ["3 of 4 scenes", 3]);
  await browser.value(`(() => { document.querySelector('button.tag[aria-pressed="true"]').click(); const search = document.getElementById("search"); search.value = "rock face"; search.dispatchEvent(new Event("input")); })()`);
  assert.equal(await text("count"), "1 of 4 scenes");
  for (const [width, dark] of [[1280, false], [390, true]]) {
    await browser.open(gallery, { width, dark });
    await browser.until('document.querySelectorAll(".scenes li").length === 4');
    assert.deepEqual([(await browser.value(`(${faint})()`)).found, await browser.value("document.documentElement.scrollWidth > innerWidth")], [[], false]);
  }
  await only(gallery, gallery);
  const beside = await browser.value(`[...document.querySelectorAll(".scenes a")].map((link) => link.href).find((link) => link.includes("lit-stone"))`);
  await opened("", { url: beside });
  assert.equal(await digest(), expected.digest);
  await compare("ideal");
  await browser.until("inspector.times.heat !== undefined");
  assert.equal(await text("regions-sum"), expected.ideal);
  await only(beside, address("gallery/inspector.js"));

  // The coordinate r of a texture shader is no red of a register.
  // A page that begins with a renderer's shortcut: the picture is as the renderer draws it, or by the rules, and the address says which.
  await opened("variant.html");
  assert.equal(await digest(), expected.variant[0]);
  const choose = (id, value) => browser.value(`(() => { const field = document.getElementById("${id}"); field.value = ${JSON.stringify(value)}; field.dispatchEvent(new Event("change")); return field.value; })()`);
  assert.equal(await choose("against", "rules"), "rules");
  assert.ok(/^[1-9]\d* pixels differ/.test(await text("regions-sum")), await text("regions-sum"));
  await choose("variant", "");
  assert.equal(await digest(), expected.variant[1]);
  const byRules = await browser.value("inspector.address.write().then(() => location.href)");
  await opened("", { url: byRules });
  assert.equal(await digest(), expected.variant[1], "the address does not say by what the picture is drawn");
  await sound("variant.html");

  await opened("mirror-ball.html");
  await browser.value(`(() => { inspector.choose([128, 128]); inspector.chain.fill(); })()`);
  const boxes = await browser.value(`[...document.querySelectorAll("#chain .box")].map((box) => [box.querySelector(".name").textContent, box.querySelector(".how").textContent])`);
  assert.ok(["s", "t", "r"].map((axis) => `coordinate.${axis}`).every((name) => boxes.some(([each]) => each === name)), JSON.stringify(boxes));
  assert.deepEqual(boxes.filter(([name, how]) => (/^unit\d$/.test(name) && !how.startsWith("mix ")) || (how.startsWith("float ") && /unit\d/.test(how))), []);
  await sound("mirror-ball.html");

  // A program in another language: its boxes can be changed, the page says what that does, and undo brings the language back.
  for (const { page, part, value, digest: changed, text: rewritten } of expected.rewritten) {
    await opened(page);
    const [before, was] = [await digest(), await browser.value("inspector.text")];
    await set(part, value);
    assert.deepEqual([await digest(), await browser.value("inspector.text")], [changed, rewritten], page);
    assert.ok((await text("message")).includes("combiner language"), page);
    await browser.value('document.getElementById("undo").click()');
    assert.deepEqual([await digest(), await browser.value("inspector.text")], [before, was], page);
    await sound(page);
  }

  // Words pasted in become the program.
  await browser.value('document.getElementById("tab-program").click()');
  await browser.value(`(() => { const area = document.querySelector('textarea[aria-label="Program to paste"]'); area.value = ${JSON.stringify(expected.words)}; [...document.querySelectorAll("#program button")].at(-1).click(); })()`);
  assert.equal(await digest(), expected.pasted);

  // While a colour is dragged the picture follows; one step of undo takes back the whole of it.
  await opened("small.html");
  await browser.value('document.getElementById("tab-program").click()');
  const first = await digest();
  const seenDigests = new Set([first]);
  for (const value of ["#400000", "#800000", "#c00000"]) {
    await set("constant 0, colour", value, "input");
    await browser.value("new Promise((done) => requestAnimationFrame(() => setTimeout(done)))");
    seenDigests.add(await digest());
  }
  assert.deepEqual([seenDigests.size, await browser.value("inspector.past.length")], [4, 0]);
  await set("constant 0, colour", "#c00000");
  assert.equal(await browser.value("inspector.past.length"), 1);
  await browser.value('document.getElementById("undo").click()');
  assert.equal(await digest(), first);

  // From a unit to its fields in the scene's text.
  await opened("stone.html");
  await browser.value(`(() => { inspector.chain.fill(); [...document.querySelectorAll("#chain .way")].find((each) => each.textContent === "texture").click(); })()`);
  assert.equal(await browser.value("document.activeElement.parentElement.dataset.path"), expected.texture);
  assert.ok(await browser.value("document.activeElement.parentElement.open"));

  // Nothing is wider than the window or lies on another thing; all text stands out of its ground; all has a name for those who cannot see it.
  const counts = { texts: 0, boxes: 0, controls: 0 };
  for (const width of [390, 1280, 1920]) {
    for (const dark of [false, true]) {
      await opened("stone.html", { width, height: 1000, dark });
      await browser.value("inspector.choose([200, 300])");
      for (const tab of ["chain", "rules", "change", "program", "text"]) {
        await browser.value(`(document.getElementById("tab-${tab}").click()${tab === "chain" ? ", inspector.chain.fill()" : ""})`);
        const where = `${tab} at ${width}, ${dark ? "dark" : "light"}`;
        assert.ok((await browser.value("document.documentElement.scrollWidth - innerWidth")) <= 0, `${where} is wider`);
        const contrast = await browser.value(`(${faint})()`);
        const overlaps = await browser.value(`(${overlapping})()`);
        const told = unnamed(await browser.told());
        assert.deepEqual({ where, faint: contrast.found, overlaps: overlaps.found, unnamed: told.found }, { where, faint: [], overlaps: [], unnamed: [] });
        for (const landmark of told.landmarks ? ["banner ", "main Picture", "region Pixel"] : []) assert.ok(told.landmarks.includes(landmark), `${where}: ${told.landmarks}`);
        counts.texts += contrast.count;
        counts.boxes += overlaps.count;
        counts.controls += told.count;
      }
      if (pictures) {
        await browser.value('document.getElementById("tab-chain").click()');
        writeFileSync(join(pictures, `${width}-${dark ? "dark" : "light"}.png`), await browser.picture());
      }
    }
  }
  console.log(`${counts.texts} texts of enough contrast, ${counts.boxes} boxes apart, ${counts.controls} controls with names`);
  // These find what they are for.
  await browser.value(`document.body.append(...["#888", "#000"].map((color) => { const label = document.createElement("b"); label.textContent = "planted"; label.setAttribute("style", ""); Object.assign(label.style, { position: "fixed", left: "9px", top: "9px", background: "#777", color }); return label; }), document.createElement("select"))`);
  assert.ok((await browser.value(`(${faint})()`)).found.some((each) => each.includes("planted")));
  assert.ok((await browser.value(`(${overlapping})()`)).found.some((each) => each.includes("planted")));
  if (await browser.told()) assert.ok(unnamed(await browser.told()).found.some((each) => each.includes("combobox")));

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
  const dragged = (count) => browser.value(`(async () => { const times = []; document.getElementById("tab-program").click(); for (let n = 0; n < ${count}; n++) { const field = ${field("constant 0, colour")}; field.value = "#0000" + (16 + n).toString(16);
    field.dispatchEvent(new Event("input")); await new Promise((done) => requestAnimationFrame(() => setTimeout(done))); times.push(inspector.times.drag); } return times; })()`);
  console.log(`a step of dragging, 640 x 480, ${Math.round(median(await dragged(15)))} ms`);
  await opened("small.html");
  console.log(`a step of dragging, 256 x 256, ${Math.round(median(await dragged(15)))} ms`);
  console.log(`redraw of 256 x 256 ${Math.round(median(await again("inspector.redraw()", "redraw")))} ms`);
}

try {
  await tests();
} finally {
  await browser.close();
}
