/** anywidget's `send` and `on`, spoken over a WebSocket. */

import type { Heard, Told, Wire } from "./protocol";

const FIRST_WAIT = 250;
const LONGEST_WAIT = 4000;
/** The server closes so where it has said why, and where it may be tried again. */
const TRY_LATER = 1013;

/** Text goes out; binary comes in: length of the header, header (JSON), padding to four, numbers. */
export class Socket implements Wire {
  private readonly listeners = new Set<Heard>();
  private socket: WebSocket | null = null;
  private unsent: string[] = [];
  private wait = FIRST_WAIT;
  private closed = false;
  private opened = 0;

  constructor(private readonly address: string) {
    this.open();
  }

  send(content: object): void {
    const text = JSON.stringify(content);
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(text);
    else this.unsent.push(text);
  }

  on(_event: "msg:custom", heard: Heard): void {
    this.listeners.add(heard);
  }

  off(_event: "msg:custom", heard: Heard): void {
    this.listeners.delete(heard);
  }

  close(): void {
    this.closed = true;
    this.socket?.close();
  }

  private open(): void {
    const socket = new WebSocket(this.address);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => this.begin(socket);
    socket.onclose = (event) => this.end(event.code === TRY_LATER);
    socket.onmessage = (event: MessageEvent<ArrayBuffer | string>) => this.hear(event.data);
    this.socket = socket;
  }

  private begin(socket: WebSocket): void {
    this.wait = FIRST_WAIT;
    // What was meant for a connection that broke is asked again by the page, in its own order.
    if (this.opened++) {
      this.unsent = [];
      this.tell({ type: "back" }, []);
    }
    for (const text of this.unsent.splice(0)) socket.send(text);
  }

  private end(told: boolean): void {
    if (this.closed) return;
    if (!told) this.tell({ type: "lost" }, []);
    setTimeout(() => !this.closed && this.open(), this.wait);
    this.wait = Math.min(2 * this.wait, LONGEST_WAIT);
  }

  private hear(data: ArrayBuffer | string): void {
    if (typeof data === "string") return this.tell(JSON.parse(data) as Told, []);
    const length = new DataView(data).getUint32(0, true);
    const header = new TextDecoder().decode(new Uint8Array(data, 4, length));
    const start = Math.ceil((4 + length) / 4) * 4;
    this.tell(
      JSON.parse(header) as Told,
      start < data.byteLength ? [new DataView(data, start)] : [],
    );
  }

  private tell(content: Told, buffers: DataView[]): void {
    for (const heard of [...this.listeners]) heard(content, buffers);
  }
}
