// The program of a draw: as text beside its values, as register words, and pasted from elsewhere.
import { $, choice, colorField, el } from "./elements.js";
import { Listing, variablesOf } from "./listing.js";

const LANGUAGES = { RegisterWords: "register words", CombinerText: "combiner language", CombinerCalls: "calls of OpenGL", scene: "as a scene writes it" };
const FORMS = { combiners: "combiner language", glsl: "GLSL", c99: "C" };

export class Program {
  constructor(page) {
    this.page = page;
    this.form = "combiners";
  }

  show() {
    const { page } = this;
    const draws = page.scene.draws;
    this.draw = Math.min(this.draw ?? draws.length - 1, draws.length - 1);
    if (draws.length === 0) return $("program").replaceChildren(el("p", {}, "The scene draws nothing."));
    const { draw } = this;
    const program = page.program(draw);
    const constants = [0, 1].map((n) => el("div", { className: "field" }, el("span", { className: "label" }, `constant ${n}`),
      colorField(program.final.constants[n], `constant ${n}`, (color, dragging) => page.edit(draw, ["constants", n], color, dragging))));
    const area = el("textarea", { rows: 8, "aria-label": "Program to paste", placeholder: "rc_in_rgb0 = 0x..., or !!RC1.0 ..., or glCombinerInputNV(...)" });
    let language = "RegisterWords";
    const paste = () => { const answer = this.pasted(area.value, language); if (answer) page.commit(answer.text); };
    const words = program.words.map((word) => el("tr", {}, el("td", {}, word.method), el("td", {}, word.name), el("td", {}, word.value), el("td", {}, word.meaning)));
    const origin = program.origin.length ? [el("p", { className: "quiet" }, "The program was written for an API. A change of its combiners writes it anew in the combiner language; Scene text has it as it was written.")] : [];
    $("program").replaceChildren(
      el("div", { className: "bar" }, el("label", {}, "Draw ", choice(draws.map((each) => `${each.number} ${each.name}`), `${draw} ${draws[draw].name}`, "Draw", (value) => { this.draw = parseInt(value, 10); this.show(); })),
        el("label", {}, "as ", el("select", { "aria-label": "Language of the program", onchange: (event) => { this.form = event.target.value; this.show(); } }, Object.entries(FORMS).map(([value, name]) => el("option", { value, selected: value === this.form }, name))))),
      ...origin, el("p", { className: "quiet" }, `Beside each line stands what it yields at pixel ${page.at.join(", ")}. ${this.form === "combiners" ? "The picture follows while you type." : "The function computes the fragment in integers alone; each line names its rules and its range."}`),
      this.form === "combiners" ? this.listing(program.text) : this.lowered(), ...constants,
      el("h2", {}, "As register words"), el("div", { className: "steps", tabindex: 0, role: "region", "aria-label": "register words" }, el("table", {}, el("thead", {}, el("tr", {}, ["method", "register", "value", "meaning"].map((title) => el("th", { scope: "col" }, title)))), el("tbody", {}, words))),
      el("h2", {}, "Paste a program"), area,
      el("div", { className: "bar" }, el("select", { "aria-label": "Language", onchange: (event) => (language = event.target.value) }, Object.entries(LANGUAGES).map(([value, name]) => el("option", { value }, name))), el("button", { onclick: paste }, "Use it")));
  }

  // The scene's text with a program in place of the draw's.
  pasted(program, language = "CombinerText") {
    return this.page.tried(() => this.page.model.ask({ do: "paste", draw: this.draw, language, program }));
  }

  // The last fragment of the draw at the pixel.
  fragment() {
    const { target, until, at: pixel } = this.page;
    return this.page.tried(() => this.page.model.ask({ do: "trace", target, until, pixel }).trace.draws.findLast((each) => each.draw === this.draw));
  }

  // The draw as a function of another language.
  lowered() {
    const { page } = this;
    const text = page.tried(() => page.model.ask({ do: "lower", draw: this.draw, language: this.form }).text) ?? "";
    return new Listing({ text, label: `The program in ${FORMS[this.form]}`, fragment: this.fragment(), changed: () => {}, reveal: (block) => this.reveal(block), assignments: variablesOf }).element;
  }

  reveal(block) {
    this.page.tab("chain");
    this.page.chain.reveal(block);
  }

  // A program as text, with the values of the pixel.
  listing(text) {
    const { page } = this;
    const changed = (program, then) => {
      page.follow(() => {
        // A text that could not be read stands in the model: the page's own is the one that is changed.
        page.open(page.text);
        return this.pasted(program)?.text ?? null;
      }, (whole) => {
        // The program stands on lines of its own in the scene's text.
        const first = whole.slice(0, Math.max(0, whole.indexOf(program))).split("\n").length;
        const findings = page.findings.filter(({ severity }) => severity === "error").map(({ line, message }) => ({ line: line - first, message }));
        then(findings.length ? null : this.fragment(), findings);
      });
    };
    const commit = (program) => {
      cancelAnimationFrame(page.pending);
      page.open(page.text);
      const answer = this.pasted(program);
      if (answer) page.commit(answer.text);
    };
    return new Listing({ text, label: "The program in the combiner language", fragment: this.fragment(), changed, commit, reveal: (block) => this.reveal(block) }).element;
  }
}
