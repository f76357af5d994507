/** Keys that hold on the whole page, and those that hold on the drawing. */

export interface Shortcuts {
  board: HTMLElement;
  undo(): void;
  redo(): void;
  save(): void;
  help(): void;
  toggle(): void;
  /** Turn the crank by some degrees. */
  turn(by: number): void;
  zoom(factor: number): void;
  fit(): void;
  /** Take the tool of a key; tells whether there is one. */
  tool(key: string): boolean;
}

export function pressed(event: KeyboardEvent, page: Shortcuts): void {
  const target = event.target as HTMLElement;
  const typing = target instanceof HTMLInputElement && target.type === "text";
  if (event.ctrlKey || event.metaKey) {
    // A text that is being typed has its own undo.
    const own = typing && target.dataset.typed !== undefined;
    if (!own || event.key.toLowerCase() === "s") step(event, page);
  } else if (!typing && event.key === "?") page.help();
  else if (event.altKey) return;
  else if (drawn(target, page.board)) draw(event, page);
  else if (target instanceof HTMLButtonElement && !target.closest("dialog") && page.tool(event.key))
    event.preventDefault(); // letters mean nothing to a button
}

/** Whether a key is meant for the drawing: it has the focus, or nothing has. */
function drawn(target: HTMLElement, board: HTMLElement): boolean {
  return target === document.body || (board.contains(target) && !(target instanceof HTMLButtonElement));
}

function step(event: KeyboardEvent, page: Shortcuts): void {
  const key = event.key.toLowerCase();
  if (key === "s" && !event.shiftKey) {
    event.preventDefault();
    page.save();
  }
  if (key !== "z" && key !== "y") return;
  event.preventDefault();
  if (event.shiftKey || key === "y") page.redo();
  else page.undo();
}

function draw(event: KeyboardEvent, page: Shortcuts): void {
  const { key } = event;
  if (key === " ") page.toggle();
  else if (key === ",") page.turn(-1);
  else if (key === ".") page.turn(1);
  else if (key === "+" || key === "=") page.zoom(1.25);
  else if (key === "-") page.zoom(0.8);
  else if (key === "0") page.fit();
  else if (!page.tool(key)) return;
  event.preventDefault();
}
