// A page of `ninebit inspect` in Firefox, by its Marionette protocol. Arguments: the page, the digest of its picture, the word of pixel 200,300, its difference from
// float64 in words, and a file with a picture that differs from its own in four pixels.
import { strict as assert } from "node:assert";
import { spawn } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { connect, createServer } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const [, , page, digest, word, ideal, other] = process.argv;
const pause = (time) => new Promise((resolve) => setTimeout(resolve, time));
const port = await new Promise((resolve) => {
  const server = createServer().listen(0, "127.0.0.1", () => {
    const { port } = server.address();
    server.close(() => resolve(port));
  });
});
const profile = mkdtempSync(join(tmpdir(), "ninebit-firefox-"));
writeFileSync(join(profile, "user.js"), `user_pref("marionette.port", ${port});\nuser_pref("browser.shell.checkDefaultBrowser", false);\nuser_pref("datareporting.policy.dataSubmissionEnabled", false);\n`);
const firefox = spawn("firefox", ["--headless", "--marionette", "--no-remote", "--profile", profile], { stdio: "ignore" });
const ended = new Promise((resolve) => firefox.on("exit", resolve));

let socket;
for (let tries = 0; !socket; tries++) {
  assert.ok(tries < 600, "Firefox does not answer");
  await pause(100);
  socket = await new Promise((resolve) => {
    const attempt = connect(port, "127.0.0.1", () => resolve(attempt)).on("error", () => resolve(null));
  });
}
const waiting = new Map();
let bytes = Buffer.alloc(0);
socket.on("data", (part) => {
  bytes = Buffer.concat([bytes, part]);
  for (;;) {
    const colon = bytes.indexOf(":");
    const length = colon < 0 ? NaN : Number(bytes.subarray(0, colon).toString());
    if (!(bytes.length >= colon + 1 + length)) return;
    const message = JSON.parse(bytes.subarray(colon + 1, colon + 1 + length).toString());
    bytes = bytes.subarray(colon + 1 + length);
    // The first is a greeting.
    if (Array.isArray(message)) waiting.get(message[1])?.(message);
  }
});
let next = 0;
const send = async (command, parameters = {}) => {
  const id = ++next;
  const text = JSON.stringify([0, id, command, parameters]);
  const answer = new Promise((resolve) => waiting.set(id, resolve));
  socket.write(`${Buffer.byteLength(text)}:${text}`);
  const [, , error, result] = await answer;
  if (error) throw new Error(error.message);
  return result?.value ?? result;
};
const value = (expression) => send("WebDriver:ExecuteScript", { script: `const page = window.wrappedJSObject ?? window, inspector = page.inspector; return ${expression};`, args: [] });
const until = async (expression) => {
  for (let tries = 0; tries < 600; tries++) {
    if (await value(expression)) return;
    await pause(100);
  }
  throw new Error(`${expression} did not come true`);
};

try {
  await send("WebDriver:NewSession", { capabilities: {} });
  await send("WebDriver:Navigate", { url: pathToFileURL(page).href });
  await until('inspector?.times.first !== undefined || document.getElementById("message").textContent.startsWith("This page cannot be shown")');
  assert.equal(await value('document.getElementById("message").textContent'), "");
  assert.equal(await value("inspector.times.digest"), digest);
  console.log(`first picture ${Math.round(await value("inspector.times.opened"))} ms in Firefox`);
  await value("inspector.choose(page.JSON.parse('[200, 300]'))");
  assert.equal(await value("inspector.chain.trace.word"), Number(word));
  await value("inspector.chain.fill()");
  await value(`(() => { const select = document.querySelector('[aria-label="Scale of stage 0 rgb"]'); select.dispatchEvent(new Event("focus")); select.value = "Two"; select.dispatchEvent(new Event("change")); })()`);
  const edited = await value("inspector.times.digest");
  assert.notEqual(edited, digest);
  // The link opens the same pixel and the same change.
  const link = await value("page.location.href");
  await send("WebDriver:Navigate", { url: "about:blank" });
  await send("WebDriver:Navigate", { url: link });
  await until("inspector?.times.first !== undefined");
  assert.deepEqual([await value("inspector.times.digest"), await value("inspector.at.join()")], [edited, "200,300"]);
  await value('document.getElementById("reset").click()');
  assert.equal(await value("inspector.times.digest"), digest);
  await value('document.getElementById("undo").click()');
  assert.equal(await value("inspector.times.digest"), edited);
  await value('document.getElementById("redo").click()');
  assert.equal(await value("inspector.times.digest"), digest);
  const set = (id, to) => value(`(() => { const select = document.getElementById("${id}"); select.value = "${to}"; select.dispatchEvent(new Event("change")); })()`);
  // Float64 in a second thread.
  await set("against", "ideal");
  await until("inspector.times.heat !== undefined");
  assert.equal(await value('document.getElementById("regions-sum").textContent'), ideal);
  console.log(`float64 beside 640 x 480 ${Math.round(await value("inspector.times.heat"))} ms in Firefox`);
  // A picture that is dropped.
  await value(`(() => { const bytes = new page.Uint8Array(page.JSON.parse("[${[...readFileSync(other)]}]")), data = new page.DataTransfer();
    data.items.add(new page.File(page.Array.of(bytes), "other.png"));
    page.document.body.dispatchEvent(new page.DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true })); })()`);
  await until('document.getElementById("regions-sum").textContent === "4 pixels differ"');
} finally {
  await send("Marionette:Quit", { flags: ["eForceQuit"] }).catch(() => {});
  socket.destroy();
  await ended;
  rmSync(profile, { recursive: true, force: true });
}
