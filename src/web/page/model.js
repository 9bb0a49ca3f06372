// The model: a WebAssembly module that takes JSON and gives JSON and pictures. A fault of it ends the instance; a new one takes over where that stood.

import { bytesOf } from "./elements.js";

// Compiled while it is inflated.
const compiled = (bytes) =>
  WebAssembly.compileStreaming(new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip")), { headers: { "Content-Type": "application/wasm" } }));

export class Model {
  static async load(base64) {
    const model = new Model();
    model.module = await compiled(bytesOf(base64));
    model.files = new Map();
    model.standing = {};
    model.start();
    return model;
  }

  start() {
    this.exports = new WebAssembly.Instance(this.module, {}).exports;
    for (const [name, bytes] of this.files) this.ask({ do: "file", name }, bytes);
    for (const request of Object.values(this.standing)) this.ask(request);
  }

  file(name, bytes) {
    this.files.set(name, bytes);
    this.ask({ do: "file", name }, bytes);
  }

  put(at, bytes) {
    new Uint8Array(this.exports.memory.buffer, at, bytes.length).set(bytes);
  }

  answer(length) {
    return JSON.parse(new TextDecoder().decode(new Uint8Array(this.exports.memory.buffer, this.exports.ninebit_answer(), length)));
  }

  // The answer to a request; throws what was refused.
  ask(request, file) {
    const bytes = new TextEncoder().encode(JSON.stringify(request));
    let answer;
    try {
      if (file) this.put(this.exports.ninebit_file(file.length), file);
      this.put(this.exports.ninebit_request(bytes.length), bytes);
      answer = this.answer(this.exports.ninebit_call());
    } catch (trap) {
      let fault = String(trap);
      try {
        fault = this.answer(this.exports.ninebit_answer_length()).fault ?? fault;
      } catch {
        // The trap is all that is known.
      }
      this.start();
      throw new Error(`NB0801 internal error: ${fault}; this is a fault of ninebit: please report it with the scene`);
    }
    if (answer.error !== undefined) throw new Error(answer.error);
    if (request.do === "policies" || answer.scene) this.standing[request.do] = request;
    return answer;
  }

  // An answer with its picture, R, G, B, A.
  picture(request) {
    const answer = this.ask(request);
    const view = new Uint8ClampedArray(this.exports.memory.buffer, this.exports.ninebit_picture(), answer.width * answer.height * 4);
    return { ...answer, pixels: new Uint8ClampedArray(view) };
  }
}
