/** A wire to Python in a worker of the browser. */

import { Bytes } from "../bytes";
import type { Wire } from "../protocol";

/** What a worker says of itself. */
interface Sign {
  type: "loading" | "failed";
  what: string | null;
}

export class WorkerWire extends Bytes implements Wire {
  private readonly worker: Worker;

  /** `sign` hears that a package is loaded, and why nothing can be computed. */
  constructor(address: string, sign: (sign: Sign) => void) {
    super();
    this.worker = new Worker(address, { type: "module", name: "foreground" });
    this.worker.onmessage = ({ data }: MessageEvent<Uint8Array | Sign>) => {
      if (data instanceof Uint8Array) this.hear(data.buffer as ArrayBuffer);
      else sign(data);
    };
    this.worker.onerror = (event) => sign({ type: "failed", what: event.message });
  }

  send(content: object): void {
    this.worker.postMessage(JSON.stringify(content));
  }

  /** Give up what takes long. */
  cancel(): void {
    this.worker.postMessage("cancel");
  }
}
