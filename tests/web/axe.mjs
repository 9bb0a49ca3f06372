// Violations of WCAG 2, levels A and AA, that axe-core finds in pages, in light and dark. Arguments: the script of axe-core, and pages.
import { readFileSync } from "node:fs";
import { strict as assert } from "node:assert";
import { pathToFileURL } from "node:url";
import { Browser } from "./browser.mjs";

const [, , script, ...pages] = process.argv;
const axe = readFileSync(script, "utf8");
const browser = await Browser.start();
const LEVELS = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa"];
let passed = 0;

async function check(where) {
  const { violations, passes } = await browser.value(`axe.run(document, { runOnly: ${JSON.stringify(LEVELS)} }).then(({ violations, passes }) => ({ passes: passes.length, violations: violations.map(({ id, help, nodes }) => \`\${id}: \${help}: \${nodes.map((node) => node.html.slice(0, 160)).join(" ")}\`) }))`);
  passed += passes;
  assert.deepEqual({ where, violations }, { where, violations: [] });
}

// Everything that a page of the inspector can show.
const inspector = {
  ...Object.fromEntries(["chain", "rules", "change", "program", "text"].map((tab) => [tab, `document.getElementById("tab-${tab}").click()`])),
  units: `(document.getElementById("tab-chain").click(), document.querySelectorAll("#chain details").forEach((each) => (each.open = true)), inspector.chain.fill())`,
  value: `document.querySelector("#chain .wire").click()`,
  help: `document.getElementById("guide").showModal()`,
  rule: `(document.getElementById("guide").close(), inspector.rule("CMB-3"))`,
};

try {
  for (const page of pages) {
    for (const dark of [false, true]) {
      await browser.open(pathToFileURL(page).href, { width: 1280, height: 900, dark });
      await browser.until('document.readyState === "complete"');
      await browser.send("Runtime.evaluate", { expression: axe });
      const where = `${page} in ${dark ? "dark" : "light"}`;
      if (!(await browser.value('document.getElementById("tab-chain") !== null'))) {
        await check(where);
        continue;
      }
      await browser.until("window.inspector?.times.marks !== undefined");
      for (const [name, act] of Object.entries(inspector)) {
        await browser.value(act);
        await check(`${where}: ${name}`);
      }
    }
  }
  // It finds what it is for.
  await browser.value('document.body.append(document.createElement("img"))');
  await assert.rejects(check("planted"), /image-alt/);
  console.log(`${pages.length} pages, ${passed} rules of axe-core met`);
} finally {
  await browser.close();
}
