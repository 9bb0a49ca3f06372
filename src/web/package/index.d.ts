/** An error or a warning about a scene, with its place. */
export interface Finding {
  code: string;
  severity: "error" | "warning";
  message: string;
  file: string;
  /** From 1; null if no text is to blame. */
  line: number | null;
  column: number | null;
  label: string;
  rule: string | null;
  notes: string[];
  help: string | null;
  /** The finding with an excerpt of the text. */
  rendered: string;
}

export interface Target {
  name: string;
  width: number;
  height: number;
  format: string;
  depth: string | null;
}

/** A scene was refused; the message shows every finding. */
export class SceneError extends Error {
  findings: Finding[];
  code: string | undefined;
}

export interface SceneOptions {
  /** Files that the scene names. */
  files?: Record<string, Uint8Array>;
  /** Name of the scene in messages. */
  name?: string;
}

export interface DrawOptions {
  /** Name of a render target; the first if it is left out. */
  target?: string;
  /** Alternatives of rules, `{ "CMB-3": "literal" }`. */
  policies?: Record<string, string>;
}

export interface Picture {
  width: number;
  height: number;
  /** SHA-256 of the stored words, as `ninebit replay` expects it. */
  digest: string;
  /** R, G, B, A, row by row from the top: what `new ImageData(pixels, width)` takes. */
  pixels: Uint8ClampedArray;
}

/** The trace of a pixel, as docs/trace-format.md describes it. */
export interface Trace {
  pixel: [number, number];
  word: number;
  shown: [number, number, number, number];
  draws: { draw: number; name: string; triangle: number; stored: boolean; steps: Step[] }[];
  [field: string]: unknown;
}

export interface Step {
  name: string;
  block: string;
  rule: string;
  operation: string;
  inputs: { name: string; value: number; per_one: number }[];
  value: number;
  per_one: number;
  real: number | null;
  ideal: number | null;
  note: string | null;
}

export interface Plane {
  /** The name that was asked for. */
  name: string;
  /** The step: the name, or one of the channels that it stands for. */
  step: string;
  /** The integer that stands for 1.0. */
  perOne: number | null;
  /** One number for each pixel, row by row from the top; 0 where a pixel has none. */
  values: Int32Array | Uint32Array;
}

export interface Planes {
  width: number;
  height: number;
  planes: Plane[];
}

/** Loads the model: from the package's own module, from an address, or from the bytes of `ninebit.wasm.gz`. */
export function load(source?: URL | string | Uint8Array): Promise<Ninebit>;

export class Ninebit {
  /** Reads a scene. `scene` is null if it has errors. */
  check(text: string, options?: SceneOptions): { scene: object | null; findings: Finding[]; rendered: string };
  /** Reads a scene. Throws a SceneError if it has errors. */
  open(text: string, options?: SceneOptions): Scene;
  render(text: string, options?: SceneOptions & DrawOptions): Picture;
  trace(text: string, x: number, y: number, options?: SceneOptions & DrawOptions): Trace;
  planes(text: string, names: string[], options?: SceneOptions & DrawOptions & PlaneOptions): Planes;
}

export interface PlaneOptions {
  /** First column and row, columns and rows. */
  rectangle?: [number, number, number, number] | null;
}

export class Scene {
  readonly targets: Target[];
  readonly draws: { number: number; name: string; target: number; stages: number }[];
  /** Warnings. */
  readonly findings: Finding[];
  render(options?: DrawOptions): Picture;
  /** How the pixel in column x and row y came to be. */
  trace(x: number, y: number, options?: DrawOptions): Trace;
  /** Names of values that some pixels have, each with its block of the chip. */
  planeNames(options?: DrawOptions): Record<string, string>;
  /** Values that traces name, of all pixels of the target or of a rectangle. A name may stand for its channels, `texture0.rgb`. */
  planes(names: string[], options?: DrawOptions & PlaneOptions): Planes;
}
