// Tests the package: node test.mjs FOLDER SCENES, with the folder of an unpacked package and that of scenes.
import { readFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import assert from "node:assert/strict";

const [, , folder, scenes] = process.argv;
const { load, SceneError } = await import(pathToFileURL(join(resolve(folder), "index.js")));
const ninebit = await load();

const path = join(scenes, "dot3", "lit-stone.ron");
const text = readFileSync(path, "utf8");
const files = { "rocks-normal.png": readFileSync(join(scenes, "dot3", "rocks-normal.png")) };
const expected = /sha256: "(\w+)"/.exec(readFileSync(path.replace(".ron", ".expect.ron"), "utf8"))[1];
const scene = ninebit.open(text, { files });
const { width, height, digest, pixels } = scene.render();
assert.deepEqual([width, height, digest, pixels.length], [640, 480, expected, 640 * 480 * 4]);

const trace = scene.trace(200, 300);
const step = (name) => trace.draws.at(-1).steps.findLast((step) => step.name === name).value;
const { planes } = scene.planes(["stage0.rgb.AB.r", "texture0.rgb", "stored.word"]);
const at = 300 * width + 200;
assert.deepEqual(planes.map(({ step }) => step), ["stage0.rgb.AB.r", "texture0.r", "texture0.g", "texture0.b", "stored.word"]);
for (const { step: name, values } of planes) assert.equal(values[at], step(name), name);
assert.equal(planes[4].values[at], trace.word);
const part = scene.planes(["texture0.r"], { rectangle: [200, 300, 3, 2] });
assert.deepEqual([part.width, part.height, part.planes[0].values[0]], [3, 2, step("texture0.r")]);
assert.ok(scene.planeNames()["stage0.rgb.AB.r"].startsWith("general stage 0"));

// Another scene, and the first again.
const other = ninebit.render("(version: 1, profile: Nv2a, targets: [(width: 4, height: 3)], draws: [])");
assert.deepEqual([other.width, other.height], [4, 3]);
assert.equal(scene.render().digest, expected);
assert.notEqual(scene.render({ policies: { "CMB-3": "literal" } }).digest, expected);
assert.equal(scene.render().digest, expected);

assert.equal(ninebit.check("(version: 1, profil: Nv2a)").scene, null);
assert.throws(() => ninebit.open("(version: 1, profil: Nv2a)"), (error) => error instanceof SceneError && error.code === "NB0201" && error.message.includes("did you mean `profile`"));
assert.throws(() => scene.planes(["unit0.wight_u"]), /NB1401.*unit0.weight_u/);
assert.throws(() => scene.render({ target: "none" }), /it has frame/);
console.log("the package for scripts: all is well");
