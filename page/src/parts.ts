/** The elements that a linkage is drawn with, from below to above. */

import { s } from "./dom";
import type { Scene } from "./protocol";

export const LAYERS = [
  "paths",
  "ground",
  "wheels",
  "guides",
  "bodies",
  "springs",
  "blocks",
  "points",
  "ghost",
  "grips",
  "labels",
] as const;

/** Shades of links, one after the other. */
const TINTS = 5;

interface Part {
  name: string;
  element: SVGElement;
}

interface WheelPart {
  link: string;
  center: string;
  radius: number;
  circle: SVGElement;
  spoke: SVGElement;
}

export interface Parts {
  bodies: (Part & { corners: string[] })[];
  /** Lines from links to centres of mass that lie off them. */
  arms: (Part & { from: string })[];
  paths: Part[];
  feet: Part[];
  wheels: WheelPart[];
  springs: { ends: [string, string]; element: SVGElement }[];
  blocks: { name: string; point: string; line: SVGElement; block: SVGElement }[];
  dots: Part[];
  /** near : points of the links that meet there. */
  labels: (Part & { near: string[] })[];
}

export const NOTHING: Parts = {
  bodies: [],
  arms: [],
  paths: [],
  feet: [],
  wheels: [],
  springs: [],
  blocks: [],
  dots: [],
  labels: [],
};

export function partsOf(scene: Scene, add: (layer: string, element: SVGElement) => void): Parts {
  const into = <E extends SVGElement>(layer: string, element: E): E => {
    add(layer, element);
    return element;
  };
  const bodies = scene.bodies.map(({ name, outline: corners }, i) => {
    const paths = [s("path", { class: "edge" }), s("path", { class: "face" })];
    const attributes = { class: `body tint-${i % TINTS}`, "data-link": name };
    return { name, corners, element: into("bodies", s("g", attributes, ...paths)) };
  });
  const arms = scene.bodies.flatMap(({ name, points: [from] }) =>
    from && scene.mass_centers.includes(name)
      ? [{ name, from, element: into("guides", s("path", { class: "arm" })) }]
      : [],
  );
  const points = [...new Set(scene.bodies.flatMap((body) => body.points))];
  const moving = points.filter((name) => !scene.frame.includes(name));
  const paths = moving.map((name) => ({
    name,
    element: into("paths", s("path", { class: "path" })),
  }));
  const pivots = scene.frame.filter((name) => points.includes(name));
  const feet = pivots.map((name) => ({
    name,
    element: into("ground", s("path", { class: "foot" })),
  }));
  const wheels = scene.wheels.map((wheel) => ({
    ...wheel,
    circle: into("wheels", s("circle", { class: "wheel" })),
    spoke: into("wheels", s("path", { class: "spoke" })),
  }));
  const springs = scene.springs.map((ends) => ({
    ends,
    element: into("springs", s("path", { class: "spring" })),
  }));
  const blocks = scene.guides.map(({ name, point }) => ({
    name,
    point,
    line: into("guides", s("path", { class: "guide" })),
    block: into(
      "blocks",
      s("rect", { class: "block", x: -11, y: -7, width: 22, height: 14, rx: 2 }),
    ),
  }));
  const all = [...new Set([...scene.frame, ...points])];
  const dots = all.map((name) => {
    const pinned = scene.pins.includes(name) || pivots.includes(name);
    const circle = s("circle", { class: pinned ? "pin" : "dot", r: pinned ? 4.5 : 3 });
    return { name, element: into("points", circle) };
  });
  const labels = all.map((name) => {
    const near = scene.bodies
      .filter((body) => body.points.includes(name))
      .flatMap((body) => body.points);
    const element = into("labels", s("text", { "text-anchor": "middle" }, name));
    return { name, element, near: near.filter((other) => other !== name) };
  });
  return { bodies, arms, paths, feet, wheels, springs, blocks, dots, labels };
}
