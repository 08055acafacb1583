// What is pinned: a result with everything that it was computed from.

import type { MapOf, PointAnswer, PointOf, Section, Texts } from "./protocol.ts";
import { Newest, type Transport } from "./transport.ts";

export class Pin {
  private map: { key: string; section: Section } | null = null;
  private readonly newest: Newest;

  constructor(
    public name: string,
    readonly point: PointOf,
    readonly answer: PointAnswer,
    /** All texts of the page, so that later changes and saving do not change what is pinned. */
    readonly texts: Texts,
    transport: Transport,
    map: { of: MapOf; section: Section } | null,
  ) {
    this.newest = new Newest(transport);
    if (map) this.map = { key: JSON.stringify(this.own(map.of)), section: map.section };
  }

  private own(of: MapOf): MapOf {
    const { gearbox, gear, model_set, oil_temperature, oil_volume } = this.point;
    return { ...of, gearbox, gear, model_set, oil_temperature, oil_volume };
  }

  /** The map of the pinned state over the ranges of another map; null if a newer request took its place. */
  async mapOver(of: MapOf): Promise<Section | null> {
    const own = this.own(of);
    const key = JSON.stringify(own);
    if (this.map?.key === key) return this.map.section;
    const section = await this.newest.ask({ request: "map", texts: this.texts, ...own });
    if (section) this.map = { key, section };
    return section;
  }
}
