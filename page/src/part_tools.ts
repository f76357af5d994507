/** Tools that add parts which join two links, a declaration each: palette, help and clicks follow from these. */

import type { Made } from "./protocol";
import { toSay } from "./words";

export type PartToolName = "gears" | "belt" | "rack" | "cam";

/** How a tool is offered, and what to do with it. */
export interface ToolText {
  key: string;
  name: string;
  /** What to do first, and then. */
  first: string;
  then: string;
  picture: string;
}

/** What may be chosen of a part before it is added. */
export interface PartOptions {
  teeth: number;
  driven_teeth: number;
  rides: string;
}

export interface PartTool extends ToolText {
  tool: PartToolName;
  /** What of the part is asked beside its links. */
  asks?: "teeth" | "rider";
  /** Whether a click on the block of a slider means its link. */
  slides?: boolean;
  /** What to ask for, of two links and the place of the second click. */
  made(driver: string, driven: string, spot: object, options: PartOptions): Made;
}

const meshed =
  (tool: "gears" | "belt" | "rack") =>
  (driver: string, driven: string, _: object, { teeth, driven_teeth }: PartOptions): Made => ({
    do: tool,
    driver,
    driven,
    teeth,
    driven_teeth,
  });

/** What of a follower may be on its cam, and what that is called. */
export const RIDERS: [rides: string, name: string][] = [
  ["roller", toSay("roller")],
  ["flat", toSay("flat face")],
  ["knife", toSay("knife edge")],
];

/** Label of that choice for screen readers. */
export const RIDING = toSay("What rides on the cam");

export const PART_TOOLS: PartTool[] = [
  {
    tool: "gears",
    asks: "teeth",
    key: "g",
    name: toSay("Gears"),
    first: toSay("click the link of the driving gear"),
    then: toSay("click the link of the driven gear"),
    picture: "M5.500 5.500a3 3 0 1 0 .01 0M11.500 3a2.200 2.200 0 1 0 .01 0",
    made: meshed("gears"),
  },
  {
    tool: "belt",
    asks: "teeth",
    key: "b",
    name: toSay("Belt"),
    first: toSay("click the link of the driving pulley"),
    then: toSay("click the link of the driven pulley"),
    picture: "M4.500 6.500a2 2 0 1 0 .01 0M12 5a3 3 0 1 0 .01 0M4.500 6.500l7.500-1.500M4.500 10.500l7.500 .5",
    made: meshed("belt"),
  },
  {
    tool: "rack",
    slides: true,
    key: "k",
    name: toSay("Rack"),
    first: toSay("click what drives: the link of the pinion, or the block of the rack"),
    then: toSay("click the other of both: the block of the rack slides on the carrier of the pinion"),
    picture: "M7 2.500a3 3 0 1 0 .01 0M2 13.500v-2.500h1.500v-1.500h2v1.500h2v-1.500h2v1.500h2v-1.500h2v1.500h.5v2.500z",
    made: meshed("rack"),
  },
  {
    tool: "cam",
    asks: "rider",
    slides: true,
    key: "c",
    name: toSay("Cam"),
    first: toSay("click the link that bears the cam"),
    then: toSay("click the follower, where it rides on the cam: a link that swings, or a slider"),
    picture: "M6 13.500a3.500 3.500 0 0 1-3.300-4.700l2-5a1.400 1.400 0 0 1 2.600 0l2 5a3.500 3.500 0 0 1-3.300 4.700zM6 9.500a.8.8 0 1 0 .01 0M12.500 2.500v7M11 9.500h3",
    made: (driver, driven, spot, { rides }) => ({ do: "cam", driver, driven, spot, rides }),
  },
];

/** The tool of this name, if it adds a part. */
export function partTool(name: string): PartTool | undefined {
  return PART_TOOLS.find(({ tool }) => tool === name);
}
