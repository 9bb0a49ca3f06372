// Drives Firefox by its Marionette protocol: no package.
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { connect, createServer } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { Browser } from "./browser.mjs";

const pause = (time) => new Promise((resolve) => setTimeout(resolve, time));

const freePort = () =>
  new Promise((resolve) => {
    const server = createServer().listen(0, "127.0.0.1", () => {
      const { port } = server.address();
      server.close(() => resolve(port));
    });
  });

const PREFERENCES = {
  "browser.shell.checkDefaultBrowser": false,
  "datareporting.policy.dataSubmissionEnabled": false,
  "browser.download.folderList": 2,
  "browser.download.useDownloadDir": true,
  "browser.download.always_ask_before_handling_new_types": false,
};

// Keys as WebDriver names them.
const KEYS = { ArrowLeft: "\uE012", ArrowUp: "\uE013", ArrowRight: "\uE014", ArrowDown: "\uE015" };

export class Firefox extends Browser {
  static async start(program = process.env.FIREFOX ?? "firefox") {
    const browser = new Firefox();
    const port = await freePort();
    browser.profile = mkdtempSync(join(tmpdir(), "ninebit-firefox-"));
    const preferences = Object.entries({ ...PREFERENCES, "marionette.port": port });
    writeFileSync(join(browser.profile, "user.js"), preferences.map(([name, value]) => `user_pref(${JSON.stringify(name)}, ${JSON.stringify(value)});\n`).join(""));
    browser.process = spawn(program, ["--headless", "--marionette", "--remote-allow-system-access", "--no-remote", "--profile", browser.profile], { stdio: "ignore" });
    browser.ended = new Promise((resolve) => browser.process.on("exit", resolve));
    for (let tries = 0; !browser.socket; tries++) {
      if (tries > 600) throw new Error("Firefox does not answer");
      await pause(100);
      browser.socket = await new Promise((resolve) => {
        const attempt = connect(port, "127.0.0.1", () => resolve(attempt)).on("error", () => resolve(null));
      });
    }
    browser.listen();
    await browser.send("WebDriver:NewSession", { capabilities: {} });
    return browser;
  }

  listen() {
    this.waiting = new Map();
    this.next = 0;
    let bytes = Buffer.alloc(0);
    this.socket.on("data", (part) => {
      bytes = Buffer.concat([bytes, part]);
      for (;;) {
        const colon = bytes.indexOf(":");
        const length = colon < 0 ? NaN : Number(bytes.subarray(0, colon).toString());
        if (!(bytes.length >= colon + 1 + length)) return;
        const message = JSON.parse(bytes.subarray(colon + 1, colon + 1 + length).toString());
        bytes = bytes.subarray(colon + 1 + length);
        // The first is a greeting.
        if (Array.isArray(message)) this.waiting.get(message[1])?.(message);
      }
    });
  }

  async send(command, parameters = {}) {
    const id = ++this.next;
    const text = JSON.stringify([0, id, command, parameters]);
    const answer = new Promise((resolve) => this.waiting.set(id, resolve));
    this.socket.write(`${Buffer.byteLength(text)}:${text}`);
    const [, , error, result] = await answer;
    this.waiting.delete(id);
    if (error) throw new Error(error.message);
    return result?.value ?? result;
  }

  // Runs a script in the browser itself instead of in the page.
  async inside(script, ...args) {
    await this.send("Marionette:SetContext", { value: "chrome" });
    try {
      return await this.send("WebDriver:ExecuteScript", { script, args });
    } finally {
      await this.send("Marionette:SetContext", { value: "content" });
    }
  }

  // A fresh page in a window of that size, in light or dark. A window is never narrower than Firefox allows.
  async open(url, { width = 1280, height = 900, dark = false } = {}) {
    await this.send("WebDriver:Navigate", { url: "about:blank" });
    await this.inside(`Services.prefs.setIntPref("layout.css.prefers-color-scheme.content-override", arguments[0]); Services.console.reset();`, dark ? 0 : 1);
    await this.send("WebDriver:SetWindowRect", { width, height });
    const [inner, high] = await this.value("[innerWidth, innerHeight]");
    await this.send("WebDriver:SetWindowRect", { width: 2 * width - inner, height: 2 * height - high });
    await this.send("WebDriver:Navigate", { url });
  }

  async downloads(folder) {
    await this.inside(`Services.prefs.setStringPref("browser.download.dir", arguments[0]);`, folder);
  }

  // Firefox tells a script nothing of it.
  async told() {
    return null;
  }

  async value(expression) {
    const script = `const done = arguments[arguments.length - 1]; (async () => (${expression}))().then((value) => done(JSON.stringify(value === undefined ? [] : [value])), (error) => done(String(error)));`;
    const answer = await this.send("WebDriver:ExecuteAsyncScript", { script, args: [], sandbox: null, newSandbox: false, scriptTimeout: 120_000 });
    if (!answer?.startsWith("[")) throw new Error(`${answer}: ${expression}`);
    return JSON.parse(answer)[0];
  }

  async click(x, y) {
    const [px, py] = [x, y].map(Math.round);
    const actions = [{ type: "pointerMove", x: px, y: py }, { type: "pointerDown", button: 0 }, { type: "pointerUp", button: 0 }];
    await this.send("WebDriver:PerformActions", { actions: [{ type: "pointer", id: "mouse", parameters: { pointerType: "mouse" }, actions }] });
  }

  async press(key) {
    const value = KEYS[key] ?? key;
    await this.send("WebDriver:PerformActions", { actions: [{ type: "key", id: "keys", actions: ["keyDown", "keyUp"].map((type) => ({ type, value })) }] });
  }

  async picture() {
    return Buffer.from(await this.send("WebDriver:TakeScreenshot", { full: false }), "base64");
  }

  // What went wrong in the page: exceptions, refusals by its policy.
  async complaints() {
    return this.inside(`return Services.console.getMessageArray().filter((each) => each instanceof Ci.nsIScriptError && !(each.flags & 1) && /javascript|CSP|Content Security/i.test(each.category) && !/chrome:|resource:/.test(each.sourceName)).map((each) => each.errorMessage);`);
  }

  async close() {
    await this.send("Marionette:Quit", { flags: ["eForceQuit"] }).catch(() => {});
    this.socket.destroy();
    await this.ended;
    rmSync(this.profile, { recursive: true, force: true });
  }
}
