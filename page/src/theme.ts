/** Colours for canvases and pictures, which know no style sheets: read from the sheet's own variables. */

interface Colours {
  quiet: string;
  grid: string;
  axis: string;
  main: string;
  stress: string;
  third: string;
}

const NAMES: (keyof Colours)[] = ["quiet", "grid", "axis", "main", "stress", "third"];

export class Theme {
  readonly colours = {} as Colours;
  private readonly dark = matchMedia("(prefers-color-scheme: dark)");
  private readonly probe = document.createElement("i");

  /** `changed` is called after the colours have changed. */
  constructor(
    private readonly root: HTMLElement,
    private readonly changed: () => void,
  ) {
    this.probe.hidden = true;
    root.append(this.probe);
    this.read();
    this.dark.addEventListener("change", this.update);
  }

  /** Look again: a notebook may bring the style sheet late, or turn dark by its own switch. */
  readonly update = (): void => {
    if (this.read()) this.changed();
  };

  close(): void {
    this.dark.removeEventListener("change", this.update);
  }

  /** A variable may hold `light-dark(...)`; a property that uses it has the colour itself. */
  private read(): boolean {
    const before = Object.values(this.colours).join();
    const style = getComputedStyle(this.probe);
    for (const name of NAMES) {
      this.probe.style.color = `var(--${name})`;
      this.colours[name] = style.color;
    }
    this.probe.style.color = "light-dark(#fff, #000)";
    this.root.classList.toggle("dark", style.color === "rgb(0, 0, 0)");
    return Object.values(this.colours).join() !== before;
  }
}

export type Role = "main" | "stress" | "third" | "quiet";
