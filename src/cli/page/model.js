// The model: a WebAssembly module that takes JSON and gives JSON and pictures. A fault of it ends the instance; a new one takes over where that stood.

// Compiled while it is inflated.
const compiled = (bytes) =>
  WebAssembly.compileStreaming(new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip")), { headers: { "Content-Type": "application/wasm" } }));

export class Model {
  // From the module's bytes as gzip left them.
  static async load(bytes) {
    return new Model({ module: await compiled(bytes), files: new Map(), standing: {} });
  }

  // What another model needs to stand where this one does can be sent to another thread.
  constructor({ module, files, standing }) {
    Object.assign(this, { module, files, standing });
    this.start();
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
  picture(request, file) {
    const answer = this.ask(request, file);
    const view = new Uint8ClampedArray(this.exports.memory.buffer, this.exports.ninebit_picture(), answer.width * answer.height * 4);
    return { ...answer, pixels: new Uint8ClampedArray(view) };
  }
}

// Requests that take long, one at a time, in a thread of their own: the page goes on meanwhile, and what is no longer wanted is dropped.
export class Background {
  // The text of the page's script: a page that was opened from a file has no other to give a thread.
  constructor(script) {
    this.script = script;
  }

  picture(model, request) {
    this.drop();
    const { module, files, standing } = model;
    return new Promise((resolve, reject) => {
      const url = URL.createObjectURL(new Blob([this.script], { type: "text/javascript" }));
      const worker = new Worker(url);
      this.end = () => {
        worker.terminate();
        URL.revokeObjectURL(url);
        this.end = null;
      };
      worker.onmessage = ({ data: { answer, refused } }) => {
        this.drop();
        if (answer) resolve(answer);
        else reject(new Error(refused));
      };
      worker.onerror = (event) => {
        this.drop();
        reject(new Error(event.message || "this browser gives a page that was opened from a file no second thread"));
      };
      worker.postMessage({ module, files, standing, request });
    });
  }

  drop() {
    this.end?.();
  }
}

// The thread's side.
export function serve() {
  self.onmessage = ({ data: { request, ...state } }) => {
    try {
      const answer = new Model(state).picture(request);
      self.postMessage({ answer }, [answer.pixels.buffer]);
    } catch (error) {
      self.postMessage({ refused: error.message });
    }
  };
}
