/** A wire to Python in a worker of the browser, and what is kept for use offline. */

import type { Incoming, Wire } from "../protocol";
import { Bytes } from "../socket";

/** What a worker says of itself. */
type Sign = { type: "loading" | "failed"; what: string | null } | { type: "loaded"; files: string[] };

/** Of an object, what has changed since the one before (`equipoise/web/replies.py`). */
interface Changes {
  same: string[];
  items: Record<string, [number, unknown][]>;
  inside: Record<string, Changed>;
}
type Changed = Record<string, unknown> & { since?: Changes };

/** An object put together from the one before and its changes. */
export function changed(before: Record<string, unknown>, { since, ...now }: Changed): Record<string, unknown> {
  if (!since) return now;
  for (const key of since.same) now[key] = before[key];
  for (const [key, items] of Object.entries(since.items)) {
    const list = [...(before[key] as unknown[])];
    for (const [number, item] of items) list[number] = item;
    now[key] = list;
  }
  for (const [key, inside] of Object.entries(since.inside))
    now[key] = changed(before[key] as Record<string, unknown>, inside);
  return now;
}

export class WorkerWire extends Bytes implements Wire {
  private readonly worker: Worker;
  private state: Record<string, unknown> = {};

  /** `sign` hears that a package is loaded, which files have been, and why nothing can be computed. */
  constructor(address: string, sign: (sign: Sign) => void) {
    super();
    this.worker = new Worker(address, { type: "module", name: "foreground" });
    this.worker.onmessage = ({ data }: MessageEvent<Uint8Array | Sign>) => {
      if (data instanceof Uint8Array) this.hear(data.buffer as ArrayBuffer);
      else sign(data);
    };
    this.worker.onerror = (event) => sign({ type: "failed", what: event.message });
  }

  protected override whole(message: Changed): Incoming {
    if (!message.since) return message as unknown as Incoming;
    this.state = changed(this.state, message);
    return this.state as unknown as Incoming;
  }

  send(content: object): void {
    this.worker.postMessage(JSON.stringify(content));
  }

  /** Give up what takes long. */
  cancel(): void {
    this.worker.postMessage("cancel");
  }
}

/** Has the service worker keep what was loaded before it began, so that the first visit is enough. */
export class OfflineFiles {
  private readonly container = navigator.serviceWorker as ServiceWorkerContainer | undefined; // there in safe contexts alone
  /** The files of a page that a service worker answered are kept already, or are those of an older build. */
  private readonly first = !this.container?.controller;
  private waiting: string[] = [];
  private keeper: ServiceWorker | null = null;

  /** Keep files by their addresses, now or once there is who keeps them. */
  keep(addresses: string[]): void {
    if (!this.first) return;
    const loaded = addresses.filter((address) => address.startsWith("http"));
    if (this.keeper) this.keeper.postMessage(loaded);
    else this.waiting.push(...loaded);
  }

  /** Begin to keep: what has been loaded by then, and last the page itself, `worker` among its files. */
  async begin(service: string, worker: string): Promise<void> {
    if (!this.container) return;
    const registration = await this.container.register(service);
    await this.container.ready;
    this.keeper = registration.installing ?? registration.waiting ?? registration.active;
    const own = performance.getEntriesByType("resource").map(({ name }) => name);
    const page = new URL(location.href);
    page.hash = "";
    this.keep([...this.waiting.splice(0), ...own, new URL(worker, page).href, page.href]);
  }
}
