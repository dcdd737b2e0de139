// <ipos-plant src="hoist.toml" signals="hoist.H420 hoist.torque" run>: a plant in a page, with its shafts, values and buttons to
// run, pause and step. `src` and what it names are fetched from beside it, or stand in a child <script type="application/json">
// as an object of texts by name; without `src` its first one is the plant.
import { IposError, load } from "./index.js";

const longest_turn_ms = 100; // a page that was away does not catch up
const increments_a_turn = 4096;
const rounds_shown = 16; // of the spokes of a shaft: more is a blur

let options = {};
let instance;
/** Where ipos.wasm comes from, as the option of load(); before the first element is shown. */
export function configure(given) {
  options = given;
}

const style = `
:host { display: block; border: 1px solid #8886; border-radius: 6px; padding: 8px; font: 14px/1.4 system-ui, sans-serif; }
.bar { display: flex; gap: 8px; align-items: center; }
.bar output { margin-left: auto; font-variant-numeric: tabular-nums; }
button { font: inherit; min-width: 5em; padding: 2px 8px; }
.stations { display: flex; flex-wrap: wrap; gap: 16px; margin-top: 8px; }
section { display: flex; gap: 12px; align-items: center; }
svg { width: 72px; height: 72px; }
dl { display: grid; grid-template-columns: auto auto; gap: 0 12px; margin: 0; }
dt { opacity: .7; } dd { margin: 0; text-align: right; font-variant-numeric: tabular-nums; }
[role=alert] { color: #b00; white-space: pre-wrap; }`;

const shaft = `<svg viewBox="-36 -36 72 72" aria-hidden="true"><circle r="32" fill="none" stroke="currentColor" stroke-width="3"/>
<g><path d="M0 -30V30M-30 0H30" stroke="currentColor" stroke-width="3"/><circle cy="-22" r="5" fill="#d40"/></g></svg>`;

// The plant file and the programs and headers that it names, one after the other.
async function fetchFiles(src) {
  const base = new URL(src, document.baseURI);
  const main = base.pathname.slice(base.pathname.lastIndexOf("/") + 1);
  const files = {};
  const wanted = [[main, true]];
  for (let entry; (entry = wanted.pop()); ) {
    const [name, needed] = entry;
    const answer = await fetch(new URL(name, base));
    if (!answer.ok && needed) throw new IposError(`${name}: ${answer.status} ${answer.statusText}`);
    if (!answer.ok) continue;
    files[name] = await answer.text();
    for (const [, program] of files[name].matchAll(/^\s*program\s*=\s*"([^"]+)"/gm)) if (!(program in files)) wanted.push([program, true]);
    for (const [, header] of files[name].matchAll(/^\s*#\s*include\s*"([^"]+)"/gm)) if (!(header in files)) wanted.push([header, false]);
  }
  return { files, main };
}

export class IposPlantElement extends HTMLElement {
  #view = this.attachShadow({ mode: "open" });
  #shown = [];
  #running = false;
  #before = 0;
  #frame = 0;

  /** The plant of index.js, undefined until the event `ipos-ready`. */
  plant;

  async connectedCallback() {
    // What stands inside of it has been read then.
    if (document.readyState === "loading") await new Promise((done) => document.addEventListener("DOMContentLoaded", done, { once: true }));
    else await undefined; // and a script that defines it has ended
    this.#view.innerHTML = `<style>${style}</style><div class="bar"><button class="run">Run</button><button class="step">Step 10 ms</button>
      <button class="restart">Restart</button><output></output></div><div class="stations">Loading</div>`;
    const on = (name, act) => this.#view.querySelector(name).addEventListener("click", act);
    on(".run", () => (this.#running ? this.pause() : this.run()));
    on(".step", () => this.step());
    on(".restart", () => this.restart());
    await this.restart();
    if (this.hasAttribute("run")) this.run();
    this.dispatchEvent(new CustomEvent("ipos-ready", { bubbles: true }));
  }
  disconnectedCallback() {
    this.pause();
    this.plant?.close();
    this.plant = undefined;
  }

  async restart() {
    try {
      const inside = this.querySelector('script[type="application/json"]');
      const given = inside && JSON.parse(inside.textContent);
      const src = this.getAttribute("src") ?? (given ? Object.keys(given)[0] : "");
      const { files, main } = given ? { files: given, main: src } : await fetchFiles(src);
      const ipos = await (instance ??= load(options));
      this.plant?.close();
      this.plant = ipos.open(files, main);
      this.#build();
    } catch (trouble) {
      this.pause();
      this.#tell(trouble);
    }
  }
  run() {
    if (!this.plant || this.#running) return;
    this.#running = true;
    this.#view.querySelector(".run").textContent = "Pause";
    this.#before = performance.now();
    const turn = (now) => {
      if (!this.#running) return;
      this.#pass(Math.min(longest_turn_ms, Math.max(0, now - this.#before)));
      this.#before = now;
      this.#frame = requestAnimationFrame(turn);
    };
    this.#frame = requestAnimationFrame(turn);
  }
  pause() {
    this.#running = false;
    cancelAnimationFrame(this.#frame);
    this.#view.querySelector(".run").textContent = "Run";
  }
  step(ms = 10) {
    this.pause();
    if (this.plant) this.#pass(ms);
  }

  #pass(ms) {
    try {
      this.plant.run(ms);
      this.#show();
    } catch (trouble) {
      this.pause();
      this.#tell(trouble);
    }
  }
  #tell(trouble) {
    const alert = document.createElement("p");
    alert.setAttribute("role", "alert");
    alert.textContent = trouble.message;
    this.#view.querySelector(".stations").replaceChildren(alert);
  }

  // A shaft, the state, and the chosen signals of each station with a drive.
  #build() {
    const extra = (this.getAttribute("signals") ?? "").split(/\s+/).filter(Boolean);
    const place = this.#view.querySelector(".stations");
    place.replaceChildren();
    this.#shown = [];
    for (const { name, unit, title } of this.plant.stations) {
      if (unit === "gateway") continue;
      const section = document.createElement("section");
      section.innerHTML = `${shaft}<dl></dl>`;
      section.setAttribute("aria-label", `${name}, ${title}`);
      const list = section.querySelector("dl");
      const row = (label, read) => {
        const [term, value] = [document.createElement("dt"), document.createElement("dd")];
        term.textContent = label;
        list.append(term, value);
        this.#shown.push(() => (value.textContent = read()));
      };
      row(name, () => this.plant.why(name));
      for (const signal of [`${name}.speed`, `${name}.position`, ...extra.filter((one) => one.startsWith(`${name}.`))])
        row(signal.slice(name.length + 1), () => this.plant.text(signal));
      const spokes = section.querySelector("g");
      this.#shown.push(() => {
        const turns = (this.plant.read(`${name}.position`) / increments_a_turn) % rounds_shown;
        spokes.setAttribute("transform", `rotate(${(turns * 360).toFixed(1)})`);
      });
      place.append(section);
    }
    this.#show();
  }
  #show() {
    this.#view.querySelector("output").textContent = `${(this.plant.time / 1000).toFixed(2)} s`;
    for (const show of this.#shown) show();
  }
}

customElements.define("ipos-plant", IposPlantElement);
