/** What can be done at a joint, a link or a place of the sheet, as a menu offers it. */

import { type Action, type Menu, titleOf } from "./context_menu";
import type { Pair, State, Values } from "./protocol";
import type { Hit } from "./snap";
import { say } from "./words";

/** What of the page it needs. */
export interface Doing {
  state(): State | null;
  /** Do something to the machine, as a tool does. */
  make(made: { do: string } & Record<string, unknown>): void;
  /** Open the form of a new table of a list, with some of its values. */
  add(where: string, values: Values): void;
  /** Open the form of a table that there is, with other values of some keys, at one of these. */
  change(where: string, values: Values, key: string): void;
  /** Show the numbers of a group, and go to the first. */
  numbers(group: string): void;
  /** A place as it is typed. */
  written(place: Pair): [string, string];
}

const FRAME = "frame";

export function menuOf(hit: Hit, page: Doing): Menu | null {
  const state = page.state();
  if (!state) return null;
  const here = placed(hit, page);
  if (hit.point) return { of: titleOf(hit.point), actions: [...atJoint(hit.point, state, page), ...here] };
  if (hit.link) return { of: titleOf(hit.link), actions: [...atLink(hit, hit.link, state, page), ...here] };
  const point = { name: say("Point of the frame"), act: () => page.make({ do: "point", spot: { place: hit.place }, on: FRAME }) };
  return { of: titleOf(null), actions: [point, ...here] };
}

function atJoint(point: string, state: State, page: Doing): Action[] {
  const { bodies, frame } = state.scene;
  const holders = bodies.filter(({ points }) => points.includes(point)).map(({ name }) => name);
  const [link] = holders;
  const blocks = bodies.filter(({ points: [first, ...more] }) => first === point && !more.length); // they lie on it
  const fixed = frame.includes(point);
  const meets = holders.length + (fixed ? 1 : 0) > 1;
  const actions: (Action | false)[] = [
    // A spring pulls a link at a point that moves, and ends in the frame.
    { name: say("Spring …"), act: () => page.add("springs", link && !fixed ? { link, point } : { to: point }) },
    !!link && { name: say("Load …"), act: () => page.add("loads", { link, point }) },
    !!link && { name: say("Cylinder …"), act: () => page.change("drive", { link, between: [point] }, "between") },
    ...blocks.map(({ name }) => ({
      name: say("Mass of {link} …", { link: name }),
      act: () => page.change(`links.${name}`, {}, "mass"),
    })),
    !!link && fixed && weight(link, state, page),
    fixed
      ? { name: say("Free from the frame"), act: () => page.make({ do: "free", point }) }
      : { name: say("Pin to the frame"), act: () => page.make({ do: "ground", point }) },
    meets && { name: say("Separate"), act: () => page.make({ do: "separate", point }) },
    { name: say("Delete"), act: () => page.make({ do: "delete", what: "point", name: point }) },
  ];
  return actions.filter((one) => !!one);
}

function atLink(hit: Hit, link: string, state: State, page: Doing): Action[] {
  const { bodies, frame } = state.scene;
  const points = bodies.find(({ name }) => name === link)?.points ?? [];
  const pinned = points.filter((name) => frame.includes(name)).length === 1;
  const spot = { place: hit.place, on: link };
  const part = hit.part;
  const actions: (Action | false)[] = [
    { name: say("Mass …"), act: () => page.change(`links.${link}`, {}, "mass") },
    weight(link, state, page),
    { name: say("Point of the link"), act: () => page.make({ do: "point", spot, on: link }) },
    { name: say("Spring …"), act: () => page.add("springs", { link }) },
    { name: say("Load …"), act: () => page.add("loads", { link }) },
    points.length > 1 && { name: say("Constraint …"), act: () => page.add("constraints", { line: points.slice(0, 2) }) },
    pinned && link !== state.status.drive && { name: say("Drive"), act: () => page.make({ do: "drive", link }) },
    {
      name: say("Delete"),
      act: () => page.make(part ? { do: "delete", ...part } : { do: "delete", what: "link", name: link }),
    },
  ];
  return actions.filter((one) => !!one);
}

/** Only what turns about the frame, and has a mass, carries one. */
function weight(link: string, { fields }: State, page: Doing): Action | false {
  const group = `counterweight on ${link}`;
  return fields.some((field) => field.group === group) && { name: say("Counterweight"), act: () => page.numbers(group) };
}

/** What the support has at a place. */
function placed({ place }: Hit, page: Doing): Action[] {
  const at = () => ({ point: page.written(place) });
  return [
    { name: say("Mount of the support …"), act: () => page.add("support.mounts", at()) },
    { name: say("Gauge of the support …"), act: () => page.add("support.gauges", at()) },
  ];
}
