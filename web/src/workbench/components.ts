// Which components of the calculation belong to a part of the drawing or to a row of the losses.

import type { PointAnswer } from "./protocol.ts";

/** Section and id of a path: `meshes.M2.drag.churning` belongs to `meshes.M2`. */
export function componentOf(path: string): string {
  return /^[^.]+\.[^.]+/.exec(path)?.[0] ?? path;
}

/** Components whose loss can be explained: the part itself, and the meshes of a gear. Empty if the part has no loss. */
export function componentsOf(part: string, answer: PointAnswer): string[] {
  const own = componentOf(part);
  const known = new Set(answer.losses.map((l) => componentOf(l.path)));
  const found = known.has(own) ? [own] : [];
  const gear = /^gears\.(.+)$/.exec(own)?.[1];
  const stages: { mesh: string; gears: string[] }[] = Array.isArray(answer.point.stages) ? answer.point.stages : [];
  if (gear) for (const { mesh, gears } of stages) if (gears.includes(gear) && known.has(mesh) && !found.includes(mesh)) found.push(mesh);
  return found;
}
