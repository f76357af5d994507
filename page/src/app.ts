/** The page as a whole: what it shows, and how its parts are connected. */

import { Bench } from "./bench";
import { Board } from "./board";
import { Border } from "./border";
import { Charts } from "./charts";
import { type Asking, ContextMenu, type Menu, menuOf } from "./context_menu";
import { type Computation, Conversation, type Events } from "./conversation";
import { cureOf } from "./cure";
import { h, letsMove, set, write } from "./dom";
import { dropZone, handOut, picker, save, tooLarge } from "./files";
import { follow, measure } from "./format";
import { Frames } from "./frames";
import { Gallery } from "./gallery";
import { Hands } from "./hands";
import { Heading } from "./heading";
import { Inspector, Locks } from "./inspector";
import { Keeping } from "./keeping";
import { Player, TransportBar } from "./player";
import type { DownloadKind, Hello, Numbers, PageRequest, Planted, RunMessage, State, Strokes, Wire } from "./protocol";
import { BalancePanel, FigureTable, headline, Readings } from "./readings";
import { RunPanel } from "./run_panel";
import { Seeing } from "./seeing";
import { helpDialog, pressed } from "./shortcuts";
import { type Grip, Stage } from "./stage";
import type { Shelf } from "./story";
import { Theme } from "./theme";
import { type Commands, type Opened, Toolbar } from "./toolbar";
import { Tools } from "./tools";
import { Tour } from "./tour";
import { record, records } from "./video";
import { Views } from "./views";
import { language, say, word } from "./words";

/** What is shown where nothing was asked for. */
const FIRST = "yamashita-1";

/** How often numbers and words follow a drag, ms. */
const SELDOM = 280;

export class App {
  private readonly root = h("div", { class: "equipoise", lang: language() });
  private readonly talk: Conversation;
  private readonly player = new Player();
  private readonly locks = new Locks();
  private readonly theme: Theme;
  private readonly hands: Hands;
  private readonly stage: Stage;
  private readonly board: Board;
  private readonly bench: Bench;
  private readonly charts: Charts;
  private readonly runPanel: RunPanel;
  private readonly seeing: Seeing;
  private readonly inspector: Inspector;
  private readonly readings = new Readings();
  private readonly planted = new FigureTable(say("Figures of the planting finger"));
  private readonly gauges = new FigureTable(say("Figures of gauges"));
  private readonly strokes = new FigureTable(say("Figures of sliders, rockers, cams and friction"));
  private readonly across = h("img", {
    class: "across",
    alt: say("The planes of links, masses and bearings, from the side and to scale."),
    hidden: true,
  });
  private readonly balance = new BalancePanel(
    () => this.keep(),
    () => this.takeBack(),
    () => {
      this.takeBack();
      this.command({ type: "balance", hold: true });
    },
  );
  private readonly toolbar: Toolbar;
  private readonly tools: Tools;
  private readonly transport = new TransportBar(
    this.player,
    () => this.toggle(),
    () => this.crank(),
  );
  private readonly tour = new Tour(this.root);
  private readonly help = helpDialog(
    () => this.hello?.version ?? "",
    () => this.tour.begin(),
  );
  private readonly picker = picker((files) => void this.read(files));
  private readonly gallery = new Gallery({
    wanted: () => this.talk.ask({ type: "gallery" }, (refusal) => refusal !== null && this.gallery.forget()),
    stores: () => this.talk.ask({ type: "stores" }),
    store: (name) => void this.open({ type: "study", store: name }, name),
    begin: () => this.anew(),
    example: (name) => void this.open({ type: "open", example: name }, name),
    file: () => this.picker.click(),
  });
  private readonly heading = new Heading();
  private readonly keeping: Keeping;
  private readonly lost = h("div", { class: "lost", role: "alert", hidden: true });
  private readonly aside = h("section", { class: "inspector", "aria-label": say("Numbers") });
  private readonly side = h("section", { class: "side", "aria-label": say("Charts") });
  private readonly watcher = new ResizeObserver(() => this.measure());
  private readonly frames = new Frames({
    tick: (now) => this.tick(now),
    painted: () => this.frames.settle(this.held ? SELDOM : 0),
    settled: () => this.spell(),
  });
  private readonly undone: (() => void)[] = [];
  private readonly views: Views;

  private hello: Hello | null = null;
  private state: State | null = null;
  /** What is open: a machine, a tool or a study. */
  private named: Opened | null = null;
  private turned = true;
  private held = false;
  private resumes = false;
  private filming = false;
  private opened = "";

  constructor(
    private readonly wire: Wire,
    private readonly el: HTMLElement,
    shelf: Shelf | null,
    speak: (language: string) => void,
  ) {
    this.talk = new Conversation(wire, this.events(), shelf);
    el.append(this.root);
    this.theme = new Theme(this.root, () => this.repaint());
    this.views = new Views(this.talk, this.theme, (request) => this.command(request));
    const page = {
      talk: this.talk,
      state: () => this.state,
      sample: () => this.player.sample,
      chosen: (grip: Grip) => this.choose(grip),
      holding: (on: boolean) => this.hold(on),
      hint: (text: string) => this.board.hint(text),
      kept: (point: string) => this.locks.keep(point),
    };
    this.keeping = new Keeping({
      root: this.root,
      talk: this.talk,
      full: this.full,
      shown: () => this.named,
      say: (text, bad) => this.tell(text, bad),
      open: (request, name) => void this.open(request, name),
    });
    this.hands = new Hands(page, (dress) => new Stage(dress));
    this.stage = this.hands.made;
    this.board = new Board(this.stage, (link) => this.chooseLink(link));
    this.seeing = new Seeing(
      this.stage,
      (request) => this.command(request),
      () => this.stir(),
    );
    const root = this.full ? document : this.root;
    this.bench = new Bench({ ...page, root, stage: this.stage, board: this.board });
    this.tools = new Tools({
      ...page,
      stage: this.stage,
      board: this.board.root,
      snaps: () => this.bench.snaps(),
      tracing: () => this.bench.tracing(),
      begin: () => this.anew(),
      angle: () => this.player.angle,
      turn: (degrees) => this.turn(degrees),
      chosen: (link) => this.chooseLink(link),
    });
    this.charts = new Charts(
      this.theme,
      (angle) => this.turn(angle),
      (names) => this.command({ type: "outputs", names }),
      (request) => this.command(request),
    );
    this.runPanel = new RunPanel(
      this.theme,
      () => (this.player.time === null ? this.play() : this.showCycle()),
      () => {
        this.closeRun();
        this.toolbar.focusRun();
      },
      (time) => this.goToTime(time),
      (request) => this.command(request),
    );
    this.inspector = new Inspector(this.talk, (on) => this.hold(on), this.locks);
    this.toolbar = new Toolbar(this.commands(speak));
    this.toolbar.beside(this.views.back);
    this.lay();
    this.listen();
    this.talk.ask({ type: "ready" });
  }

  private repaint(): void {
    for (const part of [this.charts, this.runPanel, this.views]) part.repaint();
  }

  /** What the buttons and menus of the toolbar do. */
  private commands(speak: (language: string) => void): Commands {
    return {
      example: (name) => void this.open({ type: "open", example: name }, name),
      gallery: () => this.gallery.show(),
      undo: () => this.step("undo"),
      redo: () => this.step("redo"),
      save: () => void this.keeping.save(),
      link: () => {
        this.keeping.link();
        this.tour.did("linked");
      },
      film: records() ? () => void this.film() : null,
      balance: () => this.command({ type: "balance" }),
      run: () => this.command({ type: "run" }),
      download: (kind, language, format) => this.download(kind, language, format),
      help: () => this.help.showModal(),
      speak,
    };
  }

  /** What is done with each message of the server. */
  private events(): Events {
    return {
      hello: (message) => this.greet(message),
      state: (state) => this.take(state),
      response: (message, numbers) => {
        this.charts.answered(message, numbers);
        this.seeing.answered(message, numbers);
        this.add("response", message.notes);
      },
      strokes: (message, numbers) => {
        this.plant(message);
        this.charts.loaded(message, numbers);
      },
      planting: (message) => this.plant(message),
      side: ({ svg }) => set(this.across, { src: `data:image/svg+xml,${encodeURIComponent(svg)}`, hidden: false }),
      ghost: (message, numbers) => {
        this.seeing.pale(message.scene, numbers);
        this.charts.pale(numbers);
      },
      variants: (message) => this.seeing.variants.show(message),
      refused: (message, edit, refused) => this.refuse(message, edit, cureOf(refused)),
      balanced: (message) => {
        this.balance.show(message);
        this.tour.did("balanced", headline(message));
      },
      ran: (message, numbers) => this.ran(message, numbers),
      busy: (computed) => this.busy(computed),
      tables: (message) => this.bench.show(message),
      file: save,
      pictured: (picture, numbers) => (picture ? this.gallery.add(picture, numbers) : this.gallery.done()),
      tool: (message, numbers) => {
        this.opened = "";
        this.views.showTool(message, numbers);
        const lacking = say("a hand-held tool is changed by its numbers");
        this.name({ ...message, lacking, downloads: ["model", "report"] });
      },
      stores: (message) => this.gallery.stored(message),
      study: (message, numbers) => {
        this.opened = "";
        this.views.showStudy(message, numbers);
        const { name } = message;
        const lacking = say("open one of its designs first");
        this.name({ name, undo: null, redo: null, lacking, file: null, downloads: [] });
      },
      saved: (name) => this.keeping.saved(name),
      line: (up, other, waiting) => this.line(up, other, waiting),
      waiting: (on) => set(this.root, { "data-waiting": on }),
      calm: (on) => (on ? this.frames.settle(0) : this.settled(false)),
    };
  }

  close(): void {
    this.frames.close();
    this.views.close();
    this.charts.close();
    this.runPanel.clear();
    this.bench.close();
    this.talk.close();
    this.keeping.close();
    this.theme.close();
    this.watcher.disconnect();
    for (const undo of this.undone) undo();
    this.root.remove();
  }

  private lay(): void {
    const stage = h("section", { class: "stage", "aria-label": say("Linkage and motion") });
    stage.append(this.heading.about, this.tools.palette.root, this.board.root);
    stage.append(this.transport.root, this.seeing.root, this.heading.notes, this.readings.root);
    stage.append(this.seeing.variants.root);
    stage.append(this.across, this.gauges.root, this.strokes.root, this.planted.root);
    const empty = say(
      "Forces, torque and paths appear here as soon as the machine moves. The line above the drawing says what is missing.",
    );
    this.side.append(h("p", { class: "quiet empty" }, empty), this.runPanel.charts, this.charts.root);
    // A file that plays shows numbers, and takes none.
    const disabled = this.played;
    const parts = [...this.bench.roots, this.inspector.root];
    const controls = disabled ? h("fieldset", { class: "bare", disabled }, ...parts) : h("div", {}, ...parts);
    this.aside.append(this.runPanel.root, this.balance.root, controls);
    if (disabled) this.aside.tabIndex = 0; // to be scrolled by keys
    const border = new Border(this.views.body, () => this.measure());
    this.views.body.append(stage, border.root, this.side, this.aside);
    this.root.append(this.toolbar.root, this.lost, this.keeping.offer, this.tour.offer, ...this.views.roots);
    this.root.append(
      dropZone(this.root, (files) => void this.read(files)),
      this.help,
      this.gallery.root,
      this.picker,
    );
    this.board.root.append(this.readings.pins.root);
    if (!this.played)
      this.root.append(new ContextMenu(this.board.root, this.root, (asking) => this.offered(asking)).root);
    this.watcher.observe(this.board.root);
    this.watcher.observe(this.charts.root);
  }

  /** What can be done where a menu is asked for. */
  private offered({ target, at: [x, y], keys }: Asking): Menu | null {
    const { svg } = this.stage;
    if (!svg.contains(target)) return null;
    if (this.acyclic) {
      this.showCycle();
      this.pose(); // the menu is of what is there in the cycle
    }
    const box = svg.getBoundingClientRect();
    const hit = keys ? this.tools.focused(target) : this.tools.at([x - box.left, y - box.top]);
    const { parts } = this.bench;
    return (
      hit &&
      menuOf(hit, {
        state: () => this.state,
        make: (made) => this.tools.make(made),
        add: (path, values) => parts.add(path, values),
        change: (path, key) => parts.change(path, key),
        numbers: (group) => this.inspector.enter(group),
        written: (place) => place.map((value) => parts.written(value)) as [string, string],
      })
    );
  }

  private listen(): void {
    const shortcuts = {
      board: this.board.root,
      undo: () => this.step("undo"),
      redo: () => this.step("redo"),
      save: () => void this.keeping.save(),
      help: () => this.help.showModal(),
      toggle: () => this.toggle(),
      turn: (by: number) => this.turnBy(by),
      zoom: (factor: number) => this.stage.zoom(factor),
      fit: () => this.stage.fit(),
      tool: (key: string) => this.tools.pick(key),
    };
    this.root.addEventListener("keydown", (event) => pressed(event, shortcuts));
    for (const kind of ["pointerdown", "keydown"] as const)
      this.board.root.addEventListener(kind, (event) => this.toCycle(event), true);
    if (!this.full) return;
    // The page is all there is: undo and help also where nothing has the focus.
    const key = (event: KeyboardEvent) => event.target === document.body && pressed(event, shortcuts);
    document.addEventListener("keydown", key);
    this.undone.push(() => document.removeEventListener("keydown", key));
  }

  private get full(): boolean {
    return this.el.classList.contains("equipoise-page");
  }

  private get played(): boolean {
    return this.el.classList.contains("equipoise-played");
  }

  private greet(hello: Hello): void {
    const first = !this.hello;
    this.hello = hello;
    follow(hello.numbers);
    this.toolbar.offer(hello.examples, hello.tools);
    this.views.stored(hello.study);
    if (this.named) this.name();
    else if (first) void this.begin(hello);
  }

  private async begin(hello: Hello): Promise<void> {
    const resumed = await this.keeping.begin(hello);
    if (this.full && !this.played) this.tour.propose();
    if (!resumed && !hello.machine) {
      if (this.keeping.offer.hidden) this.gallery.show(); // else it would cover what is offered
      const names = hello.examples.map(({ name }) => name);
      const example = names.find((name) => name === FIRST) ?? names[0];
      if (example) void this.open({ type: "open", example }, example);
    }
  }

  private take(state: State): void {
    const other = state.name !== this.state?.name || this.opened !== "";
    this.opened = "";
    const begins = this.state?.status.finished === false && state.status.finished;
    const angle = this.state ? this.player.angle : 0;
    this.state = state;
    word(state.wording);
    this.views.machine();
    measure(state.length);
    this.player.take(state);
    if (state.design !== this.runPanel.design) this.closeRun();
    if (other) this.forget(state);
    else this.player.angle = state.status.stand ?? angle;
    if (begins) this.player.suit();
    if (!state.planting) this.planted.hide();
    if (!state.shaken) this.gauges.hide();
    if (!state.beside) this.across.hidden = true;
    if (!state.before) this.balance.hide();
    this.board.clear(this.held || other);
    if (state.held) this.board.say(state.held, true);
    this.hands.accepted();
    this.show(state, other);
    if (!this.held && !other && state.undo) this.tour.did("dragged");
  }

  /** Another machine comes: nothing of the last stays, and it moves from its beginning. */
  private forget(state: State): void {
    this.player.angle = 0;
    this.side.scrollTop = this.aside.scrollTop = 0;
    this.player.suit();
    this.player.playing = state.speed !== 0 && letsMove();
    this.heading.forget();
    this.bench.forget();
    this.inspector.anew();
    this.tools.anew();
    for (const table of [this.planted, this.strokes, this.gauges]) table.hide();
    this.across.hidden = true;
  }

  private name(opened = this.named): void {
    this.named = opened;
    if (opened) this.toolbar.show(opened);
  }

  private plant(planted: Planted | Strokes): void {
    const tables = { strokes: this.strokes, gauges: this.gauges, planting: this.planted };
    tables[planted.type].show(planted);
    this.add(planted.type, planted.notes);
  }

  /** What comes after a state has notes of its own. */
  private add(of: string, notes: string[]): void {
    this.heading.also(of, notes);
    if (this.state) this.heading.show(this.state);
  }

  /** Draw a frame; returns whether another is needed. */
  private tick(now: number): boolean {
    if (this.player.tick(now) || this.turned) this.point();
    return this.player.playing;
  }

  /** Draw a state at once: the next frame then has only to be painted. */
  private show(state: State, other: boolean): void {
    this.named = state;
    if (other) {
      this.name();
      this.heading.show(state);
    }
    this.seeing.show(state, other);
    this.stage.show(this.player.time === null ? state : this.runPanel.poses(state), other);
    this.transport.take();
    this.charts.show(state, other);
    this.point();
    this.frames.draw(state.seq);
  }

  /** Bring numbers and words up to date: after painting, and more seldom during a drag. */
  private spell(): void {
    if (this.state) this.write(this.state);
    this.settled(this.talk.calm);
  }

  /** Whether the page shows all that there is to what was done last. */
  private settled(on: boolean): void {
    if (on !== this.root.hasAttribute("data-settled")) set(this.root, { "data-settled": on });
  }

  private write(state: State): void {
    this.name();
    this.readings.show(state);
    this.inspector.show(state);
    if (!this.held) this.bench.follow();
    if (this.held) this.charts.read();
    else {
      this.theme.update();
      this.charts.settle();
    }
    this.tools.show(state);
    this.root.classList.toggle("unfinished", !state.status.finished);
    this.hands.describe();
    this.hands.follow();
    this.heading.show(state);
  }

  private point(): void {
    if (!this.state) return;
    this.turned = false;
    const { angles, turns } = this.state;
    const k = this.pose();
    this.transport.point();
    this.transport.state();
    if (this.acyclic) return;
    this.charts.point(k, (k / angles) * 360 * turns);
  }

  /** Draw the pose of the moment; gives the sample of the cycle. */
  private pose(): number {
    const { player, runPanel, stage, state } = this;
    if (player.time === null) {
      const k = this.seeing.crank(player.sample);
      stage.pose(k);
      return k;
    }
    const k = runPanel.at(player.time, runPanel.poses(state as State).angles);
    if (runPanel.cyclic) player.sample = k;
    stage.swing = runPanel.swing(state as State);
    stage.pose(k);
    return k;
  }

  /** What came of a run, if it is of the machine that is shown. */
  private ran(message: RunMessage, numbers: Numbers): void {
    const { state } = this;
    if (!state || message.design !== state.design)
      return this.tell(say("the machine was changed while it ran; run it again"), true);
    this.runPanel.show(message, numbers, state);
    this.board.say(this.runPanel.verdict, false);
    this.measure();
    this.play();
  }

  /** Play the run from its start. */
  private play(): void {
    this.tools.rest();
    this.player.run(this.runPanel.span);
    this.player.playing = letsMove();
    this.switchClock();
  }

  /** Play the cycle, and not the run. */
  private showCycle(): void {
    if (this.player.time === null) return;
    this.player.leave();
    this.player.playing = false;
    this.switchClock();
  }

  /** Whether the drawing shows a pose that is none of the cycle, and in which nothing can be changed. */
  private get acyclic(): boolean {
    return this.player.time !== null && !this.runPanel.cyclic;
  }

  /** Nothing is taken hold of in poses that are none of the cycle: the cycle is shown first. */
  private toCycle(event: PointerEvent | KeyboardEvent): void {
    if (!this.acyclic || !(event.target as Element).closest(".grip")) return;
    if (event instanceof KeyboardEvent ? !event.key.startsWith("Arrow") : event.button) return;
    event.preventDefault();
    event.stopPropagation();
    this.showCycle();
  }

  /** The run or the cycle is played from now on. */
  private switchClock(): void {
    const { player, runPanel, state } = this;
    const runs = player.time !== null;
    this.root.classList.toggle("running", runs);
    runPanel.playing(runs);
    if (state) this.stage.show(runs ? runPanel.poses(state) : state, false);
    this.transport.take();
    this.stir();
  }

  /** Show no run any more. */
  private closeRun(): void {
    if (this.runPanel.design === null) return;
    this.runPanel.drop();
    this.showCycle();
  }

  private goToTime(time: number): void {
    if (this.player.time === null) this.play();
    this.player.time = time;
    this.crank();
  }

  /** The crank is at another angle, or is to turn. */
  private stir(): void {
    this.turned = true;
    if (!this.player.playing) this.frames.settle(SELDOM);
    this.frames.wake();
  }

  private measure(): void {
    this.theme.update();
    const { clientWidth, clientHeight } = this.board.root;
    if (clientWidth && clientHeight) this.stage.resize(clientWidth, clientHeight);
    this.charts.resize(this.charts.root.clientWidth);
    this.runPanel.resize(this.charts.root.clientWidth);
    this.stir();
  }

  private busy(computed: Computation[]): void {
    this.toolbar.busy(computed, this.wire.cancel && (() => this.wire.cancel?.()));
    const what = computed.at(-1)?.what;
    if (what) this.board.say(`${what.slice(0, 1).toUpperCase()}${what.slice(1)} …`, false);
    else this.board.clear(false);
  }

  /** Say something wherever it is seen. */
  private tell(text: string, bad: boolean, cure: HTMLElement | null = null): void {
    this.views.say(text, bad);
    this.board.say(text, bad, cure);
  }

  private refuse(message: string, edit: number | null, cure: HTMLElement | null): void {
    this.tell(message, true, cure);
    if (edit !== null) {
      this.hands.refused();
      this.frames.draw(edit); // what is shown of the attempt is its answer
    }
    this.opened = "";
    this.name();
  }

  private line(up: boolean, other: boolean, waiting: number): void {
    this.lost.hidden = up;
    set(this.root, { "data-lost": !up });
    this.closeRun(); // numbers of designs begin anew
    if (waiting === 0) this.tools.anew(); // what was asked is not answered any more
    if (up) return write(this.lost, "");
    const why = other
      ? say("The server has another file open. What was done here is kept until one has this file.")
      : say(
          "The server does not answer; trying again. If it was ended, start it again and open the address that it prints: this tab goes on then.",
        );
    const kept = waiting ? ` ${say("Changes waiting for the server: {count}.", { count: waiting })}` : "";
    write(this.lost, why + kept);
  }

  private async open(request: PageRequest, name: string): Promise<void> {
    if (!(await this.keeping.mayLeave(name))) return this.name();
    this.talk.release();
    this.opened = "asked";
    this.talk.ask(request);
    if (!this.named) return;
    // What is named is what is drawn, until the other machine is there.
    this.name();
    this.board.say(say("Opening {name} …", { name }), false);
  }

  private anew(): void {
    void this.open({ type: "open", new: true }, say("a new machine"));
  }

  /** Open a model with the tables that come with it, or take a record or what is traced over. */
  private async read(chosen: File[]): Promise<void> {
    const isTable = ({ name }: File) => /\.csv$/i.test(name);
    const file = chosen.find((file) => !isTable(file)) ?? chosen[0];
    if (!file || this.bench.take(file)) return;
    const tables = chosen.filter((table) => table !== file && isTable(table));
    for (const readable of [file, ...tables]) {
      const problem = tooLarge(readable, this.hello?.largest ?? Infinity);
      if (problem) return this.board.say(problem, true);
    }
    const [{ name }, text] = [file, await file.text()];
    // Without a text a record is taken away.
    if (isTable(file)) return this.command({ type: "record", name, text: text || "\n" });
    const texts = tables.map(async (table) => [table.name, await table.text()] as const);
    const files = Object.fromEntries(await Promise.all(texts));
    void this.open({ type: "open", name, text, files }, name);
  }

  private command(request: PageRequest): void {
    this.talk.release();
    this.talk.ask(request);
  }

  private step(type: "undo" | "redo"): void {
    this.talk.release();
    // What was held until now is a step of its own, which the state does not have yet.
    if (!this.named || !(this.talk.busy || this.named[type])) return;
    this.board.say("", false);
    this.inspector.forget();
    this.talk.ask({ type });
  }

  private keep(): void {
    this.balance.hide();
    this.tour.did("decided");
    this.command({ type: "compare", on: false });
  }

  private takeBack(): void {
    this.balance.hide();
    this.tour.did("decided");
    this.command({ type: "undo" });
    this.command({ type: "compare", on: false });
  }

  private download(kind: DownloadKind, language = "en", format?: "svg" | "png"): void {
    const at = this.player.sample;
    this.command({ type: "download", kind, language, at, ...(format && { format }) });
  }

  /** Record one cycle, or the run, as it is played, and hand it out, unless something else comes to be shown. */
  private async film(): Promise<void> {
    const { state, player } = this;
    if (!state || this.filming) return;
    const { share, playing } = player;
    const runs = player.time !== null;
    const shown = () => this.state?.design === state.design && (player.time !== null) === runs;
    this.filming = true;
    player.playing = false;
    this.tell(player.time === null ? say("Recording one cycle …") : say("Recording the run …"), false);
    const show = (now: number) => {
      if (!shown()) return false;
      player.share = now;
      this.point();
      return true;
    };
    try {
      const areas = [this.board.root, this.side].filter((area) => area.checkVisibility());
      const video = await record({ root: this.el, areas, seconds: player.duration, show });
      if (!video) return this.tell(say("The recording was ended, as something else is shown now."), true);
      handOut(`${state.name.replace(/\.toml$/, "")}.${video.suffix}`, video.blob.type, video.blob);
      this.tell("", false);
    } catch {
      this.tell(say("This browser does not record pages; take the motion as a GIF."), true);
    } finally {
      this.filming = false;
      if (shown()) [player.share, player.playing] = [share, playing];
      this.stir();
    }
  }

  private choose(grip: Grip): void {
    const { scene } = this.state ?? {};
    if (!scene) return;
    const frame = grip.kind === "point" && scene.frame.includes(grip.name);
    const holder = scene.bodies.find((body) => body.points.includes(grip.name))?.name ?? null;
    const table = scene.circles.find(({ name }) => name === grip.name)?.table ?? null;
    const link = { mass: grip.name, radius: table, point: frame ? "frame" : holder }[grip.kind];
    this.stage.select(new Set([grip.name]), grip.kind === "mass" ? grip.name : null, grip);
    this.inspector.choose(link, grip.kind === "point" ? grip.name : null);
    this.tools.selected(grip);
    if (grip.kind === "point") this.charts.choose(grip.name);
    if (grip.kind === "point") this.seeing.choose(grip.name);
  }

  private chooseLink(link: string): void {
    const body = this.state?.scene.bodies.find((body) => body.name === link);
    this.stage.select(new Set(body?.points), link, null);
    this.inspector.choose(link, null);
    this.tools.choose({ what: "link", name: link });
  }

  /** While something is held, the crank stands still. */
  private hold(on: boolean): void {
    this.held = on;
    this.seeing.hold(on);
    this.charts.hold(on);
    if (on) {
      this.showCycle();
      this.resumes = this.player.playing;
      this.player.playing = false;
    } else if (this.resumes) {
      this.player.playing = true;
      this.resumes = false;
    }
    this.stir();
  }

  private toggle(): void {
    this.talk.release();
    this.player.toggle();
    this.tour.did("turned");
    this.stir();
  }

  private crank(): void {
    this.player.playing = false;
    this.tour.did("turned");
    this.stir();
  }

  /** By some degrees, or of a run by so many steps. */
  private turnBy(by: number): void {
    if (this.player.time === null) return this.turn(this.player.angle + by);
    this.player.step += by;
    this.crank();
  }

  private turn(degrees: number): void {
    this.showCycle();
    this.player.angle = degrees;
    this.crank();
  }
}
