// The readings of rules that nothing decides: a table of what each makes of the pixel and of the picture, and marks in the pixel's strip.
import { $, el, swatch } from "./elements.js";
import { cellsOf, told } from "./strip.js";
import { sheetOf } from "./view.js";

// Milliseconds that somebody who walks over the picture stays at a pixel.
const CALM = 80;

export class Readings {
  constructor(page) {
    this.page = page;
  }

  // Every value of a rule that does not hold now.
  others() {
    const { alternatives, policies } = this.page;
    return alternatives.flatMap(({ rule, values }) => values.filter(({ value }) => value !== (policies[rule] ?? values[0].value)).map(({ value, meaning }) => ({ name: `${rule}=${value}`, rule, meaning })));
  }

  // Does a little work after the other, until something else is looked at. `work` returns whether there is more.
  meanwhile(work, pause) {
    const turn = this.stop();
    const next = () => {
      if (turn === this.turn && this.page.tried(work)) setTimeout(next, 10);
    };
    setTimeout(next, pause);
  }

  stop() {
    return (this.turn = (this.turn ?? 0) + 1);
  }

  // The table.
  show(rules) {
    const { page } = this;
    const rows = rules.flatMap(({ rule, question, values }) => {
      const chosen = values.find((value) => value.chosen);
      return values.map((value, n) => el("tr", { className: `${value.chosen ? "chosen" : ""} ${value.word !== chosen.word ? "differs" : ""}` },
        el("td", {}, value.value), el("td", {}, n === 0 ? [page.chain.badge(rule), " ", question] : ""), el("td", {}, value.meaning), el("td", {}, swatch(value.shown), el("code", {}, value.shown.join(", "))),
        el("td", {}, el("canvas", { className: "small", width: 0, height: 0, "data-policy": `${rule}=${value.value}`, role: "img", "aria-label": `the picture under ${rule}=${value.value}` })),
        el("td", {}, value.chosen ? "" : el("button", { onclick: () => page.policy(rule, value.value) }, "Choose"))));
    });
    this.meanwhile(() => this.smallPicture(), 50);
    const differing = new Set(rules.filter(({ values }) => values.some((value) => value.word !== values.find((each) => each.chosen).word)).map(({ rule }) => rule));
    $("rules").replaceChildren(el("p", {}, differing.size ? page.data.undecided.some.replace("{}", [...differing].join(", ")) : page.data.undecided.none),
      el("table", {}, el("thead", {}, el("tr", {}, ["value", "rule", "meaning", "pixel", "picture", ""].map((title) => el("th", { scope: "col" }, title)))), el("tbody", {}, rows)));
  }

  // The picture under the next value.
  smallPicture() {
    const { page } = this;
    const canvas = page.shown === "rules" && document.querySelector("#rules canvas.small[width='0']");
    if (!canvas) return false;
    const { width, height, pixels } = page.elsewhere({ policies: page.under(canvas.dataset.policy) });
    const sheet = sheetOf({ width, height, pixels });
    const scale = 64 / Math.max(width, height);
    [canvas.width, canvas.height] = [Math.max(1, Math.round(width * scale)), Math.max(1, Math.round(height * scale))];
    canvas.getContext("2d").drawImage(sheet, 0, 0, canvas.width, canvas.height);
    return true;
  }

  // What the cells of the strip would hold under each other value.
  mark(trace) {
    const { page } = this;
    const fragment = trace.draws.at(-1);
    if (!fragment) return this.stop();
    const { target, until, at: pixel } = page;
    const started = performance.now();
    const own = cellsOf(fragment);
    const left = this.others();
    const found = own.map(() => []);
    this.meanwhile(() => {
      const reading = left.shift();
      if (!reading) {
        page.chain.read(found);
        page.times.marks = performance.now() - started;
        return false;
      }
      const other = page.elsewhere({ policies: page.under(reading.name) }, () => page.model.ask({ do: "trace", target, until, pixel }).trace.draws.at(-1));
      const cells = other ? cellsOf(other) : [];
      own.forEach((cell, n) => {
        const instead = cells.length === own.length ? cells[n] : cells.find(({ block, title }) => block === cell.block && title === cell.title);
        const [here, there] = [told(cell), instead ? told(instead) : "nothing"];
        if (here !== there) found[n].push({ ...reading, block: cell.block, title: cell.title, here, there });
      });
      return true;
    }, CALM);
  }
}
