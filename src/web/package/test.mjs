// Tests the package in node and, where there is one, in Chromium, which CHROMIUM names: node test.mjs FOLDER SCENES, with the folder of an unpacked package
// and that of scenes.
import { spawnSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { createServer } from "node:http";
import { join, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { Chromium } from "../../../tests/web/chromium.mjs";
import { check } from "./checks.mjs";

const [, , folder, scenes] = process.argv;
const path = join(scenes, "dot3", "lit-stone.ron");
const text = readFileSync(path, "utf8");
const picture = readFileSync(join(scenes, "dot3", "rocks-normal.png"));
const expected = /sha256: "(\w+)"/.exec(readFileSync(path.replace(".ron", ".expect.ron"), "utf8"))[1];

const { load, SceneError } = await import(pathToFileURL(join(resolve(folder), "index.js")));
check(await load(), SceneError, { text, files: { "rocks-normal.png": picture }, expected });
console.log("the package in node: all is well");

const chromium = process.env.CHROMIUM || "chromium";
if (spawnSync(chromium, ["--version"]).status === 0) {
  // A browser loads modules from a server alone.
  const here = fileURLToPath(new URL(".", import.meta.url));
  const kinds = { js: "text/javascript", mjs: "text/javascript", html: "text/html" };
  const files = { "/": () => "<!doctype html><title>ninebit</title>", "/checks.mjs": () => readFileSync(join(here, "checks.mjs")) };
  const server = createServer((request, response) => {
    try {
      const body = files[request.url]?.() ?? readFileSync(join(folder, request.url.replace(/^\/package/, "").replaceAll("..", "")));
      response.setHeader("content-type", kinds[request.url === "/" ? "html" : request.url.split(".").pop()] ?? "application/octet-stream");
      response.end(body);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise((listening) => server.listen(0, "127.0.0.1", listening));
  const browser = await Chromium.start(chromium);
  try {
    await browser.open(`http://127.0.0.1:${server.address().port}/`);
    await browser.until("document.title === 'ninebit'");
    const given = JSON.stringify({ text, expected, bytes: picture.toString("base64") });
    await browser.value(`(async () => {
      const { text, expected, bytes } = ${given};
      const [{ load, SceneError }, { check }] = await Promise.all([import("/package/index.js"), import("/checks.mjs")]);
      const picture = Uint8Array.from(atob(bytes), (letter) => letter.charCodeAt(0));
      check(await load(), SceneError, { text, files: { "rocks-normal.png": picture }, expected });
    })()`);
    console.log("the package in Chromium: all is well");
  } finally {
    await browser.close();
    server.close();
  }
} else {
  console.log(`the package in Chromium: not tried, there is no ${chromium}`);
}
