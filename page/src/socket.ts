/**
 * anywidget's `send` and `on`, spoken over a WebSocket, and the listeners of any wire whose replies
 * are bytes.
 */

import type { Heard, Incoming, Wire } from "./protocol";

/** Of a reply: length of the header, header (JSON), padding to four, numbers. */
export class Bytes {
  private readonly listeners = new Set<Heard>();

  on(_event: "msg:custom", heard: Heard): void {
    this.listeners.add(heard);
  }

  off(_event: "msg:custom", heard: Heard): void {
    this.listeners.delete(heard);
  }

  protected hear(data: ArrayBuffer): void {
    const length = new DataView(data).getUint32(0, true);
    const header = new TextDecoder().decode(new Uint8Array(data, 4, length));
    const start = Math.ceil((4 + length) / 4) * 4;
    const numbers = start < data.byteLength ? [new DataView(data, start)] : [];
    this.tell(this.whole(JSON.parse(header)), numbers);
  }

  /** A message as it was sent, of which a wire may leave out what the page has. */
  protected whole(message: object): Incoming {
    return message as Incoming;
  }

  protected tell(content: Incoming, buffers: DataView[]): void {
    for (const heard of [...this.listeners]) heard(content, buffers);
  }
}

const FIRST_WAIT = 250;
const LONGEST_WAIT = 4000;
/** The server closes so where it has said why, and where it may be tried again. */
const TRY_LATER = 1013;

/** Text goes out; bytes come in. */
export class Socket extends Bytes implements Wire {
  private socket: WebSocket | null = null;
  private unsent: string[] = [];
  private wait = FIRST_WAIT;
  private closed = false;
  private opened = 0;
  private later = 0;
  /** Between the tabs of a browser: the address of a server that was started. */
  private readonly others = new BroadcastChannel("equipoise address");

  constructor(private address: string) {
    super();
    this.others.onmessage = ({ data }) => this.take(String(data));
    this.open();
  }

  announce(): void {
    this.others.postMessage(this.address);
  }

  send(content: object): void {
    const text = JSON.stringify(content);
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(text);
    else this.unsent.push(text);
  }

  cancel(): void {
    this.send({ type: "cancel" });
  }

  close(): void {
    this.closed = true;
    this.others.close();
    this.socket?.close();
  }

  private open(): void {
    const socket = new WebSocket(this.address);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => this.begin(socket);
    socket.onclose = (event) => this.end(socket, event.code === TRY_LATER);
    socket.onmessage = (event: MessageEvent<ArrayBuffer | string>) => this.receive(event.data);
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

  private end(socket: WebSocket, announced: boolean): void {
    if (this.closed || socket !== this.socket) return;
    if (!announced) this.tell({ type: "lost" }, []);
    this.later = window.setTimeout(() => !this.closed && this.open(), this.wait);
    this.wait = Math.min(2 * this.wait, LONGEST_WAIT);
  }

  /** Another tab has found a server: where this one has none, go there, and stay for a reload. */
  private take(address: string): void {
    const { host, search } = new URL(address, location.href);
    const lost = this.opened && this.socket?.readyState !== WebSocket.OPEN;
    if (!lost || address === this.address || host !== location.host) return;
    this.address = address;
    history.replaceState(null, "", `/${search}${location.hash}`);
    clearTimeout(this.later);
    this.wait = FIRST_WAIT;
    this.open();
  }

  private receive(data: ArrayBuffer | string): void {
    if (typeof data === "string") this.tell(JSON.parse(data) as Incoming, []);
    else this.hear(data);
  }
}
