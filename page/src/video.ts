/** A video of the drawing and the charts beside it, recorded as they move, in the browser alone. */

import { h } from "./dom";

/** Kinds of videos, the first that a browser can write is taken. */
const KINDS = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm", "video/mp4"];
/** How long a video is at least and at most, s. */
const [SHORTEST, LONGEST] = [2, 20];
const BITS = 8e6;
/** Elements whose attributes do not hold what was chosen or typed. */
const TYPED = "select, input";

/** What is recorded: elements side by side, each as much of it as is seen. */
interface Scenery {
  /** Around them: its classes and those above it are what style sheets ask for. */
  root: HTMLElement;
  areas: HTMLElement[];
  /** How long what moves takes as it is played, s. */
  seconds: number;
  /** Show the moment at which a share of it is over; returns whether it can still be shown. */
  show(share: number): boolean;
}

interface Video {
  blob: Blob;
  suffix: string;
}

/** Whether this browser can record one. */
export function records(): boolean {
  return typeof MediaRecorder !== "undefined" && kind() !== undefined && "captureStream" in HTMLCanvasElement.prototype;
}

function kind(): string | undefined {
  return KINDS.find((kind) => MediaRecorder.isTypeSupported(kind));
}

/** Record what moves from its start to its end: a picture at every frame that the browser gives; null where it is shown no more. */
export async function record({ root, areas, seconds, show }: Scenery): Promise<Video | null> {
  const mimeType = kind() as string;
  const reel = new Reel(root, areas);
  const stream = reel.canvas.captureStream(0);
  const [track] = stream.getVideoTracks() as [CanvasCaptureMediaStreamTrack];
  const recorder = new MediaRecorder(stream, { mimeType, videoBitsPerSecond: BITS });
  const parts: Blob[] = [];
  recorder.addEventListener("dataavailable", ({ data }) => parts.push(data));
  const stopped = new Promise((resolve) => recorder.addEventListener("stop", resolve));
  const whole = Math.min(Math.max(seconds, SHORTEST), LONGEST);
  show(0);
  await reel.draw();
  recorder.start();
  const start = performance.now();
  // However slow a browser draws, the first and the last moment are recorded.
  let shown = true;
  for (let share = 0; ; share = Math.min((performance.now() - start) / 1000 / whole, 1)) {
    shown = show(share);
    if (!shown) break;
    await reel.draw();
    track.requestFrame();
    await new Promise((resolve) => requestAnimationFrame(resolve));
    if (share === 1) break;
  }
  recorder.stop();
  await stopped;
  for (const streamTrack of stream.getTracks()) streamTrack.stop();
  return !shown ? null : { blob: new Blob(parts, { type: mimeType }), suffix: mimeType.slice(6, 10).replace(";", "") };
}

/** A canvas on which parts of the page are drawn as they stand. */
class Reel {
  readonly canvas = h("canvas");
  private readonly pen: CanvasRenderingContext2D;
  private readonly style: string;
  private readonly scheme: "light" | "dark";
  private readonly paper: string;
  private readonly size: [width: number, height: number];

  constructor(
    private readonly root: HTMLElement,
    private readonly areas: HTMLElement[],
  ) {
    const boxes = areas.map((area) => area.getBoundingClientRect());
    // Encoders take even numbers of pixels.
    const even = (value: number) => 2 * Math.ceil(value / 2);
    this.size = [even(sum(boxes.map(({ width }) => width))), even(Math.max(...boxes.map(({ height }) => height)))];
    [this.canvas.width, this.canvas.height] = this.size;
    this.pen = this.canvas.getContext("2d") as CanvasRenderingContext2D;
    const sheets = [...(root.getRootNode() as Document | ShadowRoot).styleSheets];
    const rules = sheets.flatMap((sheet) => [...sheet.cssRules].map(({ cssText }) => cssText));
    this.style = [...rules, EXTRA].join("\n").replace(/&/g, "&amp;").replace(/</g, "&lt;");
    const [first] = areas;
    this.scheme = first?.closest(".dark") ? "dark" : "light";
    this.paper = first ? paperOf(first) : "white";
  }

  async draw(): Promise<void> {
    const [width, height] = this.size;
    const { pen } = this;
    const stage = h("div", { xmlns: "http://www.w3.org/1999/xhtml" });
    stage.style.cssText = `position:relative;width:${width}px;height:${height}px;overflow:hidden;color-scheme:${this.scheme}`;
    let left = 0;
    const drawn: (() => void)[] = [];
    for (const area of this.areas) {
      const box = area.getBoundingClientRect();
      const place = `left:${left}px;width:${box.width}px;height:${box.height}px`;
      stage.append(within(area, this.root, clone(area), place));
      const from = left;
      drawn.push(() => this.curves(area, box, from));
      left += box.width;
    }
    const html = new XMLSerializer().serializeToString(stage);
    const svg = `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}"><style>${this.style}</style><foreignObject width="100%" height="100%">${html}</foreignObject></svg>`;
    const image = new Image(width, height);
    image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svg)}`;
    await image.decode();
    pen.fillStyle = this.paper;
    pen.fillRect(0, 0, width, height);
    pen.drawImage(image, 0, 0);
    for (const draw of drawn) draw();
  }

  /** Draw what canvases of an area show, which its copy has not. */
  private curves(area: HTMLElement, box: DOMRect, left: number): void {
    const { pen } = this;
    pen.save();
    pen.beginPath();
    pen.rect(left, 0, box.width, box.height);
    pen.clip();
    for (const canvas of area.querySelectorAll("canvas")) {
      const { x, y, width, height } = canvas.getBoundingClientRect();
      if (width) pen.drawImage(canvas, left + x - box.x, y - box.y, width, height);
    }
    pen.restore();
  }
}

/** What is pressed, and what is said of the recording, are no part of a picture. */
const EXTRA = ".equipoise :is(button,.said,.hint){visibility:hidden}";

/** A copy of an element as it is seen: with what was chosen, and scrolled as it is. */
function clone(area: HTMLElement): HTMLElement {
  const copy = area.cloneNode(true) as HTMLElement;
  const typed = area.querySelectorAll<HTMLSelectElement | HTMLInputElement>(TYPED);
  copy.querySelectorAll<HTMLSelectElement | HTMLInputElement>(TYPED).forEach((input, i) => {
    const value = typed[i]?.value ?? "";
    if (input instanceof HTMLInputElement) input.setAttribute("value", value);
    else for (const option of input.options) option.toggleAttribute("selected", option.value === value);
  });
  for (const element of copy.querySelectorAll("canvas, script")) element.replaceWith(blank(element));
  for (const child of copy.children) if (child instanceof HTMLElement) child.style.translate = `0 ${-area.scrollTop}px`;
  copy.style.cssText += ";position:absolute;inset:0;margin:0;overflow:hidden;width:100%;height:100%";
  return copy;
}

/** As large as a canvas, which is drawn by itself. */
function blank(element: Element): HTMLElement {
  const box = h("div");
  box.style.cssText = element.getAttribute("style") ?? "";
  return box;
}

/** In copies of all that is around it, which have no room of their own. */
function within(area: HTMLElement, root: HTMLElement, copy: HTMLElement, place: string): HTMLElement {
  let inner: HTMLElement = h("div", {}, copy);
  inner.style.cssText = `position:absolute;top:0;overflow:hidden;${place}`;
  for (let parent = area.parentElement; parent; parent = parent.parentElement) {
    const around = parent.cloneNode(false) as HTMLElement;
    around.removeAttribute("id");
    around.style.display = "contents";
    around.append(inner);
    inner = around;
    if (parent === root) break;
  }
  return inner;
}

/** The colour behind an element: that of the first around it which has one. */
function paperOf(element: HTMLElement): string {
  for (let parent: HTMLElement | null = element; parent; parent = parent.parentElement) {
    const { backgroundColor } = getComputedStyle(parent);
    if (!/^rgba\(.*, 0\)$|^transparent$/.test(backgroundColor)) return backgroundColor;
  }
  return element.closest(".dark") ? "black" : "white";
}

function sum(values: number[]): number {
  return values.reduce((all, value) => all + value, 0);
}
