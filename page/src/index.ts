/** The live page: anywidget's `render` for notebooks, `connect` for the served page. */

import { App } from "./app";
import type { Memory } from "./conversation";
import type { Wire } from "./protocol";
import { Socket } from "./socket";

/** Show the machine of a model (anywidget's, or a connection) in an element; returns a clean-up. */
function render({ model, el }: { model: Wire; el: HTMLElement }): () => void {
  const app = new App(model, el);
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

const main = document.querySelector<HTMLElement>("#equipoise-live[data-live]");
if (main?.dataset.live && !main.childElementCount) {
  const { live } = main.dataset;
  new App(connect(main, live), main, memory(live));
}

export default { render };
