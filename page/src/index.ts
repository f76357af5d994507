/** The live page: anywidget's `render` for notebooks, `connect` for the served page. */

import { App } from "./app";
import { Played } from "./played";
import type { Wire } from "./protocol";
import { OfflineFiles, WorkerWire } from "./site/wire";
import { Socket } from "./socket";
import { shelf } from "./story";
import { agree, keep, language, say, wished } from "./words";

/** Show the machine of a model (anywidget's, or a connection) in an element; returns a clean-up. */
async function render({ model, el }: { model: Wire; el: HTMLElement }): Promise<() => void> {
  let app: App;
  const show = async (languages: string[]): Promise<void> => {
    await agree(model, languages);
    app = new App(model, el, null, (code) => {
      keep(code);
      app.close();
      void show([code]);
    });
  };
  await show(wished());
  return () => app.close();
}

/** A connection to `equipoise serve`, and the element as the whole page. */
export function connect(el: HTMLElement, address: string): Socket {
  el.classList.add("equipoise-page");
  const url = new URL(address, location.href);
  url.protocol = url.protocol.replace(/^http/, "ws");
  return new Socket(url.href);
}

/** The whole page; for another language it is loaded again, and repeats the steps that were made. */
async function begin(el: HTMLElement, wire: Wire): Promise<void> {
  await agree(wire, wished());
  document.documentElement.lang = language();
  new App(wire, el, shelf(), (code) => {
    keep(code);
    location.reload();
  });
}

/** A page of a site: it computes in a worker, of which `status` says how far it has come. */
async function compute(el: HTMLElement, { worker, service }: DOMStringMap): Promise<void> {
  const status = document.getElementById("equipoise-status") ?? document.createElement("p");
  el.classList.add("equipoise-page");
  let started = false;
  const offline = new OfflineFiles();
  const wire = new WorkerWire(worker ?? "", (sign) => {
    if (sign.type === "loaded") return offline.keep(sign.files);
    const { type, what } = sign;
    status.hidden = started && what === null;
    if (type === "failed") {
      status.hidden = false;
      status.textContent = `Python could not be started in this browser: ${what}`;
    } else if (started && what) status.textContent = say("loading {name}, once", { name: what });
  });
  await begin(el, wire);
  started = true;
  status.hidden = true;
  if (service) await offline.begin(service, worker ?? "");
}

/** A file that plays without a server. */
async function play(el: HTMLElement, text: string): Promise<void> {
  const wire = new Played(text);
  el.classList.add("equipoise-page", "equipoise-played");
  await agree(wire, []);
  new App(wire, el, null, () => undefined);
}

const main = document.querySelector<HTMLElement>("#equipoise-live");
if (main?.dataset.live && !main.childElementCount) void begin(main, connect(main, main.dataset.live));
if (main?.dataset.worker) void compute(main, main.dataset);
const recorded = main?.dataset.played && document.getElementById(main.dataset.played);
if (main && recorded) void play(main, recorded.textContent ?? "");

export default { render };
