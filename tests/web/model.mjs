// The module in node. `frames` draws scenes and prints the digest of each target and the trace of a pixel in the middle of the first; `findings` reads scenes and prints what is wrong with them.
// On standard input: one line a scene, its path; on standard output: one JSON line each.
import { readFileSync } from "node:fs";
import { dirname, basename, join } from "node:path";
import { createInterface } from "node:readline";
import { gunzipSync } from "node:zlib";

const [, , what, wasm] = process.argv;
const module = new WebAssembly.Module(gunzipSync(readFileSync(wasm)));
let model;

function start() {
  const { exports } = new WebAssembly.Instance(module, {});
  const put = (at, bytes) => new Uint8Array(exports.memory.buffer, at, bytes.length).set(bytes);
  return (request, file) => {
    const bytes = Buffer.from(JSON.stringify(request));
    if (file) put(exports.ninebit_file(file.length), file);
    put(exports.ninebit_request(bytes.length), bytes);
    const length = exports.ninebit_call();
    return JSON.parse(Buffer.from(exports.memory.buffer, exports.ninebit_answer(), length).toString());
  };
}

for await (const line of createInterface({ input: process.stdin })) {
  const { path, files } = JSON.parse(line);
  model = start();
  const answer = { path };
  try {
    for (const name of files) model({ do: "file", name }, readFileSync(join(dirname(path), name)));
    const opened = model({ do: "open", text: readFileSync(path, "utf8"), name: basename(path) });
    if (what === "findings") answer.rendered = opened.rendered ?? opened.findings.map((finding) => finding.rendered).join("\n");
    else if (opened.scene) {
      answer.digests = opened.scene.targets.map((_, target) => model({ do: "draw", target, until: null }).digest);
      const [{ width, height }] = opened.scene.targets;
      answer.trace = model({ do: "trace", target: 0, pixel: [width >> 1, height >> 1], until: null });
    }
    else answer.refused = opened.rendered;
  } catch (error) {
    answer.fault = String(error);
  }
  console.log(JSON.stringify(answer));
}
