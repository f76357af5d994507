/** What can be done at a joint, a link or a place: by the right button, a long press, or the menu key. */

import { h, set } from "./dom";
import { say } from "./words";

/** Of a finger that rests: how long, ms, and by how many pixels it may move. */
const [LONG, STILL] = [550, 8];

export interface Action {
  name: string;
  act(): void;
}

/** What stands in a menu, and what it is of; null where there is nothing to do. */
export interface Menu {
  of: string;
  actions: Action[];
}

/** Where a menu is asked for: at a pixel of the window, or at what has the focus. */
export interface Asking {
  target: Element;
  at: [x: number, y: number];
  keys: boolean;
}

export class ContextMenu {
  readonly root = h("div", { class: "context", role: "menu", hidden: true });
  private back: HTMLElement | SVGElement | null = null;

  /** board : on which it is asked for.  around : in which it stands. */
  constructor(
    board: HTMLElement,
    private readonly around: HTMLElement,
    private readonly offered: (asking: Asking) => Menu | null,
  ) {
    board.addEventListener("contextmenu", (event) => {
      const { target, clientX, clientY } = event as MouseEvent;
      if (this.open({ target: target as Element, at: [clientX, clientY], keys: false })) event.preventDefault();
    });
    board.addEventListener("keydown", (event) => this.called(event), true);
    board.addEventListener("pointerdown", (event) => this.rest(event, board), true);
    this.root.addEventListener("keydown", (event) => this.key(event));
    this.root.addEventListener("focusout", ({ relatedTarget }) => {
      if (!this.root.contains(relatedTarget as Node | null)) this.close(false);
    });
    this.root.addEventListener("contextmenu", (event) => event.preventDefault());
  }

  private open(asking: Asking): boolean {
    if (!this.root.hidden) return true; // a finger that rests is told of twice
    const menu = this.offered(asking);
    if (!menu?.actions.length) return false;
    const focused = (this.around.getRootNode() as Document | ShadowRoot).activeElement;
    this.back = focused as HTMLElement | null;
    const items = menu.actions.map(({ name, act }) => {
      const chosen = () => {
        this.close(true);
        act();
      };
      return h("button", { type: "button", role: "menuitem", tabindex: -1, onclick: chosen }, name);
    });
    set(this.root, { "aria-label": menu.of });
    this.root.replaceChildren(h("b", { "aria-hidden": "true" }, menu.of), ...items);
    this.root.hidden = false;
    this.place(asking.at);
    items[0]?.focus({ preventScroll: true });
    return true;
  }

  /** Beside where it was asked for, and whole. */
  private place([x, y]: [number, number]): void {
    const around = this.around.getBoundingClientRect();
    const { offsetWidth: width, offsetHeight: height } = this.root;
    const left = Math.max(4, Math.min(x, innerWidth - width - 4));
    const top = Math.max(4, Math.min(y, innerHeight - height - 4));
    this.root.style.left = `${left - around.left}px`;
    this.root.style.top = `${top - around.top}px`;
  }

  private close(back: boolean): void {
    if (this.root.hidden) return;
    const { back: focused } = this;
    this.back = null;
    this.root.hidden = true;
    if (back && focused?.isConnected) focused.focus({ preventScroll: true });
  }

  private called(event: KeyboardEvent): void {
    if (event.key !== "ContextMenu" && !(event.key === "F10" && event.shiftKey)) return;
    const target = event.target as Element;
    const { left, top, width, height } = target.getBoundingClientRect();
    if (!this.open({ target, at: [left + width / 2, top + height / 2], keys: true })) return;
    event.preventDefault();
    event.stopPropagation();
  }

  private key(event: KeyboardEvent): void {
    const items = [...this.root.querySelectorAll("button")];
    const at = items.indexOf(event.target as HTMLButtonElement);
    const to = { ArrowDown: at + 1, ArrowUp: at - 1, Home: 0, End: -1 }[event.key];
    if (to !== undefined) items[(to + items.length) % items.length]?.focus({ preventScroll: true });
    else if (event.key === "Escape") this.close(true);
    else if (event.key !== "Tab") return event.stopPropagation(); // letters are no tools here
    event.stopPropagation();
    if (event.key !== "Tab") event.preventDefault();
  }

  /** A finger that rests opens it, and drags nothing any more. */
  private rest(event: PointerEvent, board: HTMLElement): void {
    if (event.pointerType !== "touch" || !event.isPrimary) return;
    const { clientX, clientY, pointerId } = event;
    const target = event.target as Element;
    const end = () => {
      clearTimeout(timer);
      for (const name of ["pointermove", "pointerup", "pointercancel", "pointerdown"] as const)
        board.removeEventListener(name, moved, true);
    };
    const moved = (now: PointerEvent) => {
      const far = Math.hypot(now.clientX - clientX, now.clientY - clientY) > STILL;
      if (now.type !== "pointermove" || far) end();
    };
    const timer = window.setTimeout(() => {
      end();
      if (!this.open({ target, at: [clientX, clientY], keys: false })) return;
      const over = { pointerId, pointerType: "touch", bubbles: true, clientX, clientY };
      target.dispatchEvent(new PointerEvent("pointercancel", over));
      keptWhenLifted(target);
    }, LONG);
    // The press that begins it is still on its way.
    setTimeout(() => {
      for (const name of ["pointermove", "pointerup", "pointercancel", "pointerdown"] as const)
        board.addEventListener(name, moved, true);
    });
  }
}

/** Let no click, which would close the menu, follow when the finger that has opened it is lifted. */
function keptWhenLifted(target: Element): void {
  const lifted = new AbortController();
  const end = (event: Event) => {
    if (event.cancelable) event.preventDefault();
    lifted.abort();
  };
  const { signal } = lifted;
  for (const name of ["touchend", "touchcancel"]) target.addEventListener(name, end, { passive: false, signal });
}

/** What a menu is of, in words. */
export function titleOf(name: string | null): string {
  return name ?? say("This place");
}
