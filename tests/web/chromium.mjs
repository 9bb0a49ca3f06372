// Drives Chromium by its DevTools protocol over a pipe: no package, no port.
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { Browser } from "./browser.mjs";

export class Chromium extends Browser {
  static async start(program = process.env.CHROMIUM || "chromium") {
    const browser = new Chromium();
    browser.profile = mkdtempSync(join(tmpdir(), "ninebit-browser-"));
    const options = ["--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run", "--remote-debugging-pipe", `--user-data-dir=${browser.profile}`];
    browser.process = spawn(program, options, { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
    browser.ended = new Promise((resolve) => browser.process.on("exit", resolve));
    browser.waiting = new Map();
    browser.events = [];
    browser.next = 0;
    let rest = "";
    browser.process.stdio[4].setEncoding("utf8").on("data", (part) => {
      const messages = (rest + part).split("\0");
      rest = messages.pop();
      for (const message of messages.map((text) => JSON.parse(text))) {
        if (message.id === undefined) browser.events.push(message);
        else {
          const { resolve, reject } = browser.waiting.get(message.id);
          browser.waiting.delete(message.id);
          if (message.error) reject(new Error(message.error.message));
          else resolve(message.result);
        }
      }
    });
    return browser;
  }

  send(method, params = {}, sessionId = this.session) {
    const id = ++this.next;
    this.process.stdio[3].write(JSON.stringify({ id, method, params, sessionId }) + "\0");
    return new Promise((resolve, reject) => this.waiting.set(id, { resolve, reject }));
  }

  // A fresh tab of that size, in light or dark.
  async open(url, { width = 1280, height = 900, dark = false } = {}) {
    const { targetId } = await this.send("Target.createTarget", { url: "about:blank" }, undefined);
    this.session = (await this.send("Target.attachToTarget", { targetId, flatten: true }, undefined)).sessionId;
    this.events.length = 0;
    await this.send("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile: false });
    await this.send("Emulation.setEmulatedMedia", { features: [{ name: "prefers-color-scheme", value: dark ? "dark" : "light" }] });
    for (const domain of ["Page", "Runtime", "Log", "Network"]) await this.send(`${domain}.enable`);
    await this.send("Page.navigate", { url });
  }

  // Where downloads go.
  async downloads(folder) {
    await this.send("Browser.setDownloadBehavior", { behavior: "allow", downloadPath: folder }, undefined);
  }

  // What a screen reader is told.
  async told() {
    return (await this.send("Accessibility.getFullAXTree")).nodes;
  }

  // The value of an expression; a promise is awaited.
  async value(expression) {
    const { result, exceptionDetails } = await this.send("Runtime.evaluate", { expression, awaitPromise: true, returnByValue: true });
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    return result.value;
  }

  async click(x, y) {
    for (const type of ["mousePressed", "mouseReleased"]) await this.send("Input.dispatchMouseEvent", { type, x, y, button: "left", clickCount: 1 });
  }

  async press(key, modifiers = 0) {
    for (const type of ["keyDown", "keyUp"]) await this.send("Input.dispatchKeyEvent", { type, key, modifiers });
  }

  async picture() {
    return Buffer.from((await this.send("Page.captureScreenshot", { format: "png" })).data, "base64");
  }

  // What went wrong in the page: exceptions, refusals by its policy, requests for anything but itself.
  complaints(page) {
    return this.events.flatMap(({ method, params }) => {
      if (method === "Runtime.exceptionThrown") return [params.exceptionDetails.exception?.description ?? params.exceptionDetails.text];
      if (method === "Log.entryAdded" && params.entry.level === "error") return [params.entry.text];
      const url = method === "Network.requestWillBeSent" ? params.request.url.split("#")[0] : page;
      return url === page || url.startsWith("blob:") || url.startsWith("data:") ? [] : [`asked for ${url}`];
    });
  }

  async close() {
    await this.send("Browser.close", {}, undefined).catch(() => {});
    await this.ended;
    rmSync(this.profile, { recursive: true, force: true });
  }
}
