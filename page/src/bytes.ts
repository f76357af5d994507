/** Listeners of a wire whose replies come as bytes. */

import type { Heard, Told } from "./protocol";

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
  protected whole(message: object): Told {
    return message as Told;
  }

  protected tell(content: Told, buffers: DataView[]): void {
    for (const heard of [...this.listeners]) heard(content, buffers);
  }
}
