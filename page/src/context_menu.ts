/** What can be done at a joint, a link or a place: by the right button, a long press, or the menu key. */

import { h, set } from "./dom";
import { keyPath, type MenuSource, type Pair, type Plain, type State, type Values } from "./protocol";
import type { Hit } from "./snap";
import { menuItems, say } from "./words";

/** Of a finger that rests: how long, ms, and by how many pixels it may move. */
const [LONG, STILL] = [550, 8];

interface Action {
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
    if (!this.root.hidden) return true; // a finger that rests causes two events
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

/** What of the page it needs. */
interface Doing {
  state(): State | null;
  /** Do something to the machine, as a tool does. */
  make(made: { do: string } & Record<string, unknown>): void;
  /** Open the form of a table that is added, with some of its values. */
  add(path: string, values: Values): void;
  /** Open the form of a table that there is, at a key. */
  change(path: string, key: string): void;
  /** Show the numbers of a group, and go to the first. */
  numbers(group: string): void;
  /** A place as it is typed. */
  written(place: Pair): [string, string];
}

const FRAME = "frame";

/** What a menu is opened at, as kinds of parts and tables name it. */
type Sources = Partial<Record<MenuSource, Plain>>;

export function menuOf(hit: Hit, page: Doing): Menu | null {
  const state = page.state();
  if (!state) return null;
  const here = additions({ place: page.written(hit.place) }, page);
  if (hit.point) return { of: titleOf(hit.point), actions: [...atJoint(hit.point, state, page), ...here] };
  if (hit.link) return { of: titleOf(hit.link), actions: [...atLink(hit, hit.link, state, page), ...here] };
  const point = {
    name: say("Point of the frame"),
    act: () => page.make({ do: "point", spot: { place: hit.place }, on: FRAME }),
  };
  return { of: titleOf(null), actions: [point, ...here] };
}

function atJoint(point: string, state: State, page: Doing): Action[] {
  const { bodies, frame } = state.scene;
  const holders = bodies.filter(({ points }) => points.includes(point)).map(({ name }) => name);
  const [link] = holders;
  const blocks = bodies.filter(({ points: [first, ...more] }) => first === point && !more.length); // they lie on it
  const fixed = frame.includes(point);
  const meets = holders.length + (fixed ? 1 : 0) > 1;
  const actions: (Action | false)[] = [
    ...additions({ point, ends: [point], ...(link && { link }), ...(!fixed && { moving_point: point }) }, page),
    ...blocks.map(({ name }) => ({
      name: say("Mass of {link} …", { link: name }),
      act: () => page.change(keyPath("links", name), "mass"),
    })),
    !!link && fixed && weight(link, state, page),
    fixed
      ? { name: say("Free from the frame"), act: () => page.make({ do: "free", point }) }
      : { name: say("Pin to the frame"), act: () => page.make({ do: "ground", point }) },
    meets && { name: say("Separate"), act: () => page.make({ do: "separate", point }) },
    { name: say("Delete"), act: () => page.make({ do: "delete", what: "point", name: point }) },
  ];
  return actions.filter((action) => !!action);
}

function atLink(hit: Hit, link: string, state: State, page: Doing): Action[] {
  const { bodies, frame } = state.scene;
  const points = bodies.find(({ name }) => name === link)?.points ?? [];
  const pinned = points.filter((name) => frame.includes(name)).length === 1;
  const spot = { place: hit.place, on: link };
  const part = hit.part;
  const actions: (Action | false)[] = [
    { name: say("Mass …"), act: () => page.change(keyPath("links", link), "mass") },
    weight(link, state, page),
    { name: say("Point of the link"), act: () => page.make({ do: "point", spot, on: link }) },
    ...additions({ link, ...(points.length > 1 && { line: points.slice(0, 2) }) }, page),
    pinned && link !== state.status.drive && { name: say("Drive"), act: () => page.make({ do: "drive", link }) },
    {
      name: say("Delete"),
      act: () => page.make(part ? { do: "delete", ...part } : { do: "delete", what: "link", name: link }),
    },
  ];
  return actions.filter((action) => !!action);
}

/** Only what turns about the frame, and has a mass, carries one. */
function weight(link: string, { fields }: State, page: Doing): Action | false {
  const group = `counterweight on ${link}`;
  return (
    fields.some((field) => field.group === group) && { name: say("Counterweight"), act: () => page.numbers(group) }
  );
}

/** What can be added there, each with the first of its values that can be had. */
function additions(sources: Sources, page: Doing): Action[] {
  return menuItems().flatMap(({ name, place, values }) => {
    const known = values.find((keys) => Object.values(keys).every((source) => source in sources));
    if (!known) return [];
    const entries = Object.entries(known).map(([key, source]) => [key, sources[source] as Plain]);
    return [{ name, act: () => page.add(place, Object.fromEntries(entries) as Values) }];
  });
}
