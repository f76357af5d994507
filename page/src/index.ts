/** The live page: anywidget's `render` for notebooks, `connect` for the served page. */

import { App } from "./app";
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

const main = document.querySelector<HTMLElement>("#equipoise-live[data-live]");
if (main?.dataset.live && !main.childElementCount) {
  render({ model: connect(main, main.dataset.live), el: main });
}

export default { render };
