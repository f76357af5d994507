/** The live page: anywidget's `render` for notebooks, `connect` for the served page. */

import { App } from "./app";
import { Played } from "./played";
import type { Wire } from "./protocol";
import { Socket } from "./socket";
import { shelf } from "./story";
import { agree, keep, language, wished } from "./words";

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

/** The served page; in another language it is loaded again, and tells anew what was done. */
async function begin(el: HTMLElement, address: string): Promise<void> {
  const wire = connect(el, address);
  await agree(wire, wished());
  document.documentElement.lang = language();
  new App(wire, el, shelf(), (code) => {
    keep(code);
    location.reload();
  });
}

/** A file that plays without a server. */
async function play(el: HTMLElement, text: string): Promise<void> {
  const wire = new Played(text);
  el.classList.add("equipoise-page", "equipoise-played");
  await agree(wire, []);
  new App(wire, el, null, () => undefined);
}

const main = document.querySelector<HTMLElement>("#equipoise-live");
if (main?.dataset.live && !main.childElementCount) void begin(main, main.dataset.live);
const recorded = main?.dataset.played && document.getElementById(main.dataset.played);
if (main && recorded) void play(main, recorded.textContent ?? "");

export default { render };
