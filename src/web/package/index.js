// The model for scripts: scenes, frames, traces and planes, in a browser or in node.

import { Model } from "./model.js";

async function bytesOf(url) {
  if (url.protocol !== "file:") {
    const response = await fetch(url);
    if (!response.ok) throw new Error(`${url}: ${response.status}`);
    return new Uint8Array(await response.arrayBuffer());
  }
  const { readFile } = await import("node:fs/promises");
  return new Uint8Array(await readFile(url));
}

export class SceneError extends Error {
  constructor({ findings, rendered }) {
    super(rendered);
    this.name = "SceneError";
    this.findings = findings;
    this.code = findings[0]?.code;
  }
}

export async function load(source = new URL("./ninebit.wasm.gz", import.meta.url)) {
  const bytes = source instanceof Uint8Array ? source : await bytesOf(new URL(source));
  return new Ninebit(await Model.load(bytes));
}

export class Ninebit {
  constructor(model) {
    this.model = model;
    this.current = null;
  }

  check(text, { files = {}, name = "scene.ron" } = {}) {
    for (const [file, bytes] of Object.entries(files)) this.model.file(file, bytes);
    const { scene = null, findings, rendered = findings.map((finding) => finding.rendered).join("\n") } = this.model.ask({ do: "open", text, name });
    this.current = null;
    return { scene, findings, rendered };
  }

  open(text, options = {}) {
    return new Scene(this, text, options);
  }

  render(text, options = {}) {
    return this.open(text, options).render(options);
  }

  trace(text, x, y, options = {}) {
    return this.open(text, options).trace(x, y, options);
  }

  planes(text, names, options = {}) {
    return this.open(text, options).planes(names, options);
  }
}

export class Scene {
  constructor(ninebit, text, options) {
    Object.assign(this, { ninebit, text, options });
    const answer = ninebit.check(text, options);
    if (!answer.scene) throw new SceneError(answer);
    ninebit.current = this;
    this.findings = answer.findings;
    Object.assign(this, { targets: answer.scene.targets, draws: answer.scene.draws });
  }

  // One scene stands in the model at a time.
  stand(policies = {}) {
    if (this.ninebit.current !== this) {
      this.ninebit.check(this.text, this.options);
      this.ninebit.current = this;
    }
    this.ninebit.model.ask({ do: "policies", values: policies });
    return this.ninebit.model;
  }

  target(name) {
    const at = name === undefined ? 0 : this.targets.findIndex((target) => target.name === name);
    if (at < 0) throw new Error(`the scene has no target \`${name}\`; it has ${this.targets.map((target) => target.name).join(", ")}`);
    return at;
  }

  render({ target, policies } = {}) {
    const { width, height, digest, pixels } = this.stand(policies).picture({ do: "draw", target: this.target(target), until: null });
    return { width, height, digest, pixels };
  }

  trace(x, y, { target, policies } = {}) {
    return this.stand(policies).ask({ do: "trace", target: this.target(target), pixel: [x, y], until: null }).trace;
  }

  planeNames({ target, policies } = {}) {
    return this.stand(policies).ask({ do: "plane_names", target: this.target(target), until: null }).names;
  }

  planes(names, { target, policies, rectangle = null } = {}) {
    const model = this.stand(policies);
    const { width, height, planes } = model.ask({ do: "planes", target: this.target(target), names, rectangle, until: null });
    const size = width * height;
    const words = new Uint32Array(planes.length * size);
    new Uint8Array(words.buffer).set(new Uint8Array(model.exports.memory.buffer, model.exports.ninebit_picture(), words.byteLength));
    const arrays = planes.map(({ name, step, kind, per_one: perOne }, n) => {
      const values = words.subarray(n * size, (n + 1) * size);
      return { name, step, perOne, values: kind === "int32" ? new Int32Array(values.buffer, values.byteOffset, size) : values };
    });
    return { width, height, planes: arrays };
  }
}
