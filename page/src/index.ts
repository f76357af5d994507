/** The live page: anywidget's `render` for notebooks, `connect` for the served page. */

import { App } from "./app";
import type { Memory } from "./conversation";
import type { Wire } from "./protocol";
import { Socket } from "./socket";
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

/** What is done in a tab is kept while the server runs that its address belongs to. */
function memory(address: string): Memory {
  const key = `equipoise ${address}`;
  return {
    read: () => sessionStorage.getItem(key),
    write: (text) => {
      try {
        sessionStorage.setItem(key, text);
      } catch {
        sessionStorage.removeItem(key); // more than the browser keeps
      }
    },
  };
}

/** The served page; in another language it is loaded again, and tells anew what was done. */
async function begin(el: HTMLElement, address: string): Promise<void> {
  const wire = connect(el, address);
  await agree(wire, wished());
  document.documentElement.lang = language();
  new App(wire, el, memory(address), (code) => {
    keep(code);
    location.reload();
  });
}

const main = document.querySelector<HTMLElement>("#equipoise-live[data-live]");
if (main?.dataset.live && !main.childElementCount) void begin(main, main.dataset.live);

export default { render };
