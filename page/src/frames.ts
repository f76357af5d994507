/** When to draw: a frame is asked for where there is a reason, and what follows it waits. */

interface Reasons {
  /** Draw a frame; returns whether another is needed. */
  tick(now: number): boolean;
  /** What was drawn has been painted. */
  painted(): void;
  /** Time for what is less urgent. */
  settled(): void;
}

export class Frames {
  private frame = 0;
  private later = 0;
  private due = Infinity;
  /** Number of the state that is drawn and waits for its frame. */
  private drawn: number | null = null;
  /** A message that is posted in a frame arrives after that frame has been painted. */
  private readonly after = new MessageChannel();

  constructor(private readonly reasons: Reasons) {
    this.after.port1.onmessage = (event: MessageEvent<number>) => {
      mark("equipoise:painted", event.data);
      reasons.painted();
    };
  }

  wake(): void {
    if (!this.frame) this.frame = requestAnimationFrame(this.tick);
  }

  /** A state has been drawn and is to be painted. */
  draw(seq: number): void {
    this.drawn = seq;
    this.wake();
  }

  /** Call `settled` once, after some time, ms; the shortest counts. */
  settle(wait: number): void {
    const due = performance.now() + wait;
    if (due >= this.due) return;
    clearTimeout(this.later);
    this.due = due;
    this.later = window.setTimeout(() => {
      this.due = Infinity;
      this.reasons.settled();
    }, wait);
  }

  close(): void {
    cancelAnimationFrame(this.frame);
    clearTimeout(this.later);
    this.after.port1.close();
  }

  private readonly tick = (now: number): void => {
    this.frame = 0;
    const more = this.reasons.tick(now);
    if (this.drawn !== null) this.after.port2.postMessage(this.drawn);
    this.drawn = null;
    if (more) this.wake();
  };
}

const MOST_MARKS = 2000;
let marks = 0;

/** A mark for measuring how long it takes from an input to what is seen of it. */
export function mark(name: string, seq: number, startTime?: number): void {
  if (++marks > MOST_MARKS) {
    marks = 0;
    performance.clearMarks("equipoise:input");
    performance.clearMarks("equipoise:painted");
  }
  performance.mark(name, startTime === undefined ? { detail: { seq } } : { startTime, detail: { seq } });
}
